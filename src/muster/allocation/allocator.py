"""The interface of allocators, and the plan made from the routes of one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import Field, dataclass, fields
from typing import Any, Protocol

from muster import core
from muster.allocation.capabilities import NONE, refuse_what_is_not_kept
from muster.allocation.reasons.explanations import unassigned_of_plan
from muster.allocation.returned_routes import checked_routes
from muster.allocation.stop import Stop
from muster.mission.auction_book import Book
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan, Route, RouteStop
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.model.problem import Problem

Routes = list[list[int]]
_MOST = 1_000_000  # of anything that a parameter counts
MOST = "most"
"""The key of the metadata of a parameter that says how much it may be; without it, a million where it counts."""


@dataclass(frozen=True)
class Outcome:
    """What an algorithm arrives at; an auction has a book."""

    routes: Routes
    book: Book | None = None


class Algorithm(Protocol):
    """The part of an allocator that differs: routes for a problem, from the routes of a start plan if there is one."""

    def __call__(
        self, problem: Problem, stop: Stop, seed: int, params: Any, start: Routes | None
    ) -> Outcome | Sequence[Sequence[int]]: ...


class Variations(Protocol):
    """Plans that differ a little from others."""

    def of(self, routes: Routes) -> Routes: ...


@dataclass(frozen=True, kw_only=True)
class Allocator:
    """An algorithm that turns a problem into a plan.

    `anytime` tells whether it goes on until it is stopped. `parameters` is a frozen, keyword-only dataclass that checks
    itself when made and has the published defaults. `auctions` tells whether its plans have a book; `keeps_fixed`,
    whether it leaves tasks where they are that are to stay; `variations`, where there are any, makes what varies the
    plans of a problem, from first routes and a seed; `can` tells which rules of time, teams and relations it
    keeps (of `capabilities.ALL`).
    """

    name: str
    summary: str
    anytime: bool
    parameters: type[Any]
    algorithm: Algorithm
    auctions: bool = False
    keeps_fixed: bool = False
    variations: Callable[[Problem, Routes, int], Variations] | None = None
    can: frozenset[str] = NONE

    def solve(
        self, problem: Problem, stop: Stop, *, seed: int = 0, params: Any = None, start: Plan | None = None
    ) -> Plan:
        """An admissible plan; the same for the same problem, parameters and seed if `stop` limits no time.

        Raises
        ------
        ParameterError
            if `start` is not an admissible plan of this problem or moves tasks that are to stay, the seed is out of
            range, the problem has tasks that are to stay and the allocator would move them, or it has rules that the
            allocator cannot keep.
        """
        self.require_able(problem, seed)
        outcome = self.outcome(problem, stop, seed, params or self.parameters(), first_routes(problem, start))
        return finished_plan(problem, stop, outcome, allocator=self.name, seed=seed)

    def require_able(self, problem: Problem, seed: int) -> None:
        """Refuse what the allocator cannot do, as `solve` says (ParameterError)."""
        if not (isinstance(seed, int) and 0 <= seed < 2**64):
            raise ParameterError(f"seed: {seed}; expected a whole number from 0 to 2**64 - 1")
        refuse_what_is_not_kept(problem, self.name, self.can)
        if problem.fixed and not self.keeps_fixed:
            raise ParameterError(f"fixed: with {self.name}, which would move tasks; expected search, greedy or auction")

    def outcome(self, problem: Problem, stop: Stop, seed: int, params: Any, start: Routes | None) -> Outcome:
        """What the algorithm arrives at from the routes of `start`; its routes are checked."""
        with nullcontext() if self.anytime else stop.first_plan():
            returned = self.algorithm(problem, stop, seed, params, start)
        if isinstance(returned, Outcome):
            if stop.best is not None:  # an algorithm that ran out of time may not have noted its last plan
                stop.improved(*problem.value(returned.routes))
            return returned
        outcome = Outcome(checked_routes(problem, returned, self.name))
        stop.improved(*problem.value(outcome.routes))
        return outcome


def first_routes(problem: Problem, start: Plan | None) -> Routes | None:
    """The routes to begin with: those of a start plan, else the tasks that are to stay; errors are those of `solve`."""
    beginnings = [list(route) for route in problem.fixed]
    if start is None:
        return beginnings or None
    routes = admissible_routes(problem, start)
    for i, (beginning, route) in enumerate(zip(beginnings, routes, strict=False)):
        if route[: len(beginning)] != beginning:
            fixed = ", ".join(problem.tasks[j].id for j in beginning)
            raise ParameterError(f"start: robot {problem.robots[i].id} does not begin with the fixed tasks {fixed}")
    return routes


def routes_of(problem: Problem, plan: Plan, what: str = "start") -> Routes:
    """A plan's routes as indices of the problem's robots and tasks; `what` it is, for the error.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the problem does not have.
    """
    routes: Routes = [[] for _ in problem.robots]
    stations = {station.id for station in problem.stations}
    for route in plan.routes:
        if route.robot not in problem.robot_index:
            raise ParameterError(f"{what}: robot {route.robot} is not in the mission")
        if routes[problem.robot_index[route.robot]]:
            raise ParameterError(f"{what}: robot {route.robot} has two routes")
        for task in route.tasks:
            if task in stations:
                continue  # which are chosen anew
            if task not in problem.task_index:
                raise ParameterError(f"{what}: task {task} is not in the mission")
            routes[problem.robot_index[route.robot]].append(problem.task_index[task])
    return routes


def admissible_routes(problem: Problem, plan: Plan, what: str = "start") -> Routes:
    """The routes of a plan to begin with; `what` it is, for the error.

    Raises
    ------
    ParameterError
        if they are not admissible.
    """
    routes = routes_of(problem, plan, what)
    try:
        inspection = core.Inspection(problem.core, routes)
    except ValueError as error:
        raise ParameterError(f"{what}: {error}") from None
    forbidden = [
        f"{problem.robots[i].id} may not do {problem.tasks[j].id}"
        for i, route in enumerate(routes)
        for j in route
        if not problem.may(i, j)
    ]
    if forbidden or not inspection.admissible:
        raise ParameterError(f"{what}: {forbidden[0] if forbidden else 'the plan is not admissible'}")
    return routes


def finished_plan(problem: Problem, stop: Stop, outcome: Outcome, *, allocator: str, seed: int) -> Plan:
    """The plan with these routes, its figures, and the reasons for the tasks left out."""
    elapsed = stop.elapsed_s
    lists = [list(route) for route in outcome.routes]
    inspection = core.Inspection(problem.core, lists)
    usages = inspection.usages
    mission = problem.mission
    done = sorted({j for route in lists for j in route})
    by_robot = {route.robot: route for route in _with_times(problem, lists, inspection)}
    return Plan(
        mission=mission.name,
        allocator=allocator,
        seed=seed,
        ignored=problem.ignored,
        objective=problem.objective,
        objective_value=inspection.objective,
        usage_unit=problem.usage_unit,
        total_cost=sum(usages),
        max_usage=max(usages),
        makespan_s=inspection.makespan,
        equality_index=equality_index(usages),
        tasks_completed=len(done),
        tasks_total=problem.model.most_done,
        weight_completed=sum(problem.tasks[j].priority for j in done),
        elapsed_s=elapsed,
        cut_short=stop.cut_short and len(done) < problem.model.most_done,
        routes=tuple(by_robot[robot.id] for robot in mission.robots),
        unassigned=unassigned_of_plan(problem, lists, lambda: stop.overdue),
        history=tuple(stop.history),
        book=outcome.book,
    )


def scheduled(problem: Problem, routes: Routes) -> list[Route]:
    """For each robot of the problem its route, with its usage and the times of the earliest schedule."""
    return _with_times(problem, routes, core.Inspection(problem.core, routes))


def _with_times(problem: Problem, routes: Routes, inspection: core.Inspection) -> list[Route]:
    return [
        Route(robot.id, tuple(stop.name for stop in stops) or tuple(problem.tasks[j].id for j in route), usage, stops)
        for robot, route, usage, stops in zip(
            problem.robots, routes, inspection.usages, _stops(problem, inspection), strict=True
        )
    ]


def _stops(problem: Problem, inspection: core.Inspection) -> list[tuple[RouteStop, ...]]:
    """By robot the times of the earliest schedule; nothing where there is none, which is for the judge to say."""
    stops = inspection.all_stops
    if stops is None:
        return [() for _ in problem.robots]
    return [tuple(_stop(problem, *stop) for stop in row) for row in stops]


def _stop(problem: Problem, place: int, arrive_s: float, begin_s: float, end_s: float, filled: float) -> RouteStop:
    if place < len(problem.tasks):
        return RouteStop(problem.tasks[place].id, arrive_s, begin_s, end_s)
    station = problem.stations[place - len(problem.tasks) - 2 * len(problem.robots)]
    return RouteStop.at_station(station, arrive_s, begin_s, end_s, filled)


def equality_index(usages: Sequence[float]) -> float:
    """1 - Gini over all robots' usages, (3.28) and (3.29); 1 if all are 0."""
    ordered, total, m = sorted(usages), sum(usages), len(usages)
    if total == 0:
        return 1.0
    ranked = sum(rank * usage for rank, usage in enumerate(ordered, 1))
    return 1.0 - (2.0 / m * ranked / total - (m + 1) / m)


