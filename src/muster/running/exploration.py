"""Exploration: frontiers of the team's map become tasks, which are planned like any other ([yamauchi1997]).

Where there are tags to be found, the frontiers are those of what cameras have been near enough to see.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.model import Event, Mission, Robot, Task
from muster.motion.grid import Floats
from muster.motion.map_world import Body, body_of
from muster.perception.explored_ground import ExploredGround
from muster.perception.frontiers import frontier_cells, frontiers, is_near_frontier
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


def looks_m(robot: Robot) -> float:
    """Return how near a robot has to be to see with its camera what lies on the ground, metres; 0 without a camera.

    It is the radius of the circle that the camera sees where it looks straight down, from where drones fly.
    """
    if robot.camera is None:
        return 0.0
    return max(LEAST_LOOK_M, FLIGHT_M * math.tan(math.radians(robot.camera.fov_deg) / 2))


class Exploration:
    """Tasks of frontiers: one for each, until it has been seen what lies behind it.

    Parameters
    ----------
    mission : Mission
        Its rules say what tasks need; its robots are those that explore.
    ground : ExploredGround
        The ground as the team knows it.

    Attributes
    ----------
    tasks : set of str
        The tasks that frontiers became.
    """

    def __init__(self, mission: Mission, ground: ExploredGround) -> None:
        self._mission, self._ground = mission, ground
        self._type = _open_type(mission)
        self._near = bool(mission.tags)
        self._due_s = -math.inf
        self._open: dict[str, tuple[float, float]] = {}
        self.tasks: set[str] = set()

    def look(self, executor: Executor, now: float) -> None:
        """Cancel the tasks of frontiers that are none any more, and add those of new ones."""
        open_ids = {task.id for task in executor.ledger.open}
        ended = [name for name in self._open if name not in open_ids]
        if now < self._due_s and not ended and self._open:
            return
        self._due_s = now + LOOK_S
        self._open = {name: at for name, at in self._open.items() if name in open_ids}
        bodies = [body_of(state.robot) for state in executor.crew.values() if not state.out]
        if not bodies:
            return
        body = min(bodies, key=lambda one: one.radius_m)
        here = np.array([state.position[:2] for state in executor.crew.values() if not state.out])
        self._cancel_seen(executor, body, here)
        self._add_new(executor, body, here)

    def _cancel_seen(self, executor: Executor, body: Body, here: Floats) -> None:
        """Cancel the tasks of frontiers that are none any more, or that no robot can reach as the map is now."""
        if not self._open:
            return
        cells = frontier_cells(self._ground, body, near=self._near)
        reached = np.isfinite(self._ground.lengths(body, here, np.array([*self._open.values()])).min(axis=0)).tolist()
        for (name, at), is_reached in zip(list(self._open.items()), reached, strict=True):
            if not (is_reached and is_near_frontier(cells, self._ground, at, self._apart_m(body))):
                del self._open[name]
                executor.report(Event(at_s=executor.now_s, cancel_task=name))

    def _add_new(self, executor: Executor, body: Body, here: Floats) -> None:
        most = PER_ROBOT * len(here)
        if len(self._open) >= most:
            return
        for place, _ in frontiers(self._ground, body, here, near=self._near):
            known = [*self._open.values()]
            if len(known) >= most:
                return
            if all(math.dist(place, at) > 2 * self._apart_m(body) for at in known):
                self._add(executor, place)

    def _add(self, executor: Executor, place: Floats) -> None:
        at = (round(float(place[0]), 4), round(float(place[1]), 4))
        task = Task(id=f"frontier-{len(self.tasks) + 1}", position=at, type=self._type, priority=PRIORITY)
        while task.id in executor.ledger.tasks:
            task = replace(task, id=task.id + "'")
        if executor.report_if_it_fits(Event(at_s=executor.now_s, new_task=task)):
            self._open[task.id] = at
            self.tasks.add(task.id)

    def _apart_m(self, body: Body) -> float:
        """How near to its frontier a task is, at most."""
        return max(2 * body.radius_m, 10 * self._ground.seen.frame.resolution_m)


def _open_type(mission: Mission) -> str | None:
    """Return the type of task that most robots suit; None where types do not count."""
    if mission.suitability is None:
        return None
    rows = [mission.suitability.get(str(robot.type), {}) for robot in mission.robots]
    least = mission.rules.min_suitability
    types = sorted({name for row in rows for name in row})
    return max(types, key=lambda name: sum(row.get(name, 0.0) >= least for row in rows), default=None)
