"""Search: ruin and recreate under simulated annealing, from the greedy plan.

Slack induction by string removals (SISR): [christiaens2020]. Beyond it: a task is put back where the team's objective
grows least, the robot that does most included; many ruins begin at that robot, or for `makespan` at the tasks that its
end waits for; places are those that no prerequisite forbids, through all routes; tasks left out are tried again in
every step. After each ruin routes are improved around it by local search ([croes1958], [or1976], [potvin1995]). Where
not all tasks can be done, as in team orienteering ([chao1996]), tasks are given away for others while it is hot.
Several plans are annealed at first, of which the better ones go on.

Where tasks are bound to times, teams or relations, and for `makespan` with prerequisites, the search works on a
schedule that is propagated through the part that a change affects ([pearce2006]), and some steps exchange what two
robots do last ([potvin1995]); a team is chosen at a cut through the schedule, which gives each robot one place, so that
no cycle of waiting can arise.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from itertools import cycle, pairwise
from random import Random

from muster import core
from muster.allocation.algorithms import greedy
from muster.allocation.algorithms.route_exchange import crossed
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.bounds.feasibility import lost_tasks
from muster.allocation.capabilities import ALL
from muster.allocation.search.partition import improve_in_parts, number_of_parts
from muster.allocation.search.ray_cluster import joined
from muster.allocation.search.side_by_side import SideBySide, rank_of
from muster.allocation.search.workers import Threads, Workers
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.system.platforms import usable_processors
from muster.mission.values.ranges import require_counts
from muster.model.problem import Problem

_Search = core.Search | core.ScheduleSearch

# Where tasks are left out: the temperatures, in what a task costs, between which tasks are given away for others, and
# the share of the run that this has; the rest is for the objective.
_TRADING_HOT, _TRADING_COLD = 20.0, 0.1
_TRADING_SHARE = 0.9
_PLANS, _MANY = 4, 5_000  # plans that a run begins with; one where it has so many tasks
# Tasks and robots times steps, between two looks at the clock: some milliseconds.
_BATCH = 400_000
_BATCH_ON_SCHEDULE = 40_000
_BATCH_OF_SLOW_STEPS = 4_000  # teams are chosen, or calls at stations placed


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the search. Temperatures are in ways: the usual way from one task to the next.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    threads: int = 0  # 0: one for each processor under a time limit, else 1
    # That are annealed at first, of which ever fewer go on; 0: 4, or 1 on a schedule and for more than 5,000 tasks
    plans: int = 0
    parts: int = 0  # into which a team is divided that outgrows the search; 0: as many as its size asks for
    ray: str = "none"  # address of the Ray cluster that parts are worked on; none: threads of this process
    # 0: 1 for the objectives `max` and, on a schedule, `makespan`, which few tasks decide; else 5; where greedy leaves
    # tasks out, and until all are in, 20 times what a task costs, so that tasks are given away for others
    hot: float = 0.0
    cold: float = 0.02
    # Tasks that a ruin takes out, on average; 0: 5 for `makespan` on a schedule, 12 where greedy leaves tasks out,
    # else 10
    removed: float = 0.0
    longest_string: int = 0  # of tasks taken out of one route; 0: 12 where greedy leaves tasks out, else 10
    blink: float = 0.01  # how often a place is overlooked
    near: int = 12  # tasks beside which a task is tried, in large teams

    def __post_init__(self) -> None:
        require_counts(0, parts=self.parts)
        if not isinstance(self.ray, str):
            raise ParameterError(f"ray: {self.ray}; expected the address of a Ray cluster, or none")
        if self.ray != "none" and self.threads > 1:
            raise ParameterError(f"threads: {self.threads}, with a Ray cluster; expected one of the two")
        require_counts(0, threads=self.threads, plans=self.plans, longest_string=self.longest_string)
        require_counts(1, near=self.near)
        if not 0 < self.cold <= (self.hot or self.cold) < float("inf"):
            raise ParameterError(f"cold, hot: {self.cold:g}, {self.hot:g}; expected 0 < cold <= hot, or hot 0")
        if self.removed != 0 and not 1 <= self.removed < float("inf"):
            raise ParameterError(f"removed: {self.removed:g}; expected a number of at least 1, or 0")
        if not 0 <= self.blink < 1:
            raise ParameterError(f"blink: {self.blink:g}; expected a number from 0 to below 1")


_SHORT_STEP = Parameters(removed=2.0, longest_string=3, blink=0.2)
_LONG_STEP = Parameters(removed=8.0, blink=0.2)
_ACCEPTING = 2.0  # temperature of a variation, in ways


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Anneal the greedy plan; of a team that outgrows that, one part after the other."""
    parts = 1 if problem.core.is_timed else params.parts or number_of_parts(len(problem.tasks))

    def improve(part: Problem, until: Stop, part_seed: int, routes: Routes) -> Routes:
        return anneal(part, until, part_seed, params if parts == 1 else replace(params, threads=1), routes)

    if parts == 1 and params.ray != "none":
        few = f"a team of {len(problem.tasks)} tasks, which is searched as a whole"
        raise ParameterError(f"ray: {params.ray}, for {few}; expected a larger one, or parts (2 or more)")
    if parts == 1:
        return Outcome(improve(problem, stop, seed, start or [[] for _ in problem.robots]))
    with _workers(params) as workers:
        return Outcome(improve_in_parts(problem, stop, seed, parts, workers, start, improve))


def _workers(params: Parameters) -> AbstractContextManager[Workers]:
    if params.ray == "none":
        return nullcontext(Threads(max(params.threads, usable_processors())))
    return joined(params.ray)


