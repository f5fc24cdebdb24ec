"""What a robot has on board along its route, by commodity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from muster.mission.goods import by_commodity
from muster.mission.model import Task
from muster.verification.measure import MeasuredRoute, Step

Load = Mapping[str, float]

ROUNDING = 1e-9
"""Of loads, relative to the most that was on board."""
_TINY = 1e-12


def net_load(task: Task, tasks: Mapping[str, Task]) -> Load:
    """What a task changes of what is on board, with what it delivers put down."""
    change = dict(by_commodity(task.load))
    for name, amount in () if task.delivers is None else by_commodity(tasks[task.delivers].load).items():
        change[name] = change.get(name, 0.0) - amount
    return change


def is_above(load: float, limit: float, most: float) -> bool:
    """Whether a load is above a limit by more than rounding; `most` is the most that was on board."""
    return load > limit + ROUNDING * max(most, abs(limit)) + _TINY


class Hold:
    """What one robot has on board, from the start of its route on.

    Parameters
    ----------
    tasks
        of the mission, by id.
    deliverer
        for each task whose load another delivers the id of that.
    """

    def __init__(self, route: MeasuredRoute, tasks: Mapping[str, Task], deliverer: Mapping[str, str]) -> None:
        self._route, self._tasks, self._deliverer = route, tasks, deliverer
        self._load = dict(by_commodity(route.robot.load_at_start))
        self._most: dict[str, float] = dict(self._load)
        self._pending: dict[str, Load] = {}  # by the task that took it on

    @property
    def most(self) -> Load:
        """The most of each commodity that was on board, or was missing, up to now."""
        return self._most

    def along_route(self) -> Iterator[dict[str, float]]:
        """What is on board after each stop, without that of which there is nothing."""
        for stop in self._route.stops:
            if isinstance(stop, Step):
                self._work(stop.task)
            elif stop.station.unloads:
                self._unload()
            yield {name: value for name, value in self._load.items() if abs(value) > self._noise(name)}

    def _noise(self, name: str) -> float:
        return ROUNDING * self._most.get(name, 0.0) + _TINY

    def _work(self, task: Task) -> None:
        for name, amount in by_commodity(task.load).items():
            self._add(name, amount)
        if task.id in self._deliverer:
            self._pending[task.id] = by_commodity(task.load)
        # What another robot took on, or nobody, is not on board: `load` says that of the pair, not of the amounts.
        for name, amount in self._pending.pop(task.delivers or "", {}).items():
            self._add(name, -amount)

    def _add(self, name: str, amount: float) -> None:
        self._load[name] = self._load.get(name, 0.0) + amount
        self._most[name] = max(self._most.get(name, 0.0), abs(self._load[name]), abs(amount))

    def _unload(self) -> None:
        """Put down all but what tasks deliver."""
        self._load = {}
        for load in self._pending.values():
            for name, amount in load.items():
                self._add(name, amount)
