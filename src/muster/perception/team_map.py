"""The map that a team builds: layers in the plane, and the air, filled by the scans of all its robots.

What stops a robot depends on its body: one on the ground passes below what is higher than twice its radius, one in the
air is not stopped by what is closed to the ground alone. So bodies have an order: what stops one stops all after it.
There is a layer for each: hits of a body's own scans count for it and those after it, and what they passed for it and
those before. In space robots also scan all around. That fills the air, and what stands as low as a robot is high is in
its way on the ground.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from muster.mission.model import Mission
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.map_world import Body, World, body_of
from muster.perception.counted_map import Counts, packed, unpack
from muster.perception.explored_air import ExploredAir, air_to_build
from muster.perception.explored_ground import CERTAIN, ExploredGround, frame_of, map_to_build, ruled_world
from muster.perception.laser import Scanner
from muster.perception.occupancy_map import OccupancyMap, Scan
from muster.perception.robot_grids import SeenCells
from muster.perception.sphere_scanner import SphereScanner
from muster.perception.voxel_map import SpaceScan

_NO_CELLS: Indices = np.empty((0, 2), dtype=np.int64)
_NO_POINTS: Floats = np.empty((0, 3))


@dataclass(eq=False)
class _Layer:
    """The ground as it is for bodies of one place in the order, and the cells that are newly occupied."""

    rank: float
    ground: ExploredGround
    fresh: Indices
    changed: bool = False


class TeamMap:
    """What a team knows of a world whose obstacles it sees.

    Parameters
    ----------
    truth : World
        The world.
    mission : Mission
        Its robots, those that join included, and its places.
    fills_cells : bool
        Whether what is seen are whole cells, as of robots' own maps, and not points.

    Attributes
    ----------
    air : ExploredAir, optional
        The air; None where all travel is in the plane.
    """

    def __init__(self, truth: World, mission: Mission, *, fills_cells: bool = False) -> None:
        rules = ruled_world(truth)
        bodies = [body_of(robot) for robot in mission.all_robots]
        self._dimensions = truth.dimensions
        self._in_space = truth.dimensions == 3 and truth.image is None
        flying = [body for body in bodies if self._in_space and body.kind == "air"]
        flat = [body for body in bodies if body not in flying] or [Body(min(b.radius_m for b in flying), "ground")]
        frame = frame_of(truth, min(body.radius_m for body in flat))
        by_rank: dict[float, list[float]] = {}
        for body in flat:
            by_rank.setdefault(self._rank(body), []).append(body.radius_m)
        self._layers = [
            _Layer(rank, ExploredGround(rules, map_to_build(truth, radii, frame, fills_cells=fills_cells)), _NO_CELLS)
            for rank, radii in sorted(by_rank.items())
        ]
        self.air: ExploredAir | None = None
        if flying:
            radii = [body.radius_m for body in flying]
            self.air = ExploredAir(rules, air_to_build(truth, mission, radii))
        self._fresh = _NO_POINTS

    @property
    def ground(self) -> ExploredGround:
        """The ground as it is for the bodies that most obstacles stop."""
        return self._layers[-1].ground

    @property
    def rules(self) -> World:
        """What is known beforehand."""
        return self.ground.rules

    @property
    def cell_m(self) -> float:
        """The side of a cell of the ground, metres."""
        return self.ground.seen.frame.resolution_m

    def of(self, body: Body) -> ExploredGround | ExploredAir:
        """Return what a body's ways are sought in."""
        if self.air is not None and body.kind == "air":
            return self.air
        rank = self._rank(body)
        return next((layer.ground for layer in self._layers if layer.rank >= rank), self.ground)

    def keep_off(self, least_m: float) -> None:
        """Let bodies on the ground keep off what was seen, by so many metres and two cells at least; 0: as they are."""
        for layer in self._layers if least_m else ():
            layer.ground.least_m = max(layer.ground.least_m, least_m, 2 * self.cell_m)
            layer.ground.grown()

    def close(self, rules: World) -> None:
        """Take over rules that have changed: doors that have closed or opened."""
        for layer in self._layers:
            layer.ground.close(rules)
        if self.air is not None:
            self.air.close(rules)

    def snapshot(self) -> dict[str, Any]:
        """Return the map as plain data, from which `resume` makes it again."""
        air = None if self.air is None else packed(self.air.seen)
        return {"layers": [packed(layer.ground.seen) for layer in self._layers], "air": air}

    def resume(self, snapshot: Mapping[str, Any]) -> None:
        """Take over the map of the same team as it was."""
        for layer, data in zip(self._layers, snapshot["layers"], strict=True):
            unpack(layer.ground.seen, data)
            layer.ground.grown()
        if self.air is not None:
            unpack(self.air.seen, snapshot["air"])
            self.air.grown(_NO_POINTS)

    def begin_look(self) -> None:
        """Forget which obstacles are new."""
        self._fresh = _NO_POINTS
        for layer in self._layers:
            layer.fresh, layer.changed = _NO_CELLS, False

    def end_look(self) -> bool:
        """Find ways by what was seen since the look began; return whether obstacles have changed."""
        for layer in self._layers:
            if layer.changed:
                layer.ground.grown()
        return any(layer.changed for layer in self._layers) or len(self._fresh) > 0

    def see(self, scan: Scan, scanner: Scanner, body: Body, near_m: float) -> None:
        """Enter a scan in the plane of a robot of a body, which sees what stops it."""
        rank = self._rank(body)
        passed = replace(scan, hits=np.zeros_like(scan.hits))
        for layer in self._layers:
            which = passed if layer.rank < rank else scan
            fresh, changed = layer.ground.seen.see(which, scanner, near_m, passes=layer.rank <= rank)
            self._note(layer, fresh, changed)

    def see_space(self, scan: SpaceScan, scanner: SphereScanner, near_m: float) -> None:
        """Enter a scan all around; what the robot flies over counts as seen from near."""
        points, inner = scan.points(scanner)
        for layer in self._layers:
            low = points[:, 2] <= 2 * layer.rank if layer.rank > 0 else np.zeros(len(points), dtype=np.bool_)
            fresh = layer.ground.seen.hit(points[low, :2], inner[low, :2])
            self._note(layer, fresh, len(fresh) > 0)
            if near_m:
                layer.ground.seen.note_near(scan.eye[:2], near_m)
        if self.air is not None:
            fresh_points, changed = self.air.seen.see(scan, scanner)
            self._fresh = np.concatenate([self._fresh, fresh_points])
            if changed:
                self.air.grown(fresh_points)

    def merge(self, maps: Iterable[tuple[Body, SeenCells]]) -> None:
        """Replace the map by what maps of single robots say, each of a robot of a body that sees what stops it."""
        maps = list(maps)
        for layer in self._layers:
            hits, passes = (np.zeros(layer.ground.seen.frame.shape, dtype=np.int32) for _ in range(2))
            for body, cells in maps:
                rank = self._rank(body)
                if layer.rank >= rank:
                    hits += cells.occupied
                if layer.rank <= rank:
                    passes += cells.free
            self._note(layer, *layer.ground.seen.count_anew(hits, passes))

    @property
    def layer_maps(self) -> list[OccupancyMap]:
        """The maps of the layers, in the order of the bodies."""
        return [layer.ground.seen for layer in self._layers]

    def recount(self, number: int, cells: Indices, hits: Counts, passes: Counts, offsets: Floats) -> None:
        """Take over what was counted elsewhere of cells of a layer; see `OccupancyMap.recount`."""
        self._note(self._layers[number], *self._layers[number].ground.seen.recount(cells, hits, passes, offsets))

    def share_air(self) -> None:
        """Count as free on the ground what was seen to be free in all the air that robots on it take up."""
        if self.air is None:
            return
        seen = self.air.seen
        free = seen.known & ~seen.occupied
        for layer in self._layers:
            layers = max(1, int(np.ceil((2 * layer.rank - self.rules.lowest_m) / seen.frame.cell_m)))
            columns: Bools = np.asarray(free[:layers].all(axis=0))
            layer.ground.seen.note_free(self.on_ground(columns))

    def is_closed(self, body: Body, points: Floats) -> bool:
        """Return whether an obstacle that is new is too near to the line through points (k, d)."""
        if self.air is not None and body.kind == "air":
            return not self.air.is_clear(body, points, self._fresh)
        rank = self._rank(body)
        layer = next((one for one in self._layers if one.rank >= rank), self._layers[-1])
        return len(layer.fresh) > 0 and not layer.ground.is_clear(body, points[:, :2], CERTAIN, layer.fresh)

    def on_ground(self, columns: Bools) -> Bools:
        """Return for each cell of the ground what holds of the column of air over it."""
        assert self.air is not None
        frame, air = self.ground.seen.frame, self.air.seen.frame
        rows, across = (
            np.clip(((np.arange(n) + 0.5) * frame.resolution_m / air.cell_m).astype(np.int64), 0, most - 1)
            for n, most in zip(frame.shape, air.shape[1:], strict=True)
        )
        cells: Bools = columns[np.ix_(rows, across)]
        return cells

    def _rank(self, body: Body) -> float:
        """Return the place of a body in the order: what stops a body stops all of a higher one."""
        if body.kind == "air":
            return -1.0
        return body.radius_m if self._dimensions == 3 else 0.0

    def _note(self, layer: _Layer, fresh: Indices, changed: bool) -> None:
        layer.changed |= changed
        layer.fresh = np.concatenate([layer.fresh, fresh])
