"""The interface of a rule, and the change that lifts a rule for a robot and a task."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.model import Mission, Robot, Task
from muster.model.parts import Meter, Parts
from muster.model.plan_model import PlanModel

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Routes = list[list[int]]
Scores = Mapping[str, Mapping[str, float]]

ROUNDING = 2e-9
"""By how much a usage may be above a capacity, relative; a little more than the judge allows."""


class Question(Protocol):
    """What rules look at: a `Problem`."""

    @property
    def mission(self) -> Mission: ...
    @property
    def robots(self) -> tuple[Robot, ...]: ...
    @property
    def tasks(self) -> tuple[Task, ...]: ...
    @property
    def prerequisites(self) -> list[list[int]]: ...
    @property
    def task_index(self) -> dict[str, int]: ...
    @property
    def kinds(self) -> npt.NDArray[np.int32]: ...
    @property
    def usage_unit(self) -> str: ...
    @property
    def aboard(self) -> tuple[tuple[int, ...], ...]: ...
    @property
    def levels(self) -> tuple[float, ...]: ...
    @property
    def energy_reaches(self) -> Bools: ...
    @property
    def core(self) -> core.Problem: ...
    @property
    def model(self) -> PlanModel: ...

    @property
    def past(self) -> Mapping[str, tuple[Task, ...]] | None: ...

    def amounts(self, of: Callable[[Task], float]) -> Floats: ...

    def end(self, i: int) -> int: ...

    def travel_seconds(self, i: int, places: Sequence[int], to: Sequence[int]) -> Floats: ...

    def holds(self, rule: str) -> bool: ...

    def may(self, i: int, j: int) -> bool: ...

    def action_refusal(self, i: int, j: int) -> str | None: ...

    def actions_refused(self, i: int) -> frozenset[int]: ...

    def no_way_to(self, i: int, j: int) -> str: ...

    def back(self, i: int, end_s: float, j: int) -> float: ...


@dataclass(frozen=True)
class HeldBack:
    """That no plan does a task, by how long it may be between tasks: in words, and the rule that gave the bound."""

    said: str
    word: str


class Exclusions(Protocol):
    """What excluded pairs; see `muster.allocation.bounds.exclusions`."""

    def before(self, word: str, *, robot: int | None = None, task: int | None = None) -> Limits | None: ...


class Limits(Protocol):
    """Lower bounds of usage and times, over all admissible plans; see `muster.allocation.bounds.limits`."""

    @property
    def problem(self) -> Question: ...
    @property
    def rules(self) -> PlanModel: ...
    @property
    def is_timed(self) -> bool: ...
    @property
    def usage(self) -> Floats: ...
    @property
    def usable(self) -> Bools: ...
    @property
    def alone(self) -> Bools: ...
    @property
    def arrival(self) -> Floats: ...
    @property
    def home(self) -> Floats: ...
    @property
    def under_way(self) -> Floats: ...
    @property
    def ready(self) -> Floats: ...
    @property
    def awaited(self) -> tuple[int | None, ...]: ...
    @property
    def pair_begin(self) -> Floats: ...
    @property
    def pair_end(self) -> Floats: ...

    @property
    def over(self) -> Floats: ...
    @property
    def held_back(self) -> dict[int, HeldBack]: ...

    def must_also(self, j: int) -> list[int]: ...

    @property
    def exclusions(self) -> Exclusions: ...


@dataclass(frozen=True)
class Times:
    """When work on a task begins and ends, and when the route is over of a robot that does it, seconds."""

    begin: float
    end: float
    over: float


@dataclass(frozen=True)
class Found:
    """What a plan comes to in which a robot does a task.

    Parameters
    ----------
    problem
        the plan's.
    tasks, usage
        of the robot's route.
    times
        of the task and the robot.
    least
        times before which no admissible plan has them; None: none are known.
    """

    problem: Question
    tasks: int
    usage: float
    times: Times
    least: Times | None = None


@dataclass(frozen=True)
class Tried:
    """Places in routes at which a robot was to do a task, with what these routes come to."""

    problem: Question
    i: int
    j: int
    places: Sequence[tuple[Routes, core.Inspection]]

    @property
    def usage(self) -> float:
        """The least usage of the robot."""
        return min(found.usages[self.i] for _, found in self.places)

    @property
    def stops(self) -> list[tuple[float, float, float]]:
        """When the robot arrives at the task at each place, and work on it begins and ends."""
        return [stop_of(found, self.i, routes[self.i].index(self.j)) for routes, found in self.places]

    @property
    def over(self) -> float:
        """When the robot's route is over at the earliest."""
        return min(route_over(self.problem, found, self.i, routes[self.i]) for routes, found in self.places)


def stop_of(found: core.Inspection, i: int, at: int) -> tuple[float, float, float]:
    """Arrival, begin and end of a stop of inspected routes that have a schedule."""
    stops = found.stops
    assert stops is not None
    _, arrive, begin, end = stops[i][at]
    return arrive, begin, end


