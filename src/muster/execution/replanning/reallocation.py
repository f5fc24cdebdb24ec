"""Re-allocation: the remaining tasks are planned again after a change ([tcf-thesis], 7.3; [market-paper], 6).

The plan so far, as far as it still can be, is where the search begins. `rules.stability` bounds how many tasks go from
one robot that could do them to another.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from muster.allocation.algorithms.rewiring import rewired
from muster.allocation.allocator import Allocator, Routes
from muster.allocation.fixed import admissible_part
from muster.allocation.reasons.explanations import unassigned
from muster.allocation.search.search import SEARCH, Parameters
from muster.allocation.stop import Stop
from muster.execution.replanning.remaining_problem import RemainingMission, RemainingProblem, remaining_problem
from muster.execution.replanning.route_ahead import RouteAhead, route_ahead, stops_of
from muster.execution.replanning.travel import Travel
from muster.execution.replanning.worthwhile import robots_of, worthwhile
from muster.execution.robots.station_calls import Call
from muster.mission.errors import ParameterError
from muster.mission.plan import RouteStop, Unassigned, teams_of
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem
from muster.model.rules.team import by_so_many
from muster.state.reasons import in_one_line, reasons_in_one_line

RobotsOf = Mapping[int, frozenset[int]]
"""For each task, by index, the robots that do it."""

REPLANNING: Mapping[str, Any] = MappingProxyType({"hot": 1.0, "plans": 1})
"""How a search goes on from a good plan: not so hot that it is to settle anew which robot goes where."""


@dataclass(frozen=True, kw_only=True)
class Revision:
    """A new plan of the rest, and how it differs.

    Parameters
    ----------
    routes
        for each robot of the crew what it does next, in order, without work under way.
    calls
        for each of those that call at stations on the way their calls.
    ahead
        for each robot what it will use after each task of its route, in the mission's unit, the way to its end
        included; under the empty name after what it is doing.
    moved
        tasks that went from one robot or team to another: from, to. Of them, and of the tasks dropped, those of
        `forced` had to go: a robot of theirs is out, refused, or could not do all that it had.
    added, dropped
        tasks that had no robot and have one now, and the other way round.
    left_out
        every open task that no robot does, and why.
    is_part
        whether it is a plan of some robots alone: the others go on as they did, and tasks left out before stay so.
    """

    routes: Mapping[str, tuple[str, ...]]
    ahead: Mapping[str, Mapping[str, float]]
    moved: Mapping[str, tuple[str, str]]
    forced: frozenset[str]
    added: Mapping[str, str]
    dropped: tuple[str, ...]
    left_out: Mapping[str, str]
    calls: Mapping[str, tuple[Call, ...]] = field(default_factory=dict)
    is_part: bool = False

    def difference(self) -> dict[str, Any]:
        """What has changed, as plain data: robots of tasks moved and added, reasons of tasks dropped."""
        return {
            "moved": {task: list(robots) for task, robots in self.moved.items()},
            "forced": sorted(self.forced),
            "added": dict(self.added),
            "dropped": {task: self.left_out[task] for task in self.dropped},
        }


@dataclass(frozen=True, kw_only=True)
class Reallocation:
    """Plans the rest again for a number of steps: the same rest gives the same plan.

    Parameters
    ----------
    travel
        how travel is measured.
    iterations
        steps of each search; with `rules.stability` there are up to three and one for each time that a robot cannot
        do all that it had.
    seed
        of the search.
    allocator, parameters
        what plans; it must leave work under way where it is (`keeps_fixed`). An anytime allocator goes on from the
        plan so far, and a search begins at a low temperature for that; another one plans all that is left afresh.
    fill_waiting
        whether waiting is made less afterwards, by `rewiring`.
    for_a_gain
        whether a task changes robots only where that is worth it (see `worthwhile`), as in a search in the background.

    Raises
    ------
    ParameterError
        if the allocator would move work that is under way.
    """

    travel: Travel
    iterations: int = 3000
    seed: int = 0
    allocator: Allocator = SEARCH
    parameters: Any = Parameters(**REPLANNING)
    fill_waiting: bool = False
    for_a_gain: bool = False

    def __post_init__(self) -> None:
        if not self.allocator.keeps_fixed:
            raise ParameterError(f"allocator: {self.allocator.name}; expected one that keeps fixed tasks")

    def __call__(self, rest: RemainingMission) -> Revision:
        """The rest planned again.

        Without a crew nothing is done any more.
        """
        if not rest.crew:
            return nobody(rest)
        what, problem, before, forced = rest_to_plan(rest, self.travel)
        start = admissible_part(problem, without_units(problem, before, forced))
        stable = rest.mission.rules.stability
        if stable is None:
            routes = self._searched(problem, start)
        else:
            routes, forced = self._stable(problem, start, _robots_of(problem, before), forced, stable)
        if self.fill_waiting:
            routes = rewired(problem, routes)
        if self.for_a_gain:
            routes = worthwhile(problem, start, routes, rest.headings)
        return revision_of(rest, what, routes, forced)

    def _stable(
        self, problem: Problem, routes: Routes, robots_of: RobotsOf, forced: frozenset[int], most: int
    ) -> tuple[Routes, frozenset[int]]:
        """Routes in which at most so many tasks have another robot or team, beyond those that theirs cannot do."""
        while True:
            routes = self._searched(_locked(problem, robots_of, forced), routes)
            lost = frozenset(robots_of) - forced - {j for route in routes for j in route}
            if not lost:
                break
            forced |= lost
        freely = self._searched(problem, routes) if most else routes
        freely_of = _robots_of(problem, freely)
        moved = [j for j, robots in freely_of.items() if robots_of.get(j, robots) != robots and j not in forced]
        spared = _spared(problem, routes)
        free = forced.union(sorted(moved, key=lambda j: -spared[j])[:most])
        return self._searched(_locked(problem, robots_of, free), routes), forced

    def _searched(self, problem: Problem, start: Routes) -> Routes:
        stop = Stop(iterations=self.iterations, clock=VirtualClock())
        if not self.allocator.anytime:
            start = [list(problem.beginning(i)) for i in range(len(problem.robots))]
        return self.allocator.outcome(problem, stop, self.seed, self.parameters, start).routes


def rest_to_plan(rest: RemainingMission, travel: Travel) -> tuple[RemainingProblem, Problem, Routes, frozenset[int]]:
    """The problem of the rest, that ready to be planned, the routes so far, and the tasks that are torn from these."""
    what = remaining_problem(rest, travel)
    problem = what.problem.ready()
    before = routes_before(problem, rest)
    return what, problem, before, torn(problem, rest, before)


def routes_before(problem: Problem, rest: RemainingMission) -> Routes:
    """The plan so far, of the tasks that the problem has; each route begins with the robot's past."""
    routes: Routes = []
    for i, robot in enumerate(problem.robots):
        still = [problem.task_index[name] for name in rest.routes.get(robot.id, ()) if name in problem.task_index]
        routes.append([*problem.beginning(i), *(j for j in still if problem.may(i, j))])
    return routes


