"""The task ledger: all tasks, the progress of each, and why one is lost. Entries are never removed."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace

from muster.mission.model import Point, Task


@dataclass
class Ledger:
    """What is known of each task.

    Parameters
    ----------
    tasks
        every task that there is or was, in order of appearance.
    needs_order
        whether prerequisites hold.
    """

    tasks: dict[str, Task]
    needs_order: bool
    delays_s: dict[str, float] = field(default_factory=dict)
    arrivals_s: dict[str, float] = field(default_factory=dict)
    arrival_usage: dict[str, float] = field(default_factory=dict)  # of the robot, when it came to the task
    starts_s: dict[str, float] = field(default_factory=dict)
    ends_s: dict[str, float] = field(default_factory=dict)
    done_by: dict[str, str] = field(default_factory=dict)
    usage: dict[str, tuple[float, float]] = field(default_factory=dict)  # of tasks done: planned, flown
    cancelled: dict[str, float] = field(default_factory=dict)
    refusals: dict[str, dict[str, str]] = field(default_factory=dict)  # task, robot: why that robot cannot do it
    blocked_by: dict[str, str] = field(default_factory=dict)  # task: the broken robot that stands there

    @classmethod
    def of(cls, tasks: Iterable[Task], needs_order: bool) -> Ledger:
        return cls({task.id: task for task in tasks}, needs_order)

    @property
    def open(self) -> list[Task]:
        """Tasks that are neither done nor cancelled, work under way included."""
        return [task for name, task in self.tasks.items() if name not in self.ends_s and name not in self.cancelled]

    def lost(
        self, why: Callable[[str], str], gone: Mapping[str, str], under_way: Collection[str] = ()
    ) -> dict[str, str]:
        """Every task that is not done, nor under way, and the reason.

        Parameters
        ----------
        why
            the reason of a task that is not cancelled.
        gone
            by robot that takes no part any more since when, and why.
        """
        who = ", ".join(f"{robot} ({since})" for robot, since in gone.items())
        out = f"; no longer taking part: {who}" if gone else ""
        lost = {name: f"cancelled at {round(at_s, 1):g} s" for name, at_s in self.cancelled.items()}
        lost |= {task.id: why(task.id) + out for task in self.open if task.id not in under_way}
        return {name: lost[name] for name in self.tasks if name in lost}

    @property
    def waiting_s(self) -> float:
        """Seconds that robots waited at tasks that were begun."""
        return sum(map(self.waited_s, self.starts_s))

    def waited_s(self, task: str) -> float:
        """Seconds that a robot waited at a task that was begun."""
        return self.starts_s[task] - self.arrivals_s[task]

    def may_begin(self, task: str) -> bool:
        """Whether all prerequisites have ended."""
        return not self.needs_order or all(name in self.ends_s for name in self.tasks[task].prerequisites)

    def missing(self, task: str) -> list[str]:
        """Prerequisites that have not ended."""
        return [name for name in self.tasks[task].prerequisites if self.needs_order and name not in self.ends_s]

    def arrive(self, task: str, used: float, now: float) -> None:
        self.arrivals_s[task], self.arrival_usage[task] = now, used

    def begin(self, task: str, now: float) -> None:
        self.starts_s[task] = now

    def give_up(self, task: str) -> None:
        """The robot that was at it is no more."""
        if task not in self.ends_s:
            self.arrivals_s.pop(task, None)
            self.arrival_usage.pop(task, None)
            self.starts_s.pop(task, None)

    def end(self, task: str, robot: str, now: float) -> None:
        self.ends_s[task] = now
        self.done_by[task] = robot

    def refuse(self, task: str, robot: str, reason: str) -> None:
        self.refusals.setdefault(task, {})[robot] = reason

    def unblock(self, robot: str) -> None:
        """Unblock the tasks that a broken robot had blocked: it moves again, so other robots may try them."""
        for task in [task for task, by in self.blocked_by.items() if by == robot]:
            del self.blocked_by[task]
            self.refusals.pop(task, None)

    def move(self, task: str, to: Point) -> None:
        """A task is elsewhere from now on."""
        self.tasks[task] = moved(self.tasks[task], to)

    def delay(self, task: str, by_s: float) -> None:
        self.delays_s[task] = self.delays_s.get(task, 0.0) + by_s

    def withdraw(self, task: str, now: float) -> None:
        self.cancelled[task] = now
        self.give_up(task)


def moved(task: Task, to: Point) -> Task:
    """The task elsewhere; its entry and exit move with it."""

    def shifted(point: Point | None) -> Point | None:
        if point is None:
            return None
        return tuple(c + b - a for c, a, b in zip(point, task.position, to, strict=True))

    return replace(task, position=to, entry=shifted(task.entry), exit=shifted(task.exit))