def make_parameters(allocator: Allocator, values: dict[str, Any]) -> Any:
    """The allocator's parameters with some values given.

    Raises
    ------
    ParameterError
        for a name that it does not have, or a value out of range.
    """
    known = [f.name for f in fields(allocator.parameters)]
    for name in values:
        if name not in known:
            hint = did_you_mean(name, known) or f"; it has {', '.join(known) or 'none'}"
            raise ParameterError(f"{allocator.name} has no parameter {name}{hint}")
    for f in fields(allocator.parameters):
        _check_kind(f, values.get(f.name, f.default))
    return allocator.parameters(**values)


def _check_kind(of: Field[Any], value: object) -> None:
    name, default = of.name, of.default
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise ParameterError(f"{name}: {shown(value)}; expected true or false")
        return
    if isinstance(default, int | float) and (isinstance(value, bool) or not isinstance(value, int | float)):
        raise ParameterError(f"{name}: {shown(value)}; expected a number")
    if isinstance(default, float) and isinstance(value, int) and abs(value) >= 2**63:
        raise ParameterError(f"{name}: {shown(value)}; expected a number of fewer digits")
    if isinstance(default, int) and not isinstance(value, int):
        raise ParameterError(f"{name}: {value}; expected a whole number")
    most = of.metadata.get(MOST, _MOST)
    if isinstance(default, int) and isinstance(value, int) and value > most:
        raise ParameterError(f"{name}: {value}; expected at most {most}")
