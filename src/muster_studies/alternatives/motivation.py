"""The state of an ALLIANCE-like team in the time of the mission: routes done, tasks in hand, and motivations.

Motivations are 0 to 1, the threshold; [parker1998].
"""

from __future__ import annotations

import numpy as np

from muster.allocation.allocator import Routes
from muster.mission.values.arrays import Floats
from muster.model.problem import Problem

_FREE = -1
_ROUNDING = 1e-12  # as the core allows for a capacity that is filled exactly
_SOON = 1e-9  # of the mean time for a task: the least time in which a robot becomes willing


class Team:
    """Robots with their routes, the task that each is at, and how motivated each is for the others."""

    def __init__(self, problem: Problem, patience: float, routes: Routes) -> None:
        m, n = len(problem.robots), len(problem.tasks)
        self._problem, self._patience = problem, patience
        self.routes: Routes = [[] for _ in range(m)]
        self.ends = np.full(m, np.inf)  # when each robot is done with the task that it is at
        self._began = np.zeros(m)
        self._at = np.full(m, _FREE, dtype=np.int64)
        self._of = np.full(n, _FREE, dtype=np.int64)  # the robot that is at a task
        self._done = np.zeros(n, dtype=np.bool_)
        self._waiting = np.array([len(before) for before in problem.prerequisites], dtype=np.int64)
        self._usage, self._now = np.zeros(m), np.array([robot.available_from_s for robot in problem.robots])
        self._costs, self._times = (
            np.full((m, n), np.inf),
            np.full((m, n), np.inf),
        )  # of going to each task and doing it
        self._to_end = np.array([self._ways_to_end(i) for i in range(m)]).reshape(m, n)
        self._motivation = np.zeros((m, n))
        self._time = 0.0
        for i, route in enumerate(routes):
            self._look_around(i)
            for j in route:
                self._do(i, j)
        for j in (j for route in routes for j in route):
            self._complete(j)

    def next_willing(self, acquiescence: float) -> tuple[float, int, int] | None:
        """When which free robot takes which task next; None if no robot can take one."""
        times = self._threshold_times()
        for task in np.flatnonzero(self._of != _FREE).tolist():
            times[:, task] = self._take_over_times(task, times[:, task], acquiescence)
        if not times.size:
            return None
        first = int(np.argmin(times))
        robot, task = divmod(first, times.shape[1])
        return (float(times[robot, task]), robot, task) if np.isfinite(times[robot, task]) else None

    def next_end(self) -> int | None:
        """The robot that is done next."""
        robot = int(np.argmin(self.ends))
        return robot if np.isfinite(self.ends[robot]) else None

    def begin(self, time: float, robot: int, task: int) -> None:
        """The robot sets out for the task; one that was at it acquiesces."""
        self._go_on_to(time)
        other = int(self._of[task])
        if other != _FREE:
            self._release(other)
        self._at[robot], self._of[task] = task, robot
        self._began[robot], self.ends[robot] = time, time + self._times[robot, task]
        self._motivation[:, task] = 0.0
        self._motivation[robot] = 0.0

    def finish(self, robot: int) -> None:
        """The robot is done with its task."""
        task, time = int(self._at[robot]), float(self.ends[robot])
        self._go_on_to(time)
        self._release(robot)
        self._do(robot, task)
        self._now[robot] = time
        self._complete(task)

    def finish_all(self) -> None:
        """Every robot that is at a task finishes it."""
        while (robot := self.next_end()) is not None:
            self.finish(robot)

    def _rates(self) -> Floats:
        """(m, n) by how much motivation grows a second: 0 at what a robot cannot take now."""
        n = len(self._done)
        can = (self._at == _FREE)[:, None] & ~self._done & (self._waiting == 0) & np.isfinite(self._times)
        can &= self._of != np.arange(len(self._at))[:, None]
        capacity = self._problem.capacity[:, None] * (1.0 + _ROUNDING)
        can &= np.isfinite(self._to_end) & (self._usage[:, None] + self._costs + self._to_end <= capacity)
        if not can.any():
            return np.zeros((len(self._at), n))
        least = max(1e-300, _SOON * float(self._times[can].mean()))
        rates = np.where(can, 1.0 / np.maximum(np.where(can, self._times, 1.0), least), 0.0)
        rates[:, self._of != _FREE] /= self._patience
        return rates

    def _threshold_times(self) -> Floats:
        """(m, n) when each robot's motivation for each task reaches the threshold if nothing happens before."""
        rates = self._rates()
        left = np.full(rates.shape, np.inf)
        np.divide(1.0 - self._motivation, rates, out=left, where=rates > 0.0)
        return np.asarray(np.maximum(self._time, self._now[:, None]) + np.maximum(0.0, left))

    def _take_over_times(self, task: int, times: Floats, acquiescence: float) -> Floats:
        """(m,) when robots take a task over that another one is at; inf for those that would be done later."""
        other = int(self._of[task])
        yields = self._began[other] + acquiescence * (self.ends[other] - self._began[other])
        times = np.maximum(times, yields)
        sooner = times + self._times[:, task] < self.ends[other]
        return np.where(sooner, times, np.inf)

    def _go_on_to(self, time: float) -> None:
        spans = np.maximum(0.0, time - np.maximum(self._time, self._now))
        self._motivation = np.minimum(1.0, self._motivation + self._rates() * spans[:, None])
        self._time = max(self._time, time)

    def _release(self, robot: int) -> None:
        self._of[self._at[robot]] = _FREE
        self._at[robot], self.ends[robot] = _FREE, np.inf

    def _do(self, robot: int, task: int) -> None:
        self._usage[robot] += self._costs[robot, task]
        self._now[robot] += self._times[robot, task]
        self.routes[robot].append(task)
        self._done[task] = True
        self._look_around(robot)

    def _complete(self, task: int) -> None:
        for dependant in self._problem.dependants[task]:
            self._waiting[dependant] -= 1

    def _look_around(self, robot: int) -> None:
        """What it takes the robot from where it is to do each task: usage, and seconds."""
        problem, n = self._problem, len(self._done)
        place = self.routes[robot][-1] if self.routes[robot] else problem.start(robot)
        ways = problem.legs(robot, [place], np.arange(n))[0]
        may = problem.allowed_by_kind[problem.kinds[robot]]
        self._costs[robot] = np.where(may, ways + problem.work_usage(robot), np.inf)
        seconds = problem.travel_seconds(robot, [place], np.arange(n))[0]
        self._times[robot] = np.where(may, seconds + problem.work_seconds(robot), np.inf)

    def _ways_to_end(self, robot: int) -> Floats:
        """(n,) usage of the way from each task to the robot's end; 0 where it may end anywhere."""
        problem, n = self._problem, len(self._done)
        if problem.robots[robot].place_at_end(problem.mission.rules) is None:
            return np.zeros(n)
        return problem.legs(robot, np.arange(n), [problem.end(robot)])[:, 0]
