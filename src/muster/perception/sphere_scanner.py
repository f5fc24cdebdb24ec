"""A lidar that looks all around, up and down, in space: ranges to upright faces, level slabs, the ground and balls."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Bools, Floats

Slab = tuple[list[tuple[float, float]], float, float]
"""Corners, lowest and highest z of what has a level underside and top."""


@dataclass(frozen=True, eq=False)
class SphereScan:
    """What one scan measured.

    Parameters
    ----------
    ranges : ndarray, shape (rings, columns)
        Metres; inf where a beam met nothing within reach. Rings go from straight down to straight up, columns
        anticlockwise from straight ahead.
    on_ground : ndarray of bool, shape (rings, columns)
        Which beams met the ground.
    """

    ranges: Floats
    on_ground: Bools


@dataclass(frozen=True)
class SphereScanner:
    """A lidar with beams at equal steps of azimuth and elevation.

    Parameters
    ----------
    step_rad : float
        Between beams, both ways; a part of half a turn.
    reach_m : float
        How far it sees.
    """

    step_rad: float = math.radians(2.5)
    reach_m: float = 12.0

    @property
    def azimuths(self) -> Floats:
        """Return the bearings (columns,) of beams from straight ahead, radians."""
        return np.arange(round(2 * math.pi / self.step_rad), dtype=np.float64) * self.step_rad

    @property
    def elevations(self) -> Floats:
        """Return the elevations (rings,) of beams, radians."""
        return np.linspace(-math.pi / 2, math.pi / 2, round(math.pi / self.step_rad) + 1, dtype=np.float64)

    def directions(self, heading: float) -> Floats:
        """Return the unit vectors (rings, columns, 3) of beams in the map frame."""
        level, up = np.cos(self.elevations)[:, None], np.sin(self.elevations)[:, None]
        angles = heading + self.azimuths
        along = np.broadcast_arrays(level * np.cos(angles), level * np.sin(angles), up)
        return np.stack(along, axis=-1)

    def scan(
        self, eye: Floats, heading: float, faces: Floats, slabs: list[Slab], ground_m: float, balls: Floats
    ) -> SphereScan:
        """Return an exact scan.

        Parameters
        ----------
        eye : ndarray, shape (3,)
            Where the scanner is, metres in the map frame.
        heading : float
            Radians.
        faces : ndarray, shape (k, 6)
            Upright faces: x, y of both ends, lowest and highest z.
        slabs : list of Slab
            What has a level underside and top.
        ground_m : float
            The height of the ground.
        balls : ndarray, shape (m, 4)
            Other robots: x, y, z, radius.
        """
        beams = self.directions(heading)
        flat = np.hypot(beams[..., 0], beams[..., 1])
        ranges = self._to_faces(eye, heading, faces, beams, flat)
        for ring, low, high in slabs:
            for level in (low, high):
                if math.isfinite(level):
                    ranges = np.minimum(ranges, _to_level(eye, beams, np.array(ring), level))
        for ball in balls:
            ranges = np.minimum(ranges, _to_ball(eye, beams, ball))
        with np.errstate(divide="ignore"):
            down = np.where(beams[..., 2] < 0, (ground_m - eye[2]) / np.minimum(beams[..., 2], -1e-12), math.inf)
        down = np.maximum(down, 0.0)
        on_ground = (down < ranges) & (down <= self.reach_m)
        ranges = np.minimum(ranges, down)
        return SphereScan(np.where(ranges <= self.reach_m, ranges, math.inf), on_ground)

    def _to_faces(self, eye: Floats, heading: float, faces: Floats, beams: Floats, flat: Floats) -> Floats:
        """Return the distances along beams to upright faces: level ones by azimuth first, then what they meet there."""
        nearest = np.full(flat.shape, math.inf)
        if not len(faces):
            return nearest
        angles = heading + self.azimuths
        dx, dy = np.cos(angles)[:, None], np.sin(angles)[:, None]
        ax, ay = faces[:, 0] - eye[0], faces[:, 1] - eye[1]
        wx, wy = faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            across = dx * wy - dy * wx
            across = np.where(np.abs(across) > 1e-12 * np.hypot(wx, wy), across, np.nan)
            along, share = (ax * wy - ay * wx) / across, (ax * dy - ay * dx) / across
        met = (along >= 0) & (along <= self.reach_m) & (share >= -1e-9) & (share <= 1 + 1e-9)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = beams[..., 2] / flat
        for k in np.flatnonzero(met.any(axis=0)):
            level = np.where(met[:, k], along[:, k], math.inf)
            with np.errstate(invalid="ignore"):
                height = eye[2] + level * slope
                hit = (faces[k, 4] <= height) & (height <= faces[k, 5])
                nearest = np.where(hit, np.minimum(nearest, level / flat), nearest)
        return nearest


def _to_level(eye: Floats, beams: Floats, ring: Floats, level: float) -> Floats:
    """Return the distances along beams to the inside of a level polygon."""
    with np.errstate(divide="ignore", invalid="ignore"):
        away = (level - eye[2]) / beams[..., 2]
        away = np.where(away > 0, away, math.inf)
        x, y = eye[0] + away * beams[..., 0], eye[1] + away * beams[..., 1]
        inside = np.zeros(away.shape, dtype=np.bool_)
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            if ay != by:
                inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    return np.where(inside & np.isfinite(away), away, math.inf)


def _to_ball(eye: Floats, beams: Floats, ball: Floats) -> Floats:
    """Return the distances along beams to a ball (4,) of x, y, z, radius."""
    to = ball[:3] - eye
    middle = beams @ to
    half = ball[3] ** 2 - (to @ to - middle**2)
    near = middle - np.sqrt(np.maximum(half, 0.0))
    return np.where((half >= 0) & (near >= 0), near, math.inf)


SPHERE_LIDAR = SphereScanner()
"""The lidar of robots in space that build maps."""