def route_over(problem: Question, found: core.Inspection, i: int, route: Sequence[int]) -> float:
    """When robot i is at the end of its route, seconds."""
    return problem.back(i, stop_of(found, i, len(route) - 1)[2], route[-1])


class Change:
    """What has to change for a robot to do a task under one rule: the least. Subclasses are frozen dataclasses."""

    @property
    def plain(self) -> Any:
        """The change as plain data."""
        raise NotImplementedError

    @property
    def short(self) -> str:
        """The change in a few words."""
        raise NotImplementedError

    @property
    def line(self) -> str:
        """The change as a line of its own."""
        return self.short

    def robot(self, robot: Robot) -> Robot:
        """The robot as it would have to be."""
        return robot

    def task(self, task: Task, robot: Robot) -> Task:
        """The task as it would have to be for the robot."""
        return task

    def suitability(self, table: Scores) -> Scores:
        """The suitability table as it would have to be."""
        return table

    def more_robots(self) -> tuple[Robot, ...]:
        """The robots that there would have to be beside those of the mission."""
        return ()

    def other(self, other: Task, task: Task) -> Task:
        """Another task of the mission as it would have to be."""
        return other

    def narrowed(self, found: Found) -> Change | None:
        """What of it a plan needs that was found with it; None: nothing."""
        return self

    @property
    def seconds(self) -> float:
        """How much time the change gives; 0 for what is not about time."""
        return 0.0


class InPlan:
    """Routes, and what one more task in them would do."""

    is_timed: ClassVar[bool] = False

    def __init__(self, problem: Question, routes: Sequence[Sequence[int]]) -> None:
        self.problem = problem
        self.routes = [list(route) for route in routes]
        self.inspection = core.Inspection(problem.core, self.routes)
        self.done = {j for route in routes for j in route}
        self._at = lru_cache(maxsize=1)(self.inspection.cheapest_insertion)

    def insertion(self, i: int, j: int) -> core.Insertion | None:
        """Where in the route of robot i task j adds least usage and nothing deadlocks; None: nowhere."""
        return self._at(i, j)

    def with_task(self, i: int, j: int, at: int) -> list[list[int]]:
        """The routes with task j at a place of the route of robot i, where it fits."""
        return [[*route[:at], j, *route[at:]] if k == i else list(route) for k, route in enumerate(self.routes)]

    def has_no_way(self, i: int) -> bool:
        """Whether the route of robot i itself has a leg without a way."""
        return math.isinf(self.inspection.usages[i])

    def members(self, j: int) -> Sequence[int]:
        """The robots that do a task."""
        return ()

    def kept_out(self, word: str, i: int, j: int) -> str | None:
        """Why robot i cannot do task j at any place of its route, if that is by the rule of this word.

        That is the first rule in the order of rules with which, beside those before it, no place is left. Only where
        times, teams or relations matter.
        """
        return None


@dataclass(frozen=True)
class Outlook:
    """What is known of a robot and a task whatever the plan.

    Parameters
    ----------
    limits
        lower bounds of usage and times.
    least
        the least usage of any route of the robot that holds the task; inf where there is none.
    lost_before
        a prerequisite that can never be done; empty: none is known.
    """

    limits: Limits
    least: float
    lost_before: str = ""


