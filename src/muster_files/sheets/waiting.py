"""Why robots wait: what opens, ends or arrives at the very moment at which they begin.

The judge's schedule is the earliest one. So a robot begins when the last of all lower bounds on that moment is reached,
and the bounds that equal the moment are the reasons.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cached_property

from muster.mission.model import Mission, Task
from muster.verification import Stop, Verdict

_SAME_S = 1e-6


class Waiting:
    """The reasons for the waiting of all robots of a plan."""

    def __init__(self, mission: Mission, verdict: Verdict) -> None:
        self._tasks = {task.id: task for task in mission.tasks}
        self._at: dict[str, dict[str, Stop]] = defaultdict(dict)
        for route in verdict.routes:
            for stop in route.stops:
                if not stop.is_station:
                    self._at[stop.name][route.robot] = stop

    def reasons(self, robot: str, stop: Stop) -> tuple[str, ...]:
        """What the robot waits for at a stop; empty where it begins at once."""
        if stop.waits_s <= _SAME_S:
            return ()
        if stop.is_station:
            return ("a free slot",)
        found = dict.fromkeys(why for task in self._together(stop.name) for why in self._of(task, robot, stop))
        return tuple(found) or ("the schedule",)

    def _of(self, task: Task, robot: str, stop: Stop) -> Iterator[str]:
        own = "" if task.id == stop.name else f" of {task.id}"
        if any(_same(opens, stop.starts_s) for opens, _ in task.window_s):
            yield f"its time window{own}"
        yield from (r for r, there in self._at[task.id].items() if r != robot and _same(there.arrives_s, stop.starts_s))
        for name in task.prerequisites:
            after_s = task.lag(name).after_s
            if any(_same(done.ends_s + after_s, stop.starts_s) for done in self._at[name].values()):
                yield f"the end of {name}" + (f" and {after_s:g} s more" if after_s else "")
        for dependant in self._soon_after[task.id]:
            within_s = dependant.lag(task.id).within_s
            begins = [there.starts_s for there in self._at[dependant.id].values()]
            if within_s is not None and any(_same(begin - within_s, stop.ends_s) for begin in begins):
                yield f"{dependant.id}, which must begin within {within_s:g} s"

    def _together(self, name: str) -> list[Task]:
        """The task, and those that begin at the same moment."""
        found, ahead = {name}, [name]
        while ahead:
            more = self._partners[ahead.pop()] - found
            found |= more
            ahead += sorted(more)
        return [self._tasks[name], *(self._tasks[other] for other in sorted(found - {name}))]

    @cached_property
    def _partners(self) -> dict[str, set[str]]:
        """For each task those that begin with it, whichever of the two says so."""
        found: dict[str, set[str]] = defaultdict(set)
        for task in self._tasks.values():
            for other in task.starts_with:
                found[task.id].add(other)
                found[other].add(task.id)
        return found

    @cached_property
    def _soon_after(self) -> dict[str, list[Task]]:
        """For each task those that have to begin soon after its end."""
        found: dict[str, list[Task]] = defaultdict(list)
        for task in self._tasks.values():
            for name in task.prerequisites:
                found[name].append(task)
        return found


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= _SAME_S * max(1.0, abs(a), abs(b))
