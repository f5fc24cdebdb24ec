"""Places of robots, tasks and stations, and what ways between them and work at them take: metres, seconds, usage."""

from __future__ import annotations

import math
import os
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from muster.mission.model import Mission, Point, Robot, Station, Task
from muster.mission.values.arrays import Floats, Indices
from muster.model.lengths import Measured
from muster.model.task_geometry import TaskGeometry
from muster.model.travel import require_room, straight_table, travel_table
from muster.model.waiting import NO_WAITING, Waiting
from muster.model.work_times import work_times
from muster.motion.actions import duration_of
from muster.motion.leg_times import LegTimes
from muster.motion.map_world import body_of

if TYPE_CHECKING:
    from muster.model.map_travel import MapTravel
    from muster.motion.paths.robot_paths import RobotPaths


@dataclass(frozen=True, eq=False, kw_only=True)
class TravelAndWork:
    """Robots (m) and tasks (n), and the ways between their places.

    Places are numbered: tasks, then starts of robots, then ends of their routes, then stations. Where a place depends
    on the robot, as the kinds of robots work differently, that is seen to.
    """

    mission: Mission
    robots: tuple[Robot, ...]
    tasks: tuple[Task, ...]
    known: Measured | None = None  # what the problem of which this is a part knew
    mapped: RobotPaths | None = None  # over the mission's map, as far as they are known already
    waiting: Waiting = NO_WAITING  # that is expected on ways

    @cached_property
    def task_index(self) -> dict[str, int]:
        return {task.id: j for j, task in enumerate(self.tasks)}

    @cached_property
    def robot_index(self) -> dict[str, int]:
        return {robot.id: i for i, robot in enumerate(self.robots)}

    @property
    def stations(self) -> tuple[Station, ...]:
        return self.mission.stations

    @property
    def in_time(self) -> bool:
        """Whether usage is time."""
        return self.mission.rules.usage == "time"

    @property
    def usage_unit(self) -> str:
        return "s" if self.in_time else "m"

    def start(self, i: int) -> int:
        """The place where robot i starts."""
        return len(self.tasks) + i

    def end(self, i: int) -> int:
        """The place where robot i's route ends, if it must end somewhere."""
        return len(self.tasks) + len(self.robots) + i

    @property
    def places(self) -> tuple[Floats, Floats]:
        """Where tasks are entered, (n, 3), and robots start, (m, 3), in metres of the map frame.

        Where that depends on the robot, for one of them.
        """
        n, m = len(self.tasks), len(self.robots)
        return self._entries[0, :n], self._entries[0, n : n + m]

    @property
    def all_places(self) -> Floats:
        """(2n + 4m, 3) where tasks are entered and left, robots start and routes end; for one of the robots."""
        return np.concatenate([self._entries[0], self._exits[0]])

    def metres(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) metres that robot i travels between places."""
        table, classes = self.travel
        if len(table):
            return np.asarray(table[classes[i]][np.asarray(places, np.int64)[:, None], np.asarray(to, np.int64)[None]])
        return np.asarray(np.linalg.norm(self._exits[0, places][:, None] - self._entries[0, to][None], axis=2))

    def legs(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) travel usage of robot i between places."""
        if self.in_time:
            return self.travel_seconds(i, places, to)
        waits_m = self.waiting.of(i, places, to) * self.robots[i].speed_mps
        return np.asarray(self.metres(i, places, to) + waits_m)

    def travel_seconds(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        """(len(places), len(to)) the time that robot i takes between places."""
        return np.asarray(self._driving_seconds(i, places, to) + self.waiting.of(i, places, to))

    def _driving_seconds(self, i: int, places: Sequence[int] | Indices, to: Sequence[int] | Indices) -> Floats:
        if len(self.measured.seconds):
            table = self.measured.seconds[self.measured.classes[i]]
            return np.asarray(table[np.asarray(places, np.int64)[:, None], np.asarray(to, np.int64)[None]])
        metres, profile = self.metres(i, places, to), self.leg_times[i]
        if profile.is_constant:
            return np.asarray(metres / profile.speed_mps)
        k = self._task_geometry.classes[i]
        apart = self._entries[k, to][None] - self._exits[k, places][:, None]
        return np.asarray(profile.seconds(metres, np.abs(apart[..., 2]), np.linalg.norm(apart, axis=2)))

    @cached_property
    def leg_times(self) -> tuple[LegTimes, ...]:
        """For each robot how long legs take."""
        over_map = self.mission.travel_off_lanes == "map" if self.known is None else self.known.over_map
        return tuple(LegTimes.of(robot, self.mission.rules, over_map=over_map) for robot in self.robots)

    def work_usage(self, i: int) -> Floats:
        """(n,) usage of robot i for the work of each task."""
        return self.work_seconds(i) if self.in_time else self._work_metres(i)

    def work_seconds(self, i: int) -> Floats:
        """(n,) the time that robot i takes for the work of each task."""
        seconds, classes = self._work_times
        return np.asarray(seconds[classes[i]])

    def _work_metres(self, i: int) -> Floats:
        measured = self.measured
        return np.asarray(measured.costs[measured.work_classes[i]])

    @cached_property
    def _work_times(self) -> tuple[Floats, npt.NDArray[np.int32]]:
        return work_times(self.robots, self._duration, self.leg_times, self._task_geometry, self.measured)

    @cached_property
    def _duration(self) -> Floats:
        return floats(math.nan if (d := duration_of(t)) is None else d for t in self.tasks)

    def shortcuts(self) -> Indices:
        """Tasks through which a way can be shorter than the direct one."""
        return self._shortcuts

    @cached_property
    def _shortcuts(self) -> Indices:
        if len(self.travel[0]) or len(self.waiting.seconds):
            return np.arange(len(self.tasks))
        n = len(self.tasks)
        return np.flatnonzero((self._entries[0, :n] != self._exits[0, :n]).any(axis=1))

    def action_refusal(self, i: int, j: int) -> str | None:
        """Why robot i cannot do the action of task j, whatever the rules; None if it can."""
        return self._task_geometry.refusal(i, j)

    def actions_refused(self, i: int) -> frozenset[int]:
        """The tasks whose actions robot i cannot do."""
        return self._task_geometry.refused(i)

    @cached_property
    def travel(self) -> tuple[Floats, npt.NDArray[np.int32]]:
        """Travel tables and each robot's table; empty where travel is straight.

        The table is (classes, n + 2m, n + 2m) metres between tasks, starts and ends of robots, inf where there is no
        way.
        """
        return self.measured.table, self.measured.classes

    @property
    def work_classes(self) -> npt.NDArray[np.int32]:
        """(m,) of one class are robots for which every task costs the same metres."""
        return self.measured.work_classes

    @cached_property
    def measured(self) -> Measured:
        if self.known is not None:
            return self.known
        geometry, none = self._task_geometry, np.empty(0, dtype=np.int32)
        if self.has_paths:
            return self._over_map.measured(os.cpu_count() or 1)
        if self.mission.travel_rule == "matrix":
            table, classes = travel_table(self.mission, self.robots, self.tasks)
        else:
            table = straight_table(self.mission, self._exits, self._entries)
            classes = geometry.classes if len(table) else none
        legs = geometry.legs(lambda _, leg, doing: math.dist(*leg))
        return Measured(table, classes, geometry.costs, geometry.classes, legs)

    @cached_property
    def _task_geometry(self) -> TaskGeometry:
        return TaskGeometry.of(self.robots, self.tasks, kinds=self._bodies if self.has_paths else None)

    @cached_property
    def _bodies(self) -> list[Hashable]:
        """What ways depend on, of each robot: its body, and with lanes how long legs take it."""
        if self.mission.driven_lanes is None:
            return [body_of(robot) for robot in self.robots]
        return [(body_of(robot), LegTimes.in_mission(robot, self.mission)) for robot in self.robots]

    @cached_property
    def has_paths(self) -> bool:
        """Whether legs are paths: along lanes, shortest ones, or straight ones that closed areas may cross."""
        if not self.mission.has_straight_legs_among_areas:
            return self.mission.has_paths
        return not all(self.robot_paths.is_open(body_of(robot), self._all_points) for robot in self.robots)

    @cached_property
    def _all_points(self) -> Floats:
        """(k, 3) metres, map frame: where legs and the work on tasks begin and end."""
        geometry = TaskGeometry.of(self.robots, self.tasks)
        passed = [(*point, 0.0)[:3] for doing in geometry.moving.values() for point in doing.points]
        places = [self._with_robots(geometry.entries), self._with_robots(geometry.exits), np.array(passed, np.float64)]
        return np.concatenate([part.reshape(-1, 3) for part in places])

    @cached_property
    def robot_paths(self) -> RobotPaths:
        """Over the mission's map."""
        from muster.motion.paths.robot_paths import RobotPaths

        return RobotPaths.of(self.mission) if self.mapped is None else self.mapped

    @cached_property
    def _over_map(self) -> MapTravel:
        require_room(self.mission, self._exits.shape[1], "travel over a map")
        return self.over(self.robot_paths)

    def over(self, robot_paths: RobotPaths) -> MapTravel:
        """Travel between the places by paths over the map, whatever the mission's rule."""
        from muster.model.map_travel import MapTravel

        geometry = self._task_geometry
        if not self.has_paths:
            geometry = TaskGeometry.of(self.robots, self.tasks, kinds=self._bodies)
        firsts = [self.robots[i] for i in geometry.firsts]
        bodies = tuple(body_of(robot, self.mission) for robot in firsts)
        times = tuple(LegTimes.in_mission(robot, self.mission) for robot in firsts)
        exits, entries = self._with_robots(geometry.exits), self._with_robots(geometry.entries)
        return MapTravel(robot_paths, bodies, times, geometry, exits, entries)

    def no_way_to(self, i: int, j: int) -> str:
        """Why robot i has no path to task j, or along its way points."""
        if self.known is not None or not self.has_paths:
            return "there is no way to it"
        return self._over_map.why_not(i, self.start(i), j)

    @cached_property
    def _entries(self) -> Floats:
        """(classes, n + 2m, 3) metres, map frame: where tasks are entered, robots start and routes end."""
        return self._with_robots(self._task_geometry.entries)

    @cached_property
    def _exits(self) -> Floats:
        """(classes, n + 2m, 3) metres, map frame: where tasks are left, robots start and routes end."""
        return self._with_robots(self._task_geometry.exits)

    def _with_robots(self, portals: Floats) -> Floats:
        places = np.array([(*p, 0.0)[:3] for p in self._robots_places], dtype=np.float64)
        return np.concatenate([portals, np.broadcast_to(places, (len(portals), *places.shape))], axis=1)

    @property
    def _robots_places(self) -> list[Point]:
        ends = [r.place_at_end(self.mission.rules) or r.position for r in self.robots]
        return [*(r.position for r in self.robots), *ends, *(station.position for station in self.stations)]


def floats(values: Iterable[float]) -> Floats:
    """An array of numbers."""
    return np.array(list(values), dtype=np.float64)