def anneal(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes) -> Routes:
    """From the greedy plan: several plans are annealed side by side, and fewer the colder it is."""
    first = start if problem.core.is_timed else greedy.completed(problem, start)
    stop.improved(*problem.value(first))
    if stop.due() and not problem.core.is_timed:
        return first
    oversubscribed = _is_oversubscribed(problem, first)
    with _side_by_side(problem, stop, seed, params, first, oversubscribed) as searches:
        best, rank = searches.best, None
        cooling = _cooling(problem, params, best)
        trading = _trading(params, best, cooling) if oversubscribed else cooling
        for steps in stop.batches(_steps_at_once(problem)):
            now = trading if best.best_weight_left_out > 0 else cooling
            searches.anneal(steps, now.temperature(stop.share))
            best = searches.best
            if rank_of(best) != rank:
                rank = rank_of(best)
                stop.improved(problem.weight(best.best), best.best_objective)
            searches.go_on(stop.share)
        return best.best


def _side_by_side(
    problem: Problem, stop: Stop, seed: int, params: Parameters, first: Routes, oversubscribed: bool
) -> SideBySide[_Search]:
    threads = params.threads or (usable_processors() if stop.is_a_time_alone else 1)
    random = Random(seed)
    opening = _search(problem, first, seed, params, oversubscribed)

    def search(k: int) -> _Search:
        return _search(problem, opening.best, seed + (k << 32), params, oversubscribed) if k else opening

    def cross(routes: Routes, other: Routes) -> Routes:
        return routes if problem.core.is_timed else crossed(problem, routes, other, random)

    return SideBySide(
        search,
        plans=params.plans or (_PLANS if len(problem.tasks) <= _MANY and not _on_schedule(problem) else 1),
        busy=threads if stop.is_a_time_alone else 1,
        threads=threads,
        cross=cross,
    )


class Variations:
    """Plans that are a step of the search away from others: every third a long step.

    Parameters
    ----------
    problem
        of the plans.
    routes
        of a first plan.
    seed
        of the steps.
    """

    def __init__(self, problem: Problem, routes: Routes, seed: int) -> None:
        steps = (_SHORT_STEP, _LONG_STEP)
        short, long = (_search(problem, routes, seed, params, oversubscribed=False) for params in steps)
        self._searches = cycle((short, short, long))
        self._temperature = _ACCEPTING * (short.mean_way or 1.0)

    def of(self, routes: Routes) -> Routes:
        """Routes a step away from these."""
        search = next(self._searches)
        search.go_on_from(routes)
        search.anneal(1, self._temperature, self._temperature)
        return search.routes


def _steps_at_once(problem: Problem) -> int:
    batch = _BATCH_ON_SCHEDULE if _on_schedule(problem) else _BATCH
    if problem.model.with_teams or problem.model.parts.energy:
        batch = _BATCH_OF_SLOW_STEPS
    return max(20, min(1000, batch // (len(problem.tasks) + len(problem.robots))))


def _on_schedule(problem: Problem) -> bool:
    """Whether the search must know when each task begins."""
    return problem.core.is_timed or (problem.objective == "makespan" and any(problem.prerequisites))


def _is_oversubscribed(problem: Problem, routes: Routes) -> bool:
    """Whether routes leave out tasks that could be done by themselves; of a schedule that is not asked."""
    left_out = len(problem.tasks) - sum(map(len, routes))
    return not _on_schedule(problem) and left_out > 0 and left_out > len(lost_tasks(problem))


@dataclass(frozen=True)
class _Cooling:
    """Temperatures at given shares of a run, in units of so much of the objective; they fall evenly by ratio."""

    unit: float
    points: tuple[tuple[float, float], ...]

    def temperature(self, share: float) -> float:
        (begin, hot), (end, cold) = next(span for span in pairwise(self.points) if share <= span[1][0])
        return self.unit * hot * float((cold / hot) ** ((share - begin) / (end - begin)))


def _cooling(problem: Problem, params: Parameters, search: _Search) -> _Cooling:
    few = problem.objective == "max" or (problem.objective == "makespan" and _on_schedule(problem))
    hot = max(params.cold, params.hot or (1.0 if few else 5.0))
    return _Cooling(search.mean_way or 1.0, ((0.0, hot), (1.0, params.cold)))


def _trading(params: Parameters, search: _Search, usual: _Cooling) -> _Cooling:
    """The cooling where tasks are left out; the usual one if the first temperature is given."""
    cost = search.task_cost if isinstance(search, core.Search) else 0.0
    if params.hot or not cost:
        return usual
    hot, cold = (usual.temperature(share) / cost for share in (0.0, 1.0))
    middle = _TRADING_SHARE, max(cold, _TRADING_COLD)
    return _Cooling(cost, ((0.0, max(hot, _TRADING_HOT)), middle, (1.0, cold)))


def _search(problem: Problem, first: Routes, seed: int, params: Parameters, oversubscribed: bool) -> _Search:
    kind: Callable[..., _Search]
    if _on_schedule(problem):
        removed, kind = 5.0 if problem.objective == "makespan" else 10.0, core.ScheduleSearch
    else:
        removed, kind = 12.0 if oversubscribed else 10.0, partial(core.Search, oversubscribed=oversubscribed)
    return kind(
        problem.core_of_greatest_usage or problem.core,
        first,
        seed % 2**64,
        removed=params.removed or removed,
        longest_string=params.longest_string or (12 if oversubscribed else 10),
        blink=params.blink,
        greatest_share=0.8 if problem.objective in ("max", "makespan") else 0.5,
        near=params.near,
    )


SEARCH = Allocator(
    name="search",
    summary="ruin and recreate under simulated annealing; the best plans",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    keeps_fixed=True,
    can=ALL,
    variations=Variations,
)