def torn(problem: Problem, rest: RemainingMission, before: Routes) -> frozenset[int]:
    """The tasks that not all robots can do any more that were to do them: one is out, refused, or may not."""
    still = _teams(_named(problem, rest, before))
    changed = (name for name, robots in rest.former.items() if still.get(name) != robots)
    return frozenset(problem.task_index[name] for name in changed if name in problem.task_index)


def _named(problem: Problem, rest: RemainingMission, routes: Routes) -> dict[str, tuple[str, ...]]:
    """For each robot, in the order of the crew, the tasks that it will do, without work under way."""
    index = {snapshot.robot.id: problem.robot_index[snapshot.robot.id] for snapshot in rest.crew}
    return {
        name: tuple(problem.tasks[j].id for j in routes[i][len(problem.beginning(i)) :]) for name, i in index.items()
    }


def _teams(routes: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """For each task the names of its robots, as in `RemainingMission.former`."""
    return {task: ", ".join(team) for task, team in teams_of(routes.items()).items()}


def without_units(problem: Problem, routes: Routes, tasks: Iterable[int]) -> Routes:
    """The routes without some tasks, and without those that begin with them."""
    gone = {other for j in tasks for other in (j, *problem.model.beginning_with(j))}
    return [[j for j in route if j not in gone] for route in routes]


def _robots_of(problem: Problem, routes: Routes) -> RobotsOf:
    """For each task the robots that do it; work under way is left out."""
    return robots_of([route[len(problem.beginning(i)) :] for i, route in enumerate(routes)])


def _locked(problem: Problem, robots_of: RobotsOf, free: frozenset[int]) -> Problem:
    """The problem in which tasks that have a robot or a team keep it, but for some."""
    tasks = list(problem.tasks)
    for j, robots in robots_of.items():
        if j not in free:
            only = tuple(problem.robots[i].id for i in sorted(robots))
            tasks[j] = replace(by_so_many(tasks[j], len(robots)), only_robots=only)
    return replace(problem, tasks=tuple(tasks))


def _spared(problem: Problem, routes: Routes) -> dict[int, float]:
    """For each task in the routes the usage that its robot is spared without it."""
    spared: dict[int, float] = {}
    for i, route in enumerate(routes):
        places = [problem.start(i), *route]
        ends = [problem.end(i)] if problem.robots[i].place_at_end(problem.mission.rules) is not None else []
        legs = problem.legs(i, places, [*route, *ends])
        work = problem.work_usage(i)
        for k, j in enumerate(route):
            after = k + 1 < legs.shape[1]
            spared[j] = spared.get(j, 0.0) + float(
                legs[k, k] + work[j] + (legs[k + 1, k + 1] - legs[k, k + 1] if after else 0.0)
            )
    return spared


def first_ahead(
    rest: RemainingMission, travel: Travel, planned: Mapping[str, Sequence[RouteStop]]
) -> dict[str, RouteAhead]:
    """What lies ahead of each robot by the routes as they are, with the stations of a plan between their tasks."""
    if not rest.crew:
        return {}
    problem = remaining_problem(rest, travel).problem
    routes = routes_before(problem, rest)
    return {
        robot.id: route_ahead(problem, i, _with_stations(problem, i, routes[i], planned.get(robot.id, ())))
        for i, robot in enumerate(problem.robots)
    }


def usage_ahead(rest: RemainingMission, travel: Travel) -> dict[str, dict[str, float]]:
    """What each robot will use after each task of the routes as they are; see `Revision.ahead`."""
    return {robot: one.usage for robot, one in first_ahead(rest, travel, {}).items()}


def _with_stations(problem: Problem, i: int, route: Sequence[int], planned: Sequence[RouteStop]) -> list[RouteStop]:
    """The stops of a route, with the stations that a plan has after those of its tasks that are done.

    The robot calls at none that is not for it.
    """
    left = {problem.tasks[j].id for j in route}
    there = {station.id for k, station in enumerate(problem.stations) if problem.model.may_call(i, k)}
    over = max((k for k, stop in enumerate(planned, 1) if not (stop.is_station or stop.name in left)), default=0)
    ahead = [stop for stop in planned[over:] if stop.name in (there if stop.is_station else left)]
    met = {stop.name for stop in ahead}
    before = [RouteStop(problem.tasks[j].id, 0.0, 0.0, 0.0) for j in route if problem.tasks[j].id not in met]
    return [*before, *ahead]


def revision_of(rest: RemainingMission, what: RemainingProblem, routes: Routes, forced: Collection[int]) -> Revision:
    """Routes as the new plan of the rest."""
    problem = what.problem
    planned = _named(problem, rest, routes)
    now = _teams(planned)
    missing = unassigned(problem, routes)
    found = [route_ahead(problem, i, stops) for i, stops in enumerate(stops_of(problem, routes))]
    ahead = {robot.id: found[i] for i, robot in enumerate(problem.robots)}
    left_out = {item.task: why_left_out(item, rest.refusals.get(item.task, {})) for item in missing}
    left_out |= what.hopeless
    moved = {task: (rest.former[task], robot) for task, robot in now.items() if rest.former.get(task, robot) != robot}
    dropped = tuple(task for task in left_out if task in rest.former)
    had_to_go = {problem.tasks[j].id for j in forced} | what.hopeless.keys()
    return Revision(
        routes=planned,
        ahead={robot: one.usage for robot, one in ahead.items()},
        calls={robot: one.calls for robot, one in ahead.items() if one.calls},
        moved=moved,
        forced=frozenset(had_to_go.intersection((*moved, *dropped))),
        added={task: robot for task, robot in now.items() if task not in rest.former},
        dropped=dropped,
        left_out=left_out,
    )


def nobody(rest: RemainingMission) -> Revision:
    """The plan of a crew in which nobody is left."""
    names = [task.id for task in rest.tasks]
    return Revision(
        routes={},
        ahead={},
        moved={},
        forced=frozenset(),
        added={},
        dropped=tuple(name for name in names if name in rest.former),
        left_out=dict.fromkeys(names, "no robot takes part any more"),
    )


def why_left_out(item: Unassigned, refused: Mapping[str, str]) -> str:
    """Why a task is left out; robots that refused it have a reason of their own, which the plan does not know."""
    others = reasons_in_one_line([reason for reason in item.reasons if reason.robot not in refused])
    return "; ".join(part for part in (in_one_line(refused.items()), others) if part)
