"""The task ledger: all tasks, the progress of each, and why one is lost. Only events change it.

Entries are removed only of standing fleets, and live on in sums (`Retired`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from muster.mission.goods import as_amount
from muster.mission.ignorable_rules import as_it_holds
from muster.mission.model import Mission, Point, Robot, Task
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.mission.task_relations import beginning_apart, tasks_named_by
from muster.state.reasons import begins_with, cancelled_at, some_of

if TYPE_CHECKING:
    from muster.model.under_way import UnderWay

KEPT_LOST = 20
"""How many tasks that were lost and forgotten are still listed with the reason: the last ones."""


@dataclass(frozen=True)
class MissedTask:
    """A task that was not begun in time: noticed when, and why; `next_s` is when it may begin all the same, or None."""

    task: str
    at_s: float
    reason: str
    next_s: float | None


@dataclass
class Retired:
    """What tasks came to that a standing fleet has forgotten, all together.

    Parameters
    ----------
    done, cancelled, lost
        how many.
    waiting_s
        as `Ledger.waiting_s`.
    lateness_s, lateness
        after due times, and weighed by priority.
    arrival_usage
        the sum over tasks done.
    last_end_s
        when the last of them ended.
    last_lost
        the last that were lost, and why; as people ask for these, they are listed still.
    """

    done: int = 0
    cancelled: int = 0
    lost: int = 0
    waiting_s: float = 0.0
    lateness_s: float = 0.0
    lateness: float = 0.0
    arrival_usage: float = 0.0
    last_end_s: float = 0.0
    last_lost: dict[str, str] = field(default_factory=dict)

    def lose(self, task: str, reason: str) -> None:
        """A task that was lost is forgotten."""
        self.lost += 1
        self.last_lost.pop(task, None)  # an earlier one of that id: the last comes last
        self.last_lost[task] = reason
        if len(self.last_lost) > KEPT_LOST:
            del self.last_lost[next(iter(self.last_lost))]


@dataclass
class Ledger:
    """What is known of each task.

    Parameters
    ----------
    mission
        whose rules hold.
    ignored
        rules that do not hold: tasks are kept without them.
    tasks
        every task that there is or was, in order of appearance.
    """

    mission: Mission
    ignored: Collection[str] = ()
    tasks: dict[str, Task] = field(default_factory=dict)
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
    teams: dict[str, tuple[str, ...]] = field(default_factory=dict)  # the robots of each task begun
    team_waits_s: dict[str, float] = field(default_factory=dict)  # their waiting for it, in all
    missed: list[MissedTask] = field(default_factory=list)
    expired: dict[str, str] = field(default_factory=dict)  # tasks that can never begin any more, and why
    told_lost: dict[str, str] = field(default_factory=dict)  # tasks that the end of the mission found not done, and why
    retired: Retired = field(default_factory=Retired)
    touched: dict[str, None] = field(default_factory=dict)  # tasks that the last event has brought on, or moved
    revision: int = 0  # how often tasks came, went or were opened again
    _model: UnderWay | None = None

    @classmethod
    def of(cls, mission: Mission, ignored: Collection[str] = ()) -> Ledger:
        ledger = cls(mission, ignored)
        for task in mission.tasks:
            ledger.add(task)
        return ledger

    @property
    def model(self) -> UnderWay:
        """What rules ask of the tasks as they are now."""
        if self._model is None:
            from muster.model.under_way import UnderWay  # with NumPy, without which events are known and said

            self._model = UnderWay(self.mission, tuple(self.tasks.values()), self.ignored)
        return self._model

    def add(self, task: Task) -> None:
        """A task that there is from now on.

        One that comes too late to begin with another can never begin. It is tied to none: no other waits for it.
        """
        is_again = task.id in self.tasks
        self.tasks[task.id] = as_it_holds(task, self.ignored)
        self.touched[task.id] = None
        self.revision += 1
        is_tied = bool(tasks_named_by(task))
        if is_tied or is_again:
            self._model = None
        elif self._model is not None:
            self._model.add(self.tasks[task.id])
        if is_tied and (self.starts_s or self.ends_s or self.cancelled):
            self._expire_if_too_late(task.id)

    def _expire_if_too_late(self, task: str) -> None:
        others = [name for name in self.unit(task) if name != task]
        if late := self.too_late_to_begin_with(others):
            self.expired[task] = late
            self.tasks[task] = beginning_apart(self.tasks[task], others)
            self.tasks |= {name: beginning_apart(self.tasks[name], [task]) for name in others}
            self._model = None

    def as_it_holds(self, robot: Robot) -> Robot:
        """A robot without what does not hold."""
        return as_it_holds(robot, self.ignored)

    def too_late_to_begin_with(self, tasks: Iterable[str]) -> str:
        """Why nothing can begin together with these tasks any more; empty if it still can."""
        for name in tasks:
            over = "is done" if name in self.ends_s else "is cancelled" if name in self.cancelled else ""
            if over or name in self.starts_s:
                return f"{begins_with(name)}, which {over or 'has begun'}"
        return ""

    def unit(self, task: str) -> tuple[str, ...]:
        """The tasks that begin together with a task, itself included."""
        return self.model.unit(task)

    def is_joint(self, task: str) -> bool:
        """Whether several robots begin the task at the same moment: as a team, or with tasks that are tied to it."""
        return self.model.is_for_team(task) or len(self.unit(task)) > 1

    def dependants_soon_after(self, unit: Collection[str]) -> list[str]:
        """Tasks not done that must begin within some time after one of these."""
        return [name for name in self.model.soon_after(unit) if self.is_open(name)]

    def must_be_followed(self, task: str) -> bool:
        """Whether a task must begin soon after this one."""
        return bool(self.dependants_soon_after(self.unit(task)))

    @property
    def open(self) -> list[Task]:
        """Tasks that are neither done nor cancelled, work under way included."""
        return [task for name, task in self.tasks.items() if name not in self.ends_s and name not in self.cancelled]

    @property
    def replaced(self) -> dict[str, str]:
        """The open tasks in whose place others have begun or are done, and that in words."""
        begun = {**self.starts_s, **self.ends_s}
        found = self.model.replaced(begun, {**self.expired, **self.cancelled})
        return {name: why for name, why in found.items() if self.is_open(name)}

    @property
    def barred(self) -> Mapping[str, str]:
        """The open tasks that cannot begin: never any more, or as others are in their place; and why."""
        return {**self.replaced, **self.expired}

    def is_open(self, task: str) -> bool:
        """Whether a task is neither done nor cancelled."""
        return task not in self.ends_s and task not in self.cancelled

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
        lost = {name: cancelled_at(at_s) for name, at_s in self.cancelled.items()}
        lost |= {task.id: why(task.id) + _out(task, gone) for task in self.open if task.id not in under_way}
        lost |= {name: reason for name, reason in self.replaced.items() if name in lost}
        return {name: lost[name] for name in self.tasks if name in lost}

    @property
    def lost_and_forgotten(self) -> dict[str, str]:
        """The last tasks that were lost and forgotten, and why; without those whose id has been used again."""
        return {task: reason for task, reason in self.retired.last_lost.items() if task not in self.tasks}

    @property
    def waiting_s(self) -> float:
        """Seconds that robots waited at tasks that were begun."""
        return self.retired.waiting_s + sum(map(self.waited_s, self.starts_s))

    def waited_s(self, task: str) -> float:
        """Seconds that a robot waited at a task that was begun; all robots of a team together."""
        return self.team_waits_s[task] if task in self.team_waits_s else self.starts_s[task] - self.arrivals_s[task]

    def may_begin(self, task: str) -> bool:
        """Whether all tasks have ended that end before this one."""
        return not self.missing(task)

    def missing(self, task: str) -> list[str]:
        """Tasks to end before this one that have not ended."""
        return [name for name in self.model.before(task) if name not in self.ends_s]

    def begin(self, task: str, robots: tuple[str, ...], now: float) -> None:
        """Robots begin a task."""
        self.starts_s[task], self.teams[task] = now, robots
        self.touched[task] = None
        self.told_lost.pop(task, None)

    def arrive(self, task: str, came: Collection[tuple[float, float]], now: float) -> None:
        """Robots that begin a task came to it: when, and what each had used by then."""
        self.arrivals_s[task] = max(at_s for at_s, _ in came)
        self.arrival_usage[task] = max(used for _, used in came)
        if len(came) > 1:
            self.team_waits_s[task] = sum(now - at_s for at_s, _ in came)

    def at_work(self, task: str) -> tuple[str, ...]:
        """The robots that have begun a task and not ended it."""
        return self.teams.get(task, ()) if task in self.starts_s and task not in self.ends_s else ()

    @property
    def under_way(self) -> list[str]:
        """The tasks that have been begun and not ended."""
        return [task for task in self.starts_s if self.at_work(task)]

    def break_off(self, task: str) -> None:
        """Work on a task, and on those that began with it, is broken off: what was done of it is lost."""
        if task not in self.tasks:
            return
        broken = [name for name in self.unit(task) if self.at_work(name)]
        for name in broken:
            self.give_up(name)
        if broken and (late := self.too_late_to_begin_with(self.unit(task))):
            self.expired |= dict.fromkeys(broken, late)

    def expire(self, task: str, reason: str) -> None:
        """Neither a task nor those that begin with it can begin any more."""
        for name in self.unit(task):
            if self.is_open(name):
                self.expired.setdefault(name, reason if name == task else f"{begins_with(task)}; {reason}")

    def late_s(self, task: str) -> float:
        """By how much a task done ended after its due time."""
        return _over(self.ends_s[task], self.tasks[task].due_s)

    def overdue_s(self, task: str) -> float:
        """By how much a task done ended after the latest time at which it may."""
        return _over(self.ends_s[task], self.model.ends_by_s(task))

    def begun_too_late_s(self, task: str) -> float:
        """By how much a task done began too long after a prerequisite."""
        spans = self.model.spans(task, self.ends_s).values()
        return max((_over(self.starts_s[task], latest_s) for _, latest_s in spans), default=0.0)

    def members(self, task: str) -> tuple[str, ...]:
        """The robots that do a task that has begun, or did it."""
        return self.teams.get(task, (self.done_by[task],) if task in self.done_by else ())

    def give_up(self, task: str) -> None:
        """The robot that was at it is no more."""
        if task not in self.ends_s:
            self.touched[task] = None
            self.teams.pop(task, None)
            self.team_waits_s.pop(task, None)
            self.arrivals_s.pop(task, None)
            self.arrival_usage.pop(task, None)
            self.starts_s.pop(task, None)

    def end(self, task: str, robots: tuple[str, ...], now: float) -> None:
        """Robots have done a task."""
        self.ends_s[task], self.done_by[task], self.teams[task] = now, robots[0], robots
        self.cancelled.pop(task, None)  # its robots had not heard that in time
        for name in self.unit(task):
            if self.is_open(name) and name not in self.starts_s:
                self.expired.setdefault(name, self.too_late_to_begin_with([task]))
        self.touched[task] = None
        self.told_lost.pop(task, None)

    def lose(self, task: str, reason: str) -> None:
        """The mission is over, and a task is not done."""
        if task in self.tasks:
            self.told_lost[task] = reason
            self.touched[task] = None

    def refuse(self, task: str, robot: str, reason: str) -> None:
        self.refusals.setdefault(task, {})[robot] = reason

    def try_again(self) -> None:
        """Let robots try again what they had no way to, or did not get to for others in their way."""
        self.blocked_by.clear()
        for refusals in self.refusals.values():
            for robot in [robot for robot, reason in refusals.items() if reason.startswith(("unreachable", "jam"))]:
                del refusals[robot]

    def move(self, task: str, to: Point, *, under_way: bool = False) -> None:
        """A task is elsewhere from now on: robots may try it that could not do it where it was.

        Work under way goes on there, where that is said; otherwise nobody is at it any more.
        """
        self.tasks[task] = moved(self.tasks[task], to)
        self._model = None
        self.touched[task] = None
        if not under_way:
            self.give_up(task)
        self.refusals.pop(task, None)

    def delay(self, task: str, by_s: float) -> None:
        self.delays_s[task] = self.delays_s.get(task, 0.0) + by_s

    def reopen(self, task: Task) -> None:
        """A task that was done is to be done again, as it is now."""
        self.ends_s.pop(task.id, None)
        self.done_by.pop(task.id, None)
        self.usage.pop(task.id, None)
        self.give_up(task.id)
        self.delays_s.pop(task.id, None)
        self.refusals.pop(task.id, None)
        self.tasks[task.id] = task
        self._tasks_changed()

    def withdraw(self, task: str, now: float) -> None:
        """A task is cancelled: what begins with it never can."""
        self.cancelled[task] = now
        self.give_up(task)
        self.expire(task, "cancelled")

    def settled(self, before_s: float) -> set[str]:
        """Tasks done or cancelled before a time, or that can never begin, to which no other task refers."""
        over = {name for times in (self.ends_s, self.cancelled) for name, at_s in times.items() if at_s < before_s}
        over |= {name for name in self.expired if self.is_open(name)}
        over |= {name for name in self.model.replaced(self.ends_s, self.tasks) if self.is_open(name)}
        needed = {name for task in self.tasks.values() if task.id not in over for name in tasks_named_by(task)}
        return over - needed

    def retire(self, tasks: Collection[str]) -> None:
        """Forget settled tasks, but for sums."""
        for name in tasks:
            self._sum_up(name)
        self.missed = [one for one in self.missed if one.task not in tasks]
        by_task: tuple[dict[str, Any], ...] = (
            *(self.tasks, self.delays_s, self.arrivals_s, self.arrival_usage, self.starts_s, self.ends_s, self.done_by),
            *(self.usage, self.cancelled, self.refusals, self.blocked_by, self.teams, self.team_waits_s),
            *(self.expired, self.told_lost),
        )
        for entries in by_task:
            for name in tasks:
                entries.pop(name, None)
        self._tasks_changed()

    def _tasks_changed(self) -> None:
        self.revision += 1
        self._model = None

    def _sum_up(self, task: str) -> None:
        sums = self.retired
        if task in self.starts_s:
            sums.waiting_s += self.waited_s(task)
        if task in self.ends_s:
            sums.done += 1
            sums.lateness_s += self.late_s(task)
            sums.lateness += self.tasks[task].priority * self.late_s(task)
            sums.arrival_usage += self.arrival_usage[task]
            sums.last_end_s = max(sums.last_end_s, self.ends_s[task])
        elif task in self.cancelled:
            sums.cancelled += 1
        else:
            sums.lose(task, self.told_lost[task])


def _out(task: Task, gone: Mapping[str, str]) -> str:
    """Robots that take no part any more and might have done a task."""
    who = [f"{robot} ({since})" for robot, since in gone.items() if task.is_open_to(robot)]
    return f"; no longer taking part: {some_of(who)}" if who else ""


def _over(time_s: float, limit_s: float | None) -> float:
    """By how much a time is past a limit, more than by rounding."""
    over = 0.0 if limit_s is None else time_s - limit_s
    return over if over > TIME_ROUNDING_S else 0.0


def moved(task: Task, to: Point) -> Task:
    """The task elsewhere; its entry and exit move with it."""

    def shifted(point: Point | None) -> Point | None:
        if point is None:
            return None
        return tuple(c + b - a for c, a, b in zip(point, task.position, to, strict=True))

    return replace(task, position=to, entry=shifted(task.entry), exit=shifted(task.exit))


def lying(task: Task, at: Point, amounts: Mapping[str, float]) -> Task:
    """A task that took goods on board which now lie elsewhere: they are to be taken on there.

    What its work had to wait for, by when it was to be done, and who was to do it together with whom, was kept when it
    was done first. When it may begin holds for the work that is to be done now.
    """
    has_geometry = task.action is not None and task.action.has_geometry
    there = moved(replace(task, entry=None, exit=None, action=None if has_geometry else task.action), at)
    free = as_it_holds(there, ("prerequisite", "deadline", "relation"))
    return replace(free, prerequisites=(), load=as_amount(amounts))
