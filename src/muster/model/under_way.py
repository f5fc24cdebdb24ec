"""The plan model of a mission under way, by ids: what the rules in force ask of tasks, given when others ended.

No travel is looked up, so that it is cheap to compile the rules again whenever tasks come, go or change.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import is_not

import numpy as np

from muster.mission.model import Mission, Robot, Task
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.mission.task_relations import IN_ITS_PLACE
from muster.model.bottleneck import matched
from muster.model.parts import Openings
from muster.model.plan_model import PlanModel
from muster.model.problem import Problem
from muster.model.robot_limits import RobotLimits
from muster.model.rules.rule import listed
from muster.model.rules.team import missing_of_seat
from muster.model.rules.times import rounded

_ROUNDING = 1e-9  # relative; by which sums may be below what is needed


@dataclass(frozen=True)
class Wait:
    """Why robots wait at a task.

    Parameters
    ----------
    cause
        `prerequisite`, `window`, `lag`, `team`, `start` (tasks that begin with it) or `dependant` (one that must begin
        soon after it).
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
    """Why a task cannot begin any more, or not in the opening that was meant.

    Parameters
    ----------
    limit
        the primitive: `openings`, `ends_by` or `gaps`.
    reason
        in words, which begin with the rule's.
    next_s
        when it may begin all the same, in the next opening; None: never.
    """

    limit: str
    reason: str
    next_s: float | None = None


class _Group:
    """Tasks that were compiled together: of those of another group nothing is said in their terms."""

    def __init__(self, names: list[str], model: PlanModel) -> None:
        self.names, self.model = names, model
        self.soon_after: dict[int, list[int]] = {}
        for j, gaps in model.parts.gaps.items():
            for k in (k for k, (_, most_s) in gaps.items() if most_s < math.inf):
                self.soon_after.setdefault(k, []).append(j)

    @property
    def is_timed(self) -> bool:
        """Whether more than the order of tasks says when any of them may begin, or several robots do one."""
        parts = self.model.parts
        gaps = (gap for own in parts.gaps.values() for gap in own.values())
        bound = parts.openings or parts.ends_by or parts.together or self.model.with_teams
        return bool(bound) or any(gap != (0.0, math.inf) for gap in gaps)


