"""Proven optimal plans: first the greatest weight of tasks, then the least objective.

Whether a plan is admissible the judge says, who is given by the caller. Nothing is excluded because the core rejects
it: what the judge rejects is excluded where no calls at stations could make up for it, and so is what a cut proves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.bounds.feasibility import impossible, usable_pairs
from muster.allocation.bounds.of_objective import best_bound, sound_bound
from muster.allocation.exact.costs import real_costs, real_usage
from muster.allocation.exact.partition import few_partings, least_average
from muster.allocation.exact.scale import whole_weights
from muster.allocation.search.witness_plans import Judge, bare_plan
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import Clock, SystemClock
from muster.mission.system.extras import needs_extra
from muster.model.problem import Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import ROUNDING

if TYPE_CHECKING:
    from muster.allocation.exact.goods import Cut
    from muster.allocation.exact.program import Program

_WORKERS = 4
_ROUNDING = 1e-12


@dataclass(frozen=True)
class ExactResult:
    """What was found and what was proven.

    Parameters
    ----------
    routes
        an admissible plan, the best that was found.
    weight
        of the tasks it completes.
    weight_proven
        whether no admissible plan completes more.
    lower_bound
        what no plan of that weight has a lower objective than; None unless the weight is proven.
    optimal
        whether the plan is proven to be the best, up to the rounding of costs, some 1e-9 relative.
    """

    routes: Routes
    weight: float
    weight_proven: bool
    lower_bound: float | None
    optimal: bool


def solve_exactly(
    problem: Problem,
    time_limit: float,
    start: Routes | None = None,
    seed: int = 0,
    clock: Clock | None = None,
    interrupted: Callable[[], bool] = lambda: False,
    *,
    judge: Judge,
) -> ExactResult:
    """Find the best plan of a small mission and prove it, or prove what can be proven in the time.

    Parameters
    ----------
    problem
        up to some 15 tasks and 5 robots.
    time_limit
        seconds.
    start
        routes of an admissible plan to begin with.
    interrupted
        whether to end at once with what is proven until then.
    judge
        whether a plan is admissible, some rules ignored.

    Raises
    ------
    MissingExtraError
        if OR-Tools is not installed.
    ParameterError
        if the start is not admissible, or the priorities have too many digits.
    """
    require_ortools()
    first = start or [list(problem.beginning(i)) for i in range(len(problem.robots))]
    return _Solving(problem, time_limit, first, seed, clock or SystemClock(), interrupted, judge).result()


def require_ortools() -> None:
    """Raise MissingExtraError if OR-Tools is not installed."""
    with needs_extra("exact", "proving a plan optimal"):
        import ortools.sat.python.cp_model  # noqa: F401


class _Solving:
    """The state of one call: the best plan, and what is proven."""

    def __init__(
        self,
        problem: Problem,
        time_limit: float,
        start: Routes,
        seed: int,
        clock: Clock,
        interrupted: Callable[[], bool],
        judge: Judge,
    ) -> None:
        self._problem, self._seed, self._clock, self._interrupted = problem, seed, clock, interrupted
        self._judge = judge
        self._until = clock.now() + time_limit
        self._usable = usable_pairs(problem)
        self._routes = start
        forbidden = any(not problem.allowed[i, j] for i, route in enumerate(start) for j in route)
        if forbidden or not self._is_admissible(start):
            raise ParameterError("start: the plan is not admissible")
        weights = whole_weights([task.priority for task in problem.tasks])
        if weights is None:
            raise ParameterError("priority: too many digits for a proof; expected priorities like 1, 2.5 or 0.01")
        self._weights: Sequence[int] = weights
        self._given: list[Cut] = []
        from muster.allocation.exact.goods import StationCuts, needs_stations

        self._costs = real_costs(problem)
        self._cuts = StationCuts(problem) if needs_stations(problem) else None

    def result(self) -> ExactResult:
        if not self._problem.tasks:
            return ExactResult(self._routes, 0.0, True, 0.0, True)
        proven = self._maximise_weight()
        weight = float(self._problem.value(self._routes)[0])
        if not proven:
            return ExactResult(self._routes, weight, False, None, False)
        bound, slack = self._minimise()
        optimal = self._value() <= (bound + slack) * (1 + _ROUNDING)
        if optimal and self._problem.objective == "lateness":
            optimal = self._minimise_total()
        return ExactResult(self._routes, weight, True, bound, optimal)

    def _minimise_total(self) -> bool:
        """Find the least total cost of plans that are no later; whether it is proven."""
        program = self._program()
        program.minimise_total(self._weight(), self._value())
        least = self._run(program) / program.scale.units
        total = sum(core.Inspection(self._problem.core, self._routes).usages)
        return total <= (least + program.scale.slack) * (1 + _ROUNDING)

    def _maximise_weight(self) -> bool:
        """Find the greatest weight; whether it is proven."""
        hopeless = {self._problem.task_index[task.task] for task in impossible(self._problem)}
        if self._weight() == sum(weight for j, weight in enumerate(self._weights) if j not in hopeless):
            return True
        program = self._program()
        program.maximise_weight()
        most = self._run(program, maximises=True)
        return self._weight() >= most

    def _minimise(self) -> tuple[float, float]:
        """Find the least objective at the plan's weight: a bound of it, and how much of the bound rounding took."""
        if not any(self._routes):
            return 0.0, 0.0
        least, why = 0.0, "no usage is negative"
        if self._weight() == self._most_weight():
            quick = best_bound(self._problem)
            least, why = quick.value, quick.why
        if self._problem.objective == "average" and few_partings(self._problem) and self._alone():
            parting = least_average(self._problem, self._usable, self._weights, self._weight())
            if self._is_admissible(parting.routes):
                self._take_over(parting.routes)
            least, why = max((least, why), (parting.value, "the best parting of the tasks among the robots"))
        if self._value() <= least * (1 + _ROUNDING):
            return sound_bound(least, self._value(), why), 0.0
        bounds, slack = [], 0.0
        for count in self._counts():
            program = self._program()
            program.minimise_value(self._weight(), count, least, self._value())
            bounds.append(self._run(program) / program.per / program.scale.units)
            slack = program.slack
        least, why = max((least, why), (min(bounds), "OR-Tools CP-SAT"))
        return sound_bound(least, self._value(), why), slack

    def _most_weight(self) -> float:
        """The weight of all tasks, of those in whose place others are done the greatest."""
        sets = self._problem.model.alternatives
        own = [[self._weights[j] for j in alike] for alike in sets]
        return sum(self._weights) - sum(sum(weights) - max(weights) for weights in own)

    def _alone(self) -> bool:
        """Whether every task is done by one robot, and none is in a route already."""
        return not self._problem.fixed and not self._problem.model.with_teams

    def _counts(self) -> Sequence[int | None]:
        """How many tasks the plans of the plan's weight may complete, where the objective asks for that."""
        done, n = len(_done(self._routes)), len(self._weights)
        if self._problem.objective != "average":
            return [None]
        if done == n or len(set(self._weights)) == 1:
            return [done]
        return [done, *(count for count in range(1, n) if count != done)]

    def _value(self, routes: Routes | None = None) -> float:
        return self._problem.value(self._routes if routes is None else routes)[1]

    def _weight(self, routes: Routes | None = None) -> int:
        return sum(self._weights[j] for j in _done(self._routes if routes is None else routes))

    def _program(self) -> Program:
        from muster.allocation.exact.program import Program

        program = Program(self._problem, self._usable, self._weights)
        program.hint(self._routes)
        for cut in self._given:
            program.cut(cut)
        return program

    def _run(self, program: Program, *, maximises: bool = False) -> float:
        """Take over the program's best plan, if it is better; returns the bound of its objective, in units.

        A plan of the program that is not admissible gives cuts, or is forbidden, and the program runs again. Where it
        is not proven that no calls at stations make it admissible, nothing beyond its value is proven.
        """
        proven, best = program.unproven, max if maximises else min
        open_ended = [-math.inf if maximises else math.inf]  # what plans may come to of which nothing is proven
        while (left := self._until - self._clock.now()) > 0 and not self._interrupted():
            solved = program.solve(left, self._seed, _WORKERS, interrupted=self._interrupted)
            if solved.routes is None:
                return best(solved.bound, *open_ended)
            proven = min(proven, solved.bound) if maximises else max(proven, solved.bound)
            cuts = self._cuts.of(solved.routes) if self._cuts else []
            self._given += cuts
            for cut in cuts:
                program.cut(cut)
            admitted = self._is_admissible(solved.routes)
            if admitted and self._take_over(solved.routes) and (maximises or not cuts):
                return best(solved.bound, *open_ended)
            if cuts:
                continue
            if admitted or not self._is_excluded(solved.routes):
                open_ended.append(solved.bound)
            self._forbid(program, solved.routes)
        return best(proven, *open_ended)

    def _is_admissible(self, routes: Routes) -> bool:
        """Whether the judge admits routes, with the calls at stations that the core finds for them."""
        return self._judge(self._problem.mission, bare_plan(self._problem, routes), self._problem.ignored)

    def _is_excluded(self, routes: Routes) -> bool:
        """Whether the judge rejects routes that are not admissible, wherever their robots call at stations."""
        if self._cuts is None:
            return True
        pairs = zip(self._problem.robots, routes, strict=True)
        bare = [Route(robot.id, tuple(self._problem.tasks[j].id for j in route)) for robot, route in pairs]
        ignored = tuple(
            dict.fromkeys((*self._problem.ignored, *(rule.word for rule in all_rules() if rule.kept_by_calls)))
        )
        return not self._judge(self._problem.mission, Plan(routes=tuple(bare)), ignored)

    def _forbid(self, program: Program, routes: Routes) -> None:
        """Leave out routes of robots that they alone put above a capacity; without such, the plan."""
        above = [i for i, route in enumerate(routes) if route and self._is_above_capacity(i, route)]
        for i in above:
            program.forbid([route if k == i else [] for k, route in enumerate(routes)], alone=True)
        if not above:
            program.forbid(routes)

    def _is_above_capacity(self, i: int, route: Sequence[int]) -> bool:
        return real_usage(self._costs, i, route) > float(self._problem.capacity[i]) * (1 + ROUNDING)

    def _take_over(self, routes: Routes) -> bool:
        """Keep an admissible plan if it is the best; returns whether the core has a value of it."""
        if core.Inspection(self._problem.core, routes).objective is None:
            return False
        if self._rank(routes) < self._rank(self._routes):
            self._routes = routes
        return True

    def _rank(self, routes: Routes) -> tuple[float, ...]:
        """What is least of the best plan; of plans that are late alike, the one of least total cost is the best."""
        rank = -self._weight(routes), self._value(routes)
        if self._problem.objective != "lateness":
            return rank
        return *rank, sum(core.Inspection(self._problem.core, routes).usages)


def _done(routes: Routes) -> set[int]:
    """The tasks in routes, a team's once."""
    return {j for route in routes for j in route}
