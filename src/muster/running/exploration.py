"""Exploration: frontiers of the team's map become tasks, which are planned like any other ([yamauchi1997]).

Where there are tags to be found, the frontiers are those of what cameras have been near enough to see.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.model import Event, Mission, Point, Robot, Task
from muster.motion.grid import Floats
from muster.motion.map_world import Body, body_of
from muster.perception.explored_ground import ExploredGround
from muster.perception.frontiers import AirFrontiers, Frontiers, GroundFrontiers, OverflownFrontiers
from muster.perception.team_map import TeamMap
from muster.simulation.world_base import FLIGHT_M

if TYPE_CHECKING:
    from muster.execution import Executor

LOOK_S = 2.0
"""Seconds between two looks at the frontiers, while robots are under way to some."""
PRIORITY = 1e-3
"""Of the task of a frontier: the mission's own come first."""
LEAST_LOOK_M = 1.0
"""How near robots on the ground are to what their cameras see, at least."""
PER_ROBOT = 3
"""Frontiers that are tasks at once, for each robot."""
VISITS = 2
"""How often robots go to the very same place of a frontier: what cannot be seen from there is left."""


def looks_m(robot: Robot) -> float:
    """Return how near a robot has to be to see with its camera what lies on the ground, metres; 0 without a camera.

    It is the radius of the circle that the camera sees where it looks straight down, from where drones fly.
    """
    if robot.camera is None:
        return 0.0
    return max(LEAST_LOOK_M, FLIGHT_M * math.tan(math.radians(robot.camera.fov_deg) / 2))


@dataclass(frozen=True)
class _Explorers:
    """Robots that explore the same part of the world.

    Parameters
    ----------
    robots : tuple of str
        Their ids; empty: whoever there is.
    made : callable
        Makes the frontiers for a body of them.
    """

    robots: tuple[str, ...]
    made: Callable[[Body], Frontiers]


@dataclass
class _Frontier:
    """The task of a frontier: its place, and whose it is."""

    at: Point
    of: _Explorers


class Exploration:
    """Tasks of frontiers: one for each, until it has been seen what lies behind it.

    Parameters
    ----------
    mission : Mission
        Its rules say what tasks need; its robots are those that explore.
    team_map : TeamMap
        The map as the team knows it.

    Attributes
    ----------
    tasks : set of str
        The tasks that frontiers became.
    """

    def __init__(self, mission: Mission, team_map: TeamMap) -> None:
        self._map = team_map
        self._type = _open_type(mission)
        self._explorers = _explorers_of(mission, team_map)
        self._due_s = -math.inf
        self._open: dict[str, _Frontier] = {}
        self._visited: Counter[Point] = Counter()
        self.tasks: set[str] = set()

    def resume(self, executor: Executor) -> None:
        """Take over the tasks of frontiers of a run that was interrupted."""
        open_ids = {task.id for task in executor.ledger.open}
        for task in executor.ledger.tasks.values():
            if task.priority != PRIORITY or not task.id.startswith("frontier-"):
                continue
            self.tasks.add(task.id)
            of = next((one for one in self._explorers if one.robots == (task.only_robots or ())), None)
            if task.id in open_ids and of is not None:
                self._open[task.id] = _Frontier(task.position, of)

    def look(self, executor: Executor, now: float) -> None:
        """Cancel the tasks of frontiers that are none any more, and add those of new ones."""
        open_ids = {task.id for task in executor.ledger.open}
        ended = [name for name in self._open if name not in open_ids]
        if now < self._due_s and not ended and self._open:
            return
        self._due_s = now + LOOK_S
        self._visited.update(self._open[name].at for name in ended)
        self._open = {name: one for name, one in self._open.items() if name in open_ids}
        self._map.share_air()
        for explorers in self._explorers:
            crew = [
                state
                for name, state in executor.crew.items()
                if not state.out and (not explorers.robots or name in explorers.robots)
            ]
            if crew:
                body = min((body_of(state.robot) for state in crew), key=lambda one: one.radius_m)
                here = np.array([state.position for state in crew])
                frontiers = explorers.made(body)
                self._cancel_seen(executor, explorers, frontiers, here)
                self._add_new(executor, explorers, frontiers, here)

    def _cancel_seen(self, executor: Executor, explorers: _Explorers, frontiers: Frontiers, here: Floats) -> None:
        """Cancel the tasks of frontiers that are none any more, or that no robot can reach as the map is now."""
        tasks = [name for name, one in self._open.items() if one.of is explorers]
        if not tasks:
            return
        places = np.array([self._open[name].at for name in tasks])
        for name, is_reached in zip(tasks, frontiers.reached(here, places).tolist(), strict=True):
            if not (is_reached and frontiers.are_near(self._open[name].at)):
                del self._open[name]
                executor.report(Event(at_s=executor.now_s, cancel_task=name))

    def _add_new(self, executor: Executor, explorers: _Explorers, frontiers: Frontiers, here: Floats) -> None:
        most = PER_ROBOT * len(here)
        if sum(one.of is explorers for one in self._open.values()) >= most:
            return
        for place in frontiers.places(here):
            known = [one.at for one in self._open.values() if one.of is explorers]
            if len(known) >= most:
                return
            at: Point = tuple(np.round(place, 4).tolist())
            if self._visited[at] < VISITS and all(math.dist(at, other) > 2 * frontiers.apart_m for other in known):
                self._add(executor, explorers, at)

    def _add(self, executor: Executor, explorers: _Explorers, at: Point) -> None:
        where = at if len(at) == executor.mission.dimensions else (*at, 0.0)
        task = Task(
            id=f"frontier-{len(self.tasks) + 1}",
            position=where,
            type=self._type,
            priority=PRIORITY,
            only_robots=explorers.robots or None,
        )
        while task.id in executor.ledger.tasks:
            task = replace(task, id=task.id + "'")
        if executor.report_if_it_fits(Event(at_s=executor.now_s, new_task=task)):
            self._open[task.id] = _Frontier(at, explorers)
            self.tasks.add(task.id)


def _explorers_of(mission: Mission, team_map: TeamMap) -> list[_Explorers]:
    """Return which robots look for which frontiers.

    In the plane all look for the same. In space those in the air and those on the ground have frontiers of their own;
    where there are tags to be found, robots with cameras look at the ground from near.
    """
    near = bool(mission.tags)

    def ground(body: Body) -> Frontiers:
        found = team_map.of(body)
        assert isinstance(found, ExploredGround)
        return GroundFrontiers(found, body, near=near)

    air = team_map.air
    if air is None:
        return [_Explorers((), ground)]
    able = [robot for robot in mission.all_robots if robot.camera is not None or not near]
    flying, driving = (tuple(robot.id for robot in able if robot.kind == kind) for kind in ("air", "ground"))
    height_m = team_map.rules.lowest_m + FLIGHT_M
    explorers = []
    if flying:
        made = (
            (lambda body: OverflownFrontiers(team_map, body, height_m))
            if near
            else (lambda body: AirFrontiers(air, body))
        )
        explorers.append(_Explorers(flying, made))
    if driving and not (near and flying):
        explorers.append(_Explorers(driving, ground))
    return explorers


def _open_type(mission: Mission) -> str | None:
    """Return the type of task that most robots suit; None where types do not count."""
    if mission.suitability is None:
        return None
    rows = [mission.suitability.get(str(robot.type), {}) for robot in mission.robots]
    least = mission.rules.min_suitability
    types = sorted({name for row in rows for name in row})
    return max(types, key=lambda name: sum(row.get(name, 0.0) >= least for row in rows), default=None)
