"""A picture of a run's end from straight above, north up."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from muster.motion.grid import Floats
from muster.state.mission_state import DONE
from muster_physics.film.captions import QUIET_INK, clock, write
from muster_physics.film.files import check_still, write_png
from muster_physics.film.footage import Footage
from muster_physics.film.ground_marks import GroundMarks
from muster_physics.film.interpolation import RunInterpolation
from muster_physics.film.scenery import name_all, places_of, tableau_of
from muster_physics.rendering import Renderer

_MOST_WIDE, _MOST_HIGH, _TOP, _EDGE = 1600, 1200, 44, 24
"""Pixels: at most so large, so much kept free above and at the other sides."""


def write_still(path: str | Path, footage: Footage) -> None:
    """Draw how a run ended and write it, as PNG.

    Raises
    ------
    InputError
        if the ending is not .png, or the file cannot be written.
    ParameterError
        if there was no physics world.
    RenderingError
        if nothing draws here.
    """
    check_still(path)
    moments = RunInterpolation(footage)
    moments.go_on(moments.end_s)
    poses, places = moments.at(moments.end_s), places_of(footage.mission, moments.poses)
    low, high = places[:, :2].min(axis=0), places[:, :2].max(axis=0)
    room = np.array([_MOST_WIDE - 2 * _EDGE, _MOST_HIGH - _TOP - _EDGE])
    pixel_m = float(((high - low) / room).max())
    width, height = np.ceil((high - low) / pixel_m + np.array([2 * _EDGE, _TOP + _EDGE])).astype(int).tolist()
    centre = (low + high) / 2 + (0.0, (_TOP - _EDGE) / 2 * pixel_m)

    def pixels(where: Floats) -> Floats:
        seen: Floats = np.array([width, height]) / 2 + (where[:, :2] - centre) * (1, -1) / pixel_m
        return seen

    tableau = tableau_of(footage, pixel_m, smooth=True)
    tableau.put(poses[:, :3], poses[:, 3:])
    marks = GroundMarks(moments, tableau.ground_m, pixel_m).at(moments.end_s, poses)
    with Renderer(tableau, width, height) as renderer:
        picture = renderer.seen_from_above((float(centre[0]), float(centre[1])), height * pixel_m, marks=marks).copy()
    name_all(picture, moments, poses, pixels, pixel_m, tableau.ground_m)
    states = list(moments.mission_state.stages.values())
    facts = f"{states.count(DONE)} of {len(states)} tasks done  ·  {clock(moments.end_s)}"
    wide = write(picture, footage.mission.name, (_EDGE, 28), 18, weight=600)
    write(picture, facts, (_EDGE + wide + 14, 28), 15, color=QUIET_INK)
    write_png(path, picture)
