"""The part of a plan's routes whose robots, tasks and stations exist, and whose tasks do not repeat."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from muster.mission.model import Mission, Station, Task
from muster.mission.plan import Plan, Route, RouteStop
from muster.verification.verdict import Violation


@dataclass(frozen=True)
class Call:
    """A visit of a station, as a plan has it.

    Parameters
    ----------
    charged
        what the plan says that is added to the battery, in the unit of usage; None: it says nothing.
    turn
        when the plan says that service begins, and that the robot arrives: seconds; None: it says nothing.
    """

    station: Station
    charged: float | None = None
    turn: tuple[float, float] | None = None


Planned = Task | Call


def other_mission(mission: Mission, plan: Plan) -> list[Violation]:
    """A violation if the plan names another mission; a plan that names none, as from elsewhere, is taken as of this."""
    if plan.mission in (None, mission.name):
        return []
    return [Violation("mission", None, None, f"the plan is of {plan.mission}; expected {mission.name}, or no name")]


def known_routes(mission: Mission, plan: Plan, teams: bool) -> tuple[dict[str, list[Planned]], list[Violation]]:
    """Take from the plan what exists and does not repeat: each robot's stops; and a violation for all else.

    With `teams` a task for a team may stand in several routes, once in each. A station may stand anywhere.
    """
    return _Taking(mission, teams).routes(plan)


class _Taking:
    """Takes what is known, route by route."""

    def __init__(self, mission: Mission, teams: bool) -> None:
        self._teams = teams
        self._robots = {robot.id for robot in mission.robots}
        self._tasks = {task.id: task for task in mission.tasks}
        self._stations = {station.id: station for station in mission.stations}
        self._robot_of: dict[str, str] = {}
        self._violations: list[Violation] = []

    def routes(self, plan: Plan) -> tuple[dict[str, list[Planned]], list[Violation]]:
        known: dict[str, list[Planned]] = {}
        for route in plan.routes:
            if route.robot not in self._robots:
                self._refuse("unknown-robot", route.robot, None, "no robot of the mission; route left out")
            elif route.robot in known:
                self._refuse("repeated-robot", route.robot, None, "a further route of this robot; route left out")
            else:
                known[route.robot] = self._stops(route)
        return known, self._violations

    def _refuse(self, kind: str, robot: str, task: str | None, detail: str) -> None:
        self._violations.append(Violation(kind, robot, task, detail))

    def _stops(self, route: Route) -> list[Planned]:
        known: list[Planned] = []
        own: set[str] = set()
        for name, stop in zip(route.tasks, _stated(route), strict=True):
            if name in self._stations:
                known.append(_call(self._stations[name], stop))
            elif name not in self._tasks:
                what = "no task or station of the mission" if self._stations else "no task of the mission"
                self._refuse("unknown-task", route.robot, name, what)
            elif name in self._robot_of and not (self._teams and self._tasks[name].is_for_team and name not in own):
                detail = f"already in the route of {self._robot_of[name]}"
                self._refuse("repeated-task", route.robot, name, detail)
            else:
                self._robot_of[name] = route.robot
                own.add(name)
                known.append(self._tasks[name])
        return known


def _stated(route: Route) -> Iterator[RouteStop | None]:
    """For each entry of a route what its stops say of it; nothing where these are others."""
    if tuple(stop.name for stop in route.stops) == route.tasks:
        return iter(route.stops)
    return iter([None] * len(route.tasks))


def _call(station: Station, stop: RouteStop | None) -> Call:
    if stop is None:
        return Call(station)
    return Call(station, stop.charged, (stop.begin_s, stop.arrive_s))
