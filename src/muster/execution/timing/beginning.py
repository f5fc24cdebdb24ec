"""When work on a task may begin: prerequisites, lags, time windows, deadlines, and the team that must be there.

Tasks tied by `starts_with` are one unit: they begin at the same moment, when each of them may.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.timing.teams import lacking
from muster.mission.model import Robot, Task
from muster.state.task_ledger import TIME_ROUNDING_S, Ledger


@dataclass(frozen=True)
class Wait:
    """Why robots wait at a task.

    Parameters
    ----------
    cause
        `prerequisite`, `window`, `lag`, `team`, `start` (tasks that begin with it), `dependant` (one that must begin
        soon after it) or `shift` (a robot rests before the work would be done).
    words
        the same for a person: `waits for team: r_2`.
    until_s
        when it is over, if the clock alone ends it; else inf.
    """

    cause: str
    words: str
    until_s: float = math.inf


@dataclass(frozen=True)
class Missed:
    """Why a task cannot begin any more, or not in the window that was meant.

    Parameters
    ----------
    rule
        the word of the rule: `window`, `deadline` or `prerequisite`.
    reason
        in words, which begin with the rule's.
    next_s
        when it may begin all the same: the next window opens; None: never.
    """

    rule: str
    reason: str
    next_s: float | None = None


@dataclass(frozen=True)
class Beginning:
    """Says whether work may begin.

    Parameters
    ----------
    ledger, crew
        of the executor.
    hold_until_s
        when a task should begin, if one that depends on it must begin soon after it; see `Forecast`.
    alone
        whether the crew is the whole team: else who belongs to a task is for the other robots to say.
    """

    ledger: Ledger
    crew: Mapping[str, RobotState]
    hold_until_s: Callable[[str, float], float]
    alone: bool = True

    def must_ask(self, task: str, robot: Robot) -> bool:
        """Whether a robot stops at a task before it begins: whether it may is not known when it sets out."""
        if robot.shifts_s or self.ledger.has_within(task):
            return True
        return any(_is_bound(self.ledger.tasks[name]) for name in self.ledger.unit(task))

    def wait(self, task: str, now: float) -> Wait | None:
        """Why robots must wait at a task now; None: work may begin."""
        return next(self._waits(task, now), None)

    def earliest_s(self, task: str, now: float) -> float:
        """When work may begin at the earliest, as far as that is known; inf if more than the clock delays it."""
        return max((wait.until_s for wait in self._waits(task, now)), default=now)

    def missed(self, task: str, now: float) -> Missed | None:
        """Why a task can never begin any more; None: it still can."""
        return next((found for name in self.ledger.unit(task) for found in self._missed(name, now)), None)

    def in_time_until_s(self, task: str, now: float) -> float:
        """Until when a task that is not missed now cannot be: until then no window closes, and no time is over."""
        ends = [end for name in self.ledger.unit(task) for end in self._time_limits_s(name, now)]
        return min((end for end in ends if end >= now), default=math.inf)

    def present(self, task: str) -> list[RobotState]:
        """The robots that wait at a task."""
        return [state for state in self.assigned(task) if _waits_at(state, task)]

    def assigned(self, task: str) -> list[RobotState]:
        """The robots that have a task in their routes."""
        return [state for state in self.crew.values() if not state.out and task in state.route]

    def _waits(self, task: str, now: float) -> Iterator[Wait]:
        unit = self.ledger.unit(task)
        missing = list(dict.fromkeys(before for name in unit for before in self.ledger.missing(name)))
        if missing:
            yield Wait("prerequisite", f"waits for {', '.join(missing)}")
        opens = next_begin([self.ledger.tasks[name] for name in unit], now)
        if opens > now + TIME_ROUNDING_S:
            yield Wait("window", f"waits for window: opens at {_seconds(opens)}", opens)
        yield from self._lag(unit, now)
        if self.alone:
            yield from self._absent(task, unit)
        yield from self._rests(unit, now if math.isinf(opens) else opens)
        hold = self.hold_until_s(task, now)
        if hold > now + TIME_ROUNDING_S:
            after = ", ".join(self.ledger.within_dependants(unit))
            yield Wait("dependant", f"waits so that {after} can begin in time after it", hold)

    def _lag(self, unit: Sequence[str], now: float) -> Iterator[Wait]:
        for name in unit:
            for before, (earliest, _) in self.ledger.lag_limits(name).items():
                if earliest > now + TIME_ROUNDING_S:
                    yield Wait("lag", f"waits for lag: {_seconds(earliest)}, after {before}", earliest)

    def _rests(self, unit: Sequence[str], now: float) -> Iterator[Wait]:
        """A robot would have to rest before the work is done: all begin when each of them works through."""
        for name in unit:
            here = self.present(name)
            lasts_s = max((state.work_s for state in here), default=0.0)
            for state in here:
                begins = state.robot.set_out(now, lasts_s)
                if begins > now + TIME_ROUNDING_S:
                    words = f"waits for shift: {state.robot.id} works from {_seconds(begins)} on"
                    yield Wait("shift", words, begins)

    def _absent(self, task: str, unit: Sequence[str]) -> Iterator[Wait]:
        for name in sorted(unit, key=lambda other: other != task):
            cause = "team" if name == task else "start"
            here = self.present(name)
            absent = [state.robot.id for state in self.assigned(name) if state not in here]
            need = lacking(self.ledger.tasks[name], [state.robot for state in here])
            if absent or need:
                who = ", ".join(absent) or need
                yield Wait(cause, f"waits for team: {who}" if name == task else f"waits for start with {name}: {who}")

    def _missed(self, name: str, now: float) -> Iterator[Missed]:
        task = self.ledger.tasks[name]
        if next_begin([task], now) == math.inf:
            closed = max(end for _, end in task.window_s if end is not None)
            yield Missed("window", f"window: closed at {_seconds(closed)}")
        if task.deadline_s is not None and now > task.deadline_s + TIME_ROUNDING_S:
            yield Missed("deadline", f"deadline: {_seconds(task.deadline_s)} is over")
        for before, (earliest, latest) in self.ledger.lag_limits(name).items():
            if next_begin([task], max(now, earliest)) > latest + TIME_ROUNDING_S:
                ended = _seconds(self.ledger.ends_s[before])
                within = _seconds(latest - self.ledger.ends_s[before])
                yield Missed(
                    "prerequisite", f"prerequisite: not begun within {within} after {before}, ended at {ended}"
                )

    def _time_limits_s(self, name: str, now: float) -> Iterator[float]:
        """The last moments of a task's windows, deadline and lags; now, of a lag that has not begun."""
        task = self.ledger.tasks[name]
        yield from (last + TIME_ROUNDING_S for _, last in task.window_s if last is not None)
        if task.deadline_s is not None:
            yield task.deadline_s + TIME_ROUNDING_S
        limits = self.ledger.lag_limits(name)
        yield from (latest + TIME_ROUNDING_S for _, latest in limits.values())
        if len(limits) < len(task.lags):
            yield now


def next_begin(tasks: Sequence[Task], now: float) -> float:
    """The earliest time, not before `now`, at which windows of all tasks are open together; inf if there is none."""
    begin = now
    while begin < math.inf:
        opens = max((_opens(task, begin) for task in tasks), default=begin)
        if opens <= begin:
            return begin
        begin = opens
    return begin


def _opens(task: Task, now: float) -> float:
    if not task.window_s:
        return now
    ahead = [
        first for first, last in task.window_s if last is None or now <= last + TIME_ROUNDING_S
    ]  # windows are in order of time
    return max(now, ahead[0]) if ahead else math.inf


def _is_bound(task: Task) -> bool:
    """Whether more than prerequisites says when a task may begin."""
    lagged = any(lag.after_s > 0 or lag.within_s is not None for lag in task.lags.values())
    return bool(task.window_s or task.deadline_s is not None or task.is_for_team or task.starts_with) or lagged


def _waits_at(state: RobotState, task: str) -> bool:
    return state.activity is Activity.WAITING and state.route[:1] == [task]


def _seconds(value: float) -> str:
    return f"{round(value, 1):,g} s"