class Rule:
    """One rule. What a rule does not say it leaves as it is here: nothing is refused.

    Parameters
    ----------
    word
        of reasons and of `--ignore`.
    ignorable
        whether it can be ignored.
    about_one
        whether it looks at one robot at a time; else at the teams that it can be in.
    asked
        of primitives (fields of `Parts`) that not every allocator can keep, the word of `capabilities` for those that
        can. Other rules that give the primitive ask for the same.
    for_good
        whether an allocator can keep them that never takes a task out of a route again.
    lifted_late
        whether reasons seek it among all places in a route, one such rule after the other in the order of rules.
    of_a_route, of_the_team
        whether a route keeps or breaks it whatever the others do; and whether it is said of a robot where another one
        of the task's team breaks it.
    kept_by_calls
        whether calls at stations may keep a route from breaking it.
    resource
        what work takes that robots have only so much of by it: the word of a shortfall, and what it is; None: nothing.
    key, no_change
        of its change in the plain data of a remedy, and what stands there where no change is needed; no key: a robot
        is not changed for it, or not by it alone.
    """

    word: ClassVar[str]
    ignorable: ClassVar[bool] = True
    about_one: ClassVar[bool] = True
    asked: ClassVar[Mapping[str, str]] = {}
    for_good: ClassVar[bool] = True
    lifted_late: ClassVar[bool] = False
    of_a_route: ClassVar[bool] = False
    of_the_team: ClassVar[bool] = False
    kept_by_calls: ClassVar[bool] = False
    resource: ClassVar[tuple[str, str] | None] = None
    key: ClassVar[str | None] = None
    no_change: ClassVar[Any] = None

    def asks(self, problem: Question) -> Mapping[str, str | None]:
        """For each word of `asked` the place of a problem that asks for it first; None: none does.

        A rule is asked for what it gave first. Where nothing is said it is a robot or task with a key that it declares.
        """
        return {}

    def compile(self, problem: Question, parts: Parts) -> None:
        """Contribute the primitives that it comes to."""

    def kinds(self, problem: Question) -> Sequence[Hashable] | None:
        """For each robot what `refusal` depends on, beside the task; None: it refuses nobody."""
        return None if type(self).refusal is Rule.refusal else range(len(problem.robots))

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        """Why robot i may not do task j whatever its route; None if it may."""
        return None

    def possible(self, limits: Limits) -> Bools | None:
        """(m, n) the pairs that may be in an admissible plan, by lower bounds of usage and times; None: all."""
        return None

    def blamed(self, limits: Limits, i: int, j: int) -> str:
        """The word of the rule by which it excludes a pair: of the one that gave the bound."""
        return self.word

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        """Why robot i can do task j in no admissible plan; None if it may."""
        return self.refusal(problem, i, j)

    def left_out(self, plan: InPlan, i: int, j: int) -> str | None:
        """Why robot i does not do task j, which a plan leaves out; None if this rule does not keep it from it."""
        refused = self.refusal(plan.problem, i, j)
        return refused or (plan.kept_out(self.word, i, j) if self.lifted_late else None)

    def concerns(self, problem: Question, j: int) -> bool:
        """Whether the rule can keep a robot from task j by what the task itself is."""
        return True

    def broken_at(self, tried: Tried) -> str:
        """How routes with one more task for a robot break it, where they break it least."""
        own = [meter for meter in tried.problem.model.meters if meter.rule == self.word]
        found = [above_room(tried.problem, own, routes) for routes, _ in tried.places]
        if own and found:
            return min(found, key=lambda one: one[0])[1]
        return f"at every place in its route it would break the rule {self.word}"

    def without_limit(self, tasks: tuple[Task, ...]) -> tuple[Task, ...] | None:
        """The tasks with all of it that can leave no place for one; None: with nothing of it, it does not hold."""
        return None

    def without_end(self, robots: tuple[Robot, ...]) -> tuple[Robot, ...] | None:
        """The same of robots."""
        return None

    def late(self, problem: Question, j: int, ready: float, end: float) -> str | None:
        """That task j is too late which is ready, and ends, at these times at the earliest; None: it is not."""
        return None

    def over_late(self, problem: Question, i: int, over: float) -> str | None:
        """That the route of robot i is over too late that is over at this time at the earliest; None: it is not."""
        return None

    def trait(self, robot: Robot) -> str:
        """What a robot has by which the rule lets it do tasks, in words; empty: nothing."""
        return ""

    def begun(self, task: Task, begun: Mapping[str, int]) -> Task:
        """A task without what binds it no more once some, by id, are done or begun by so many robots each."""
        return task

    def never_used(self, mission: Mission, robot: Robot) -> str | None:
        """Why a robot of a mission does nothing, whatever the plan; None if it may do something."""
        return None

    def too_few(self, problem: Question, i: int, tasks: int) -> bool:
        """Whether robot i does not do so few tasks, though it may do more."""
        return False

    def lifted(self, problem: Question, i: int, j: int, done: Collection[int]) -> Change | None:
        """The change with which it keeps robot i from task j no more, beside the tasks that are done.

        Such changes are tried one at a time; less may do (`narrowed`). None: there is none.
        """
        return None

    def unlimited(self, problem: Question, i: int, j: int) -> Change | None:
        """The change with which it limits no times of robot i and task j; less may do. None: it limits none."""
        return None

    def change(self, problem: Question, robot: Robot, task: Task) -> Change | None:
        """The least change with which the rule does not refuse the pair; None if none is needed."""
        return None


def above_room(problem: Question, meters: Sequence[Meter], routes: Routes) -> tuple[float, str]:
    """By how much routes are above the room of robots on meters, in all, and of the first such robot in words."""
    above, said = 0.0, ""
    for meter, (i, route) in product(meters, enumerate(routes)):
        most = float(meter.most[i])
        peak = float(meter.at_start[i] + np.cumsum(meter.change[route]).max(initial=0.0))
        if peak > most:
            above += peak - most
            said = said or f"with it {problem.robots[i].id} would have {peak:g} {meter.name}, and has room for {most:g}"
    return above, said or "at every place in its route it would be broken"


def first_task(problem: Question, key: str, has: Callable[[int], object]) -> str | None:
    """The first task that has something, named with the key; None: there is none."""
    first = next((task.id for j, task in enumerate(problem.tasks) if has(j)), None)
    return None if first is None else f"task {first}: {key}"


def first_robot(problem: Question, key: str, has: Callable[[int], object]) -> str | None:
    """The same of robots."""
    first = next((robot.id for i, robot in enumerate(problem.robots) if has(i)), None)
    return None if first is None else f"robot {first}: {key}"


def listed(names: Collection[str]) -> str:
    """Names in one line."""
    return ", ".join(names)
