"""What robots without a map drive from each place of arrival to the next, beside the ways that the true map has."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from muster.execution.reports.report import Report
from muster.mission.model import Robot
from muster.motion.grid import Floats
from muster.motion.map_world import World, body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.simulation import SimulatedWorld
from muster.state.robot_events import RobotAtEnd
from muster.state.task_events import Arrives, Ends

if TYPE_CHECKING:
    from muster.execution import ExecutionEvent


@dataclass
class _Way:
    """What a robot has driven between places of arrival, and what that takes with the map, metres."""

    at: Floats
    driven_before_m: float
    driven_m: float = 0.0
    with_map_m: float = 0.0


class DrivenWays:
    """Compares what robots drove from arrival to arrival with the ways that the true map has.

    Parameters
    ----------
    truth : World
        The world with its obstacles.
    """

    def __init__(self, truth: World) -> None:
        self._dimensions = truth.dimensions
        self._with_map = RobotPaths(truth)
        self._ways: dict[str, _Way] = {}

    def follow(self, world: SimulatedWorld, events: Iterable[ExecutionEvent], robot: Callable[[str], Robot]) -> None:
        """Take in what has happened since the last call, in a world whose robots stand where they did it."""
        driven = world.distances_m
        places = dict(zip(world.ports, world.positions, strict=True))
        for name, place in places.items():
            self._ways.setdefault(name, _Way(place.copy(), driven[name]))
        for event in events:
            self._measure(event, driven, places, robot)

    def with_ways(self, report: Report) -> Report:
        """Return a report that has `ground` with the ways of all robots."""
        driven, known = (sum(getattr(way, name) for way in self._ways.values()) for name in ("driven_m", "with_map_m"))
        assert report.ground is not None
        return replace(report, ground=replace(report.ground, driven_m=driven, with_map_m=known))

    def _measure(
        self,
        event: ExecutionEvent,
        driven: Mapping[str, float],
        places: Mapping[str, Floats],
        robot: Callable[[str], Robot],
    ) -> None:
        names: tuple[str, ...]
        if isinstance(event, Arrives | RobotAtEnd):
            names = (event.robot,)
        elif isinstance(event, Ends):
            names = tuple(one for one in (event.robot, *event.team) if one)
        else:
            return
        for name in names:
            way, place, size = self._ways[name], places[name].copy(), self._dimensions
            if not isinstance(event, Ends):
                leg = self._with_map.leg_m(body_of(robot(name)), tuple(way.at[:size]), tuple(place[:size]))
                if math.isfinite(leg):
                    way.with_map_m += leg
                    way.driven_m += driven[name] - way.driven_before_m
            way.at, way.driven_before_m = place, driven[name]