@dataclass(eq=False)
class UnderWay:
    """What rules ask of the tasks of a mission under way.

    Parameters
    ----------
    mission
        whose rules hold; robots and tasks may have come to it, or gone, since.
    tasks
        those that there are; a task that one waits for and that is none of them has ended.
    ignored
        rules that do not hold.
    """

    mission: Mission
    tasks: Collection[Task]
    ignored: Collection[str] = ()
    _limits: dict[str, tuple[Robot, RobotLimits]] = field(default_factory=dict)
    _lacking: dict[str, tuple[Sequence[object], str]] = field(default_factory=dict)  # as last asked about each task

    def __post_init__(self) -> None:
        self._of: dict[str, tuple[_Group, int]] = {}
        self._timed: list[_Group] = []
        self._exclusive: list[_Group] = []
        there = {task.id for task in self.tasks}
        self._add(task.waiting_for(filter(there.__contains__, task.prerequisites)) for task in self.tasks)

    def add(self, task: Task) -> None:
        """Add a task that names no other. It is compiled by itself, so it costs as much however many there are."""
        self._add([task.waiting_for(())])

    def _add(self, tasks: Iterable[Task]) -> None:
        added = tuple(tasks)
        group = _Group([task.id for task in added], self._problem(added, self.mission.robots).model)
        self._of |= {name: (group, j) for j, name in enumerate(group.names)}
        if group.is_timed:
            self._timed.append(group)
        if group.model.parts.exclusive:
            self._exclusive.append(group)

    def _problem(self, tasks: tuple[Task, ...], robots: Sequence[Robot]) -> Problem:
        mission, ignored = self.mission, tuple(self.ignored)
        objective = mission.rules.objective
        return Problem(mission=mission, objective=objective, ignored=ignored, robots=tuple(robots), tasks=tasks)

    # What is asked of a task, whatever has happened.

    @property
    def is_timed(self) -> bool:
        """Whether more than the order of tasks says when any of them may begin, or several robots do one."""
        return bool(self._timed)

    def is_bound(self, task: str) -> bool:
        """Whether more than the order of tasks says when a task, or one that begins with it, may begin."""
        members = self.unit(task)
        return len(members) > 1 or any(map(self._is_bound, members))

    def _is_bound(self, task: str) -> bool:
        timed = self.openings(task) or self.ends_by_s(task) < math.inf
        return bool(timed or self.is_for_team(task) or self.gaps(task))

    def is_for_team(self, task: str) -> bool:
        """Whether several robots may have to do a task."""
        group, j = self._of[task]
        return group.model.is_for_team(j)

    def unit(self, task: str) -> tuple[str, ...]:
        """The tasks that begin together with a task, itself included."""
        group, j = self._of[task]
        return tuple(group.names[k] for k in group.model.units[group.model.unit[j]])

    def before(self, task: str) -> dict[str, tuple[float, float]]:
        """The tasks that end before a task begins; how long before that at least, and at most."""
        group, j = self._of[task]
        gaps, pickup = dict(group.model.parts.gaps.get(j, {})), group.model.pickups[j]
        if pickup >= 0:
            gaps.setdefault(pickup, (0.0, math.inf))
        return {group.names[k]: gap for k, gap in gaps.items()}

    def gaps(self, task: str) -> dict[str, tuple[float, float]]:
        """The same of those tasks alone for which more is said than the order."""
        return {before: gap for before, gap in self.before(task).items() if gap != (0.0, math.inf)}

    def soon_after(self, tasks: Collection[str]) -> list[str]:
        """The tasks that must begin within some time after one of these."""
        of = [self._of[name] for name in tasks]
        return list(dict.fromkeys(group.names[k] for group, j in of for k in group.soon_after.get(j, ())))

    def delivers(self, task: str, pickup: str) -> bool:
        """Whether a task delivers what another takes on board."""
        (group, j), (group_of_pickup, k) = self._of[task], self._of[pickup]
        return group is group_of_pickup and group.model.pickups[j] == k

    def too_long_between(self, task: str, after: str, takes_s: float) -> str:
        """Why a task cannot begin soon enough after another, which takes so long at least; empty: it can."""
        most_s = self.before(after)[task][1]
        if takes_s <= most_s + TIME_ROUNDING_S:
            return ""
        word = self._giver("gaps", task, after)
        way = f"the way on board from the end of {task} to the begin of {after}"
        return f"{word}: {way} takes at least {takes_s:,.1f} s; expected at most {most_s:,g} s"

    def by_the_same(self, task: str) -> list[str]:
        """The tasks that the robots of a task do, if they are done."""
        group, j = self._of[task]
        return [group.names[k] for k in group.model.same_crew[j]]

    def by_others(self, task: str) -> list[str]:
        """The tasks that none of the robots of a task does."""
        group, j = self._of[task]
        return [group.names[k] for k in group.model.apart[j]]

    def alternatives(self, task: str) -> list[str]:
        """The tasks of which none is done if a task is."""
        group, j = self._of[task]
        return [group.names[k] for k in group.model.exclusive[j]]

    def replaced(self, begun: Container[str], over: Container[str]) -> dict[str, str]:
        """The tasks in whose place another is done, which has begun; and why they are not done.

        What delivers what a task took on that has begun is to be done, if it is not over for another reason.
        """
        found = {}
        for group in self._exclusive:
            word, pickups = group.model.word_of("exclusive"), group.model.pickups
            for j in (j for j in group.model.parts.exclusive if group.names[j] not in begun):
                others = (k for k in group.model.exclusive[j] if _is_chosen(group, k, pickups[k], begun, over))
                if (other := next(others, None)) is not None:
                    found[group.names[j]] = f"{word}: {group.names[other]} is {IN_ITS_PLACE}"
        return found

    def _giver(self, limit: str, *tasks: str) -> str:
        """The word of the rule whose bound of a task, or of two, holds."""
        group, _ = self._of[tasks[0]]
        return group.model.given_by(limit, *(self._of[task][1] for task in tasks))

    def openings(self, task: str) -> Openings:
        """When a task may begin; empty: at any time."""
        group, j = self._of[task]
        return group.model.openings[j]

    def ends_by_s(self, task: str) -> float:
        """When a task has ended at the latest; inf: whenever."""
        group, j = self._of[task]
        return float(group.model.ends_by[j])

    def last_begin_s(self, task: str) -> float:
        """The latest time at which a task may begin, travel and work not counted; inf: whenever."""
        openings = self.openings(task)
        return min(openings[-1][1] if openings else math.inf, self.ends_by_s(task))

    def over_by_s(self, robot: Robot) -> float:
        """When the route of a robot is over at the latest; inf: whenever."""
        return self.limits(robot).over_by_s

    def limits(self, robot: Robot) -> RobotLimits:
        """What is asked of a robot, of the mission or not."""
        known = self._limits.get(robot.id)
        if known is None or known[0] is not robot:
            limits = RobotLimits.of(self._problem((), (robot,)).model, self.mission.stations)
            known = self._limits[robot.id] = robot, limits
        return known[1]

    def next_begin_s(self, tasks: Collection[str], now: float) -> float:
        """The earliest time, not before `now`, at which all of these may begin; inf if there is none."""
        begin = now
        while begin < math.inf:
            opens = max((_opens(self.openings(name), begin) for name in tasks), default=begin)
            if opens <= begin:
                return begin
            begin = opens
        return begin

    # What is left of it, where tasks have ended at some times.

    def spans(self, task: str, ends_s: Mapping[str, float]) -> dict[str, tuple[float, float]]:
        """For the tasks of `gaps` that have ended when a task begins at the earliest and at the latest."""
        gaps = self.gaps(task).items()
        return {k: (ends_s[k] + least_s, ends_s[k] + most_s) for k, (least_s, most_s) in gaps if k in ends_s}

    def waits(self, unit: Collection[str], now: float, ends_s: Mapping[str, float]) -> Iterator[Wait]:
        """What tasks that begin together wait for now, but for robots."""
        missing = dict.fromkeys(before for name in unit for before in self.before(name) if before not in ends_s)
        if missing:
            yield Wait("prerequisite", f"waits for {listed(missing)}")
        opens = self.next_begin_s(unit, now)
        if opens > now + TIME_ROUNDING_S:
            closed = next(name for name in unit if self.next_begin_s([name], now) > now)
            yield Wait("window", f"waits for {self._giver('openings', closed)}: opens at {rounded(opens)}", opens)
        for name in unit:
            for before, (earliest, _) in self.spans(name, ends_s).items():
                if earliest > now + TIME_ROUNDING_S:
                    yield Wait("lag", f"waits for lag: {rounded(earliest)}, after {before}", earliest)

    def missed(self, task: str, now: float, ends_s: Mapping[str, float]) -> Iterator[Missed]:
        """Why a task can never begin any more; nothing: it still can."""
        if self.next_begin_s([task], now) == math.inf:
            yield self._missed("openings", task, f"closed at {rounded(self.openings(task)[-1][1])}")
        if now > (by_s := self.ends_by_s(task)) + TIME_ROUNDING_S:
            yield self._missed("ends_by", task, f"{rounded(by_s)} is over")
        for before, (earliest, latest) in self.spans(task, ends_s).items():
            if self.next_begin_s([task], max(now, earliest)) > latest + TIME_ROUNDING_S:
                ended_s = ends_s[before]
                words = f"not begun within {rounded(latest - ended_s)} after {before}, ended at {rounded(ended_s)}"
                yield self._missed("gaps", task, words, before)

    def _missed(self, limit: str, task: str, words: str, before: str | None = None) -> Missed:
        at = [name for name in (before, task) if name is not None]
        return Missed(limit, f"{self._giver(limit, *at)}: {words}")

    def missed_opening(self, task: str, meant_s: float, now: float) -> Missed | None:
        """That the opening in which a task was meant to begin is over, and another one is to come; None: it is not."""
        openings = self.openings(task)
        for opens, closes in openings if len(openings) > 1 else ():
            if opens - TIME_ROUNDING_S <= meant_s <= closes and now > closes + TIME_ROUNDING_S:
                next_s = self.next_begin_s([task], now)
                words = f"closed at {closes:,g} s; the next is open from {next_s:,g} s on"
                return replace(self._missed("openings", task, words), next_s=next_s)
        return None

    def begins_by_s(self, task: str, begin_s: float, lasts_s: float, ends_s: Mapping[str, float]) -> float:
        """Until when a task may be put off that is to begin at a time and lasts so long; inf: for ever."""
        closes_s = [closes for opens, closes in self.openings(task) if opens <= begin_s <= closes]
        latest_s = [latest for _, latest in self.spans(task, ends_s).values()]
        return min([*closes_s, self.ends_by_s(task) - lasts_s, *latest_s])

    def time_limits_s(self, task: str, now: float, ends_s: Mapping[str, float]) -> Iterator[float]:
        """The last moments that limit a task's times; now, for a gap after a task that has not ended."""
        yield from (closes + TIME_ROUNDING_S for _, closes in self.openings(task) if closes < math.inf)
        yield self.ends_by_s(task) + TIME_ROUNDING_S
        spans = self.spans(task, ends_s)
        yield from (latest + TIME_ROUNDING_S for _, latest in spans.values())
        if len(spans) < len(self.gaps(task)):
            yield now

    def too_late(
        self, task: str, robot: RobotLimits, arrive_s: float, lasts_s: float, home_s: float, left_s: float | None = None
    ) -> str:
        """Why a robot that is at a task at a time cannot do it and be back in time; empty: it can.

        `left_s` is when it left its start.
        """
        begin_s, works_s = -math.inf, arrive_s
        while begin_s < works_s < math.inf:
            begin_s = self.next_begin_s([task], works_s)
            works_s = robot.set_out(begin_s, lasts_s)
        if begin_s == math.inf:
            return f"{self._giver('openings', task)}: would arrive at {arrive_s:,.1f} s, after it has closed"
        if works_s == math.inf:
            return robot.never("the work")
        ends_s, by_s = works_s + lasts_s, self.ends_by_s(task)
        if ends_s > by_s + TIME_ROUNDING_S:
            return f"{self._giver('ends_by', task)}: would end at {ends_s:,.1f} s, after {by_s:,g} s"
        return robot.too_late(ends_s, home_s, left_s)

    # Who does it.

    def lacking(self, task: Task, robots: Sequence[Robot]) -> str:
        """What robots lack to be the crew of a task, in words; empty if they are enough."""
        asked = task, *robots
        known = self._lacking.get(task.id)
        if known is None or len(known[0]) != len(asked) or any(map(is_not, known[0], asked)):
            known = self._lacking[task.id] = asked, self._lack(task, robots)
        return known[1]

    def _lack(self, task: Task, robots: Sequence[Robot]) -> str:
        model = self._problem((task.waiting_for(()),), robots).model
        if sums := model.sums(0):
            have = ((name, float(able.sum()), needed) for name, (needed, able) in sums.items())
            short = [f"{has:g} of {needed:g} {name}" for name, has, needed in have if has < needed * (1 - _ROUNDING)]
            return ", ".join(short if robots else [*short, "a robot"])
        seat_of = [seat for seat, (count, _) in enumerate(model.seats(0)) for _ in range(count)]
        fits = np.array([model.seats(0)[seat][1] for seat in seat_of], dtype=np.bool_)
        filled = matched(fits.reshape(len(seat_of), len(robots))).values()
        empty = [seat for place, seat in enumerate(seat_of) if place not in filled]
        return missing_of_seat(task, empty[0], len(empty)) if empty else ""

    def crew_size(self, task: str) -> int | None:
        """How many robots do a task; None: as many as are able enough together."""
        group, j = self._of[task]
        return None if group.model.sums(j) else sum(count for count, _ in group.model.seats(j))

    def able(self, task: Task, robots: Sequence[Robot]) -> list[str]:
        """The robots that may do a task, as one of several if need be: skills, suitability, locks, and its action."""
        allowed = self._problem((task.waiting_for(()),), robots).allowed[:, 0]
        return [robot.id for robot, may in zip(robots, allowed.tolist(), strict=True) if may]


def _is_chosen(group: _Group, j: int, pickup: int, begun: Container[str], over: Container[str]) -> bool:
    """Whether a task has begun, or delivers what is on board."""
    name = group.names[j]
    return name in begun or (pickup >= 0 and group.names[pickup] in begun and name not in over)


def _opens(openings: Openings, now: float) -> float:
    """When the opening is that is the next from a time on."""
    if not openings:
        return now
    return max(now, next((opens for opens, closes in openings if now <= closes + TIME_ROUNDING_S), math.inf))
