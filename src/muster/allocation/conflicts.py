"""Tasks that can each be done, but not all of them in one plan: which, and what proves it.

That no admissible plan does a set of tasks is proven by lower bounds on usage: for few tasks each robot's least usage
for every subset (Held and Karp, A Dynamic Programming Approach to Sequencing Problems, J. SIAM 10(1), 1962) and all
ways to share them out; for many a spanning forest from the starts of the robots that can do them. Neither sees that
robots may wait for each other in a circle: where that alone forbids a plan, nothing is proven. That a set of tasks can
be done is shown by a plan that was found and judged.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from muster.allocation import search
from muster.allocation.allocator import Routes
from muster.allocation.feasibility import impossible, least_usage
from muster.allocation.problem import Bools, Floats, Problem
from muster.allocation.stop import Progress, Stop
from muster.mission.clock import Clock, SystemClock
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route

Judge = Callable[[Mission, Plan], bool]
"""Whether a plan is admissible: `verification` says so, which allocators may not ask themselves."""

FEW = 10  # tasks, up to which all subsets are looked at
_ROUNDING = 2e-9  # relative; a little more than the judge allows
_ITERATIONS, _EFFORT = 5000, 800_000  # most steps of a short search; most steps times tasks and robots
_MOST_IN_FOREST, _MOST_SHORTCUTS = 1500, 300  # tasks; beyond, the bound is not worth its time
_MOST_KINDS = 6  # of tasks by who can do them, up to which two kinds are looked at together
_LEFT_OUT_TRIED = 5
_BEFORE_PROOFS = 1  # seed of the last search before proofs are tried
_OTHERS_WEIGHT = 1e-6  # of a task that only shortens ways


@dataclass(frozen=True, kw_only=True)
class Conflict:
    """Tasks of which no admissible plan does all, as bounds prove; all but one of them can be done.

    `prerequisites` are the further tasks that must come before them. `robots` are those that can do any of these tasks.
    `minimal` tells whether for each task a plan of all the others was found; else the conflict may have a smaller one
    in it.
    """

    tasks: tuple[str, ...]
    prerequisites: tuple[str, ...]
    robots: tuple[str, ...]
    detail: str
    minimal: bool
    proven: bool = True


@dataclass(frozen=True)
class Together:
    """Whether one plan can do all tasks that are possible by themselves: it can if there is neither conflict nor doubt.

    `unknown` tells that no plan of them all was found, and none was proven impossible.
    """

    conflict: Conflict | None = None
    unknown: bool = False


def together(problem: Problem, judge: Judge, *, time_limit: float = 2.0, clock: Clock | None = None) -> Together:
    """Look for a plan of all tasks, and where there seems to be none for a minimal conflict."""
    clock = clock or SystemClock()
    begin = clock.now()

    def left() -> float:
        return max(0.0, begin + time_limit - clock.now())

    lost = {item.task for item in impossible(problem)}
    tasks = [j for j, task in enumerate(problem.tasks) if task.id not in lost]
    for seed in itertools.count():
        share = left() if seed > _BEFORE_PROOFS else left() / 3
        routes = attempt(problem, tasks, seed=seed, time_limit=share, clock=clock)
        if _complete(problem, routes, tasks, judge):
            return Together()
        if seed == _BEFORE_PROOFS:
            bounds = UsageBounds(problem)
            candidates = _candidates(bounds, tasks, set(tasks).difference(*routes))
            for robots, own in itertools.takewhile(lambda _: left() > 0.0, candidates):
                if bounds.exceed(robots, own):
                    return Together(_minimal(bounds, own, judge, left, clock))
        if left() == 0.0:
            break
    return Together(unknown=True)


def _candidates(
    bounds: UsageBounds, tasks: Sequence[int], missing: Iterable[int]
) -> Iterator[tuple[list[int], list[int]]]:
    """Tasks that may conflict and all robots that can do any: few robots' own, then few around each task left out."""
    yield from bounds.groups(tasks)
    hardest = sorted(tasks, key=lambda j: -bounds.hardness[j])
    for j in sorted(missing, key=lambda j: -bounds.hardness[j])[:_LEFT_OUT_TRIED]:
        mates = bounds.possible[:, j]
        rivals = sorted(hardest, key=lambda k: bool((bounds.possible[:, k] & ~mates).any()))
        for order in (rivals, hardest):
            few = {j}
            for k in order:
                if len(closed(bounds.problem, {*few, k})) <= FEW:
                    few.add(k)
            yield from bounds.groups(closed(bounds.problem, few))


def _minimal(bounds: UsageBounds, tasks: list[int], judge: Judge, left: Callable[[], float], clock: Clock) -> Conflict:
    """Take tasks out of a proven conflict, the easiest first, while the rest is one; then try to do all but one."""
    problem, core = bounds.problem, list(tasks)
    for j in sorted(tasks, key=lambda j: float(bounds.hardness[j])):
        fewer = [k for k in core if k != j]
        if left() > 0.0 and bounds.forbid(fewer):
            core = fewer
    minimal = all(
        plan_of(problem, closed(problem, [k for k in core if k != j]), judge, time_limit=left(), clock=clock)
        for j in core
    )
    needed = closed(problem, core)
    robots = np.flatnonzero(bounds.possible[:, needed].any(axis=1)).tolist()
    return Conflict(
        tasks=_in_mission_order(problem.mission.tasks, [problem.tasks[j].id for j in core]),
        prerequisites=_in_mission_order(problem.mission.tasks, [problem.tasks[j].id for j in needed if j not in core]),
        robots=_in_mission_order(problem.mission.robots, [problem.robots[i].id for i in robots]),
        detail=_detail(bounds, robots, needed),
        minimal=minimal,
    )


def _in_mission_order(items: Sequence[Robot] | Sequence[Task], names: Sequence[str]) -> tuple[str, ...]:
    chosen = set(names)
    return tuple(item.id for item in items if item.id in chosen)


def _detail(bounds: UsageBounds, robots: list[int], tasks: list[int]) -> str:
    problem, unit = bounds.problem, bounds.problem.usage_unit
    names = ", ".join(_in_mission_order(problem.mission.robots, [problem.robots[i].id for i in robots]))
    capacity = float(problem.capacity[robots].sum())
    least = bounds.least_together(robots, tasks)
    if len(robots) == 1 and len(tasks) <= FEW:
        least = float(bounds.least_usages(robots[0], tasks)[-1])
    if least > capacity * (1 + _ROUNDING):
        who = f"only {names} can do them, and would use" if len(robots) == 1 else f"together {names} would use"
        digits = next((d for d in (2, 4, 6) if f"{least:.{d}f}" != f"{capacity:.{d}f}"), 9)
        return f"{who} at least {least:.{digits}f} {unit}, of {capacity:.{digits}f} {unit}"
    return f"however {names} share them out, one of the robots would need more than its capacity"


# --- plans that are found --------------------------------------------------------------------------------------------


def closed(problem: Problem, tasks: Iterable[int]) -> list[int]:
    """Tasks with all that must come before them, in order."""
    needed = set(tasks)
    waiting = list(needed)
    while waiting:
        new = set(problem.prerequisites[waiting.pop()]) - needed
        needed |= new
        waiting += new
    return sorted(needed)


def attempt(
    problem: Problem,
    tasks: Sequence[int],
    *,
    seed: int = 0,
    time_limit: float | None = None,
    clock: Clock | None = None,
    start: Routes | None = None,
) -> Routes:
    """Routes that do as many of the tasks, which are closed under prerequisites, as a short search finds.

    Each next seed searches twice as long; all searches end as soon as all tasks are done. Where a way through another
    task can be the shorter one, and a plan without others was not found, others may be in the routes.
    """
    routes = _searched(problem, tasks, (), seed, time_limit, clock, start)
    others = set(closed(problem, problem.shortcuts().tolist())).difference(tasks)
    if others and set(tasks).difference(*routes):
        routes = _searched(problem, tasks, others, seed, time_limit, clock, start)
    return routes


def _searched(
    problem: Problem,
    tasks: Sequence[int],
    others: Iterable[int],
    seed: int,
    time_limit: float | None,
    clock: Clock | None,
    start: Routes | None,
) -> Routes:
    chosen = sorted({*tasks, *others})
    index = {j: k for k, j in enumerate(chosen)}
    wanted = set(tasks)
    weights = [(problem.tasks[j], 1.0 if j in wanted else _OTHERS_WEIGHT) for j in chosen]
    weighed = [task if task.priority == weight else replace(task, priority=weight) for task, weight in weights]
    part = replace(problem, objective="total", tasks=tuple(weighed))

    def end_when_done(now: Progress) -> None:
        if now.weight > len(tasks) - 0.5:
            stop.interrupt()

    steps = min(_ITERATIONS, _EFFORT // (len(chosen) + len(problem.robots))) << min(seed, 20)
    stop = Stop(iterations=steps, time_limit=time_limit, clock=clock, on_progress=end_when_done)
    first = None if start is None else [[index[j] for j in route] for route in start]
    found = search.allocate(part, stop, seed, search.Parameters(), first).routes
    return [[chosen[k] for k in route] for route in found]


def bare_plan(problem: Problem, routes: Routes) -> Plan:
    """A plan of nothing but routes."""
    by_robot = {
        robot.id: Route(robot.id, tuple(problem.tasks[j].id for j in route))
        for robot, route in zip(problem.robots, routes, strict=True)
    }
    return Plan(routes=tuple(by_robot[robot.id] for robot in problem.mission.robots), ignored=problem.ignored)


def plan_of(
    problem: Problem, tasks: Sequence[int], judge: Judge, *, time_limit: float | None = None, clock: Clock | None = None
) -> Routes | None:
    """Routes of an admissible plan that does all the tasks, if a short search finds one and the judge admits it."""
    routes = attempt(problem, tasks, time_limit=time_limit, clock=clock)
    return routes if _complete(problem, routes, tasks, judge) else None


def _complete(problem: Problem, routes: Routes, tasks: Sequence[int], judge: Judge) -> bool:
    return not set(tasks).difference(*routes) and judge(problem.mission, bare_plan(problem, routes))


# --- bounds ----------------------------------------------------------------------------------------------------------


class UsageBounds:
    """Lower bounds on usage, over all admissible plans of a problem, whatever else is in them."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def least(self) -> Floats:
        """(m, n) least usage of any route of a robot that holds a task."""
        return np.array([least_usage(self.problem, i) for i in range(len(self.problem.robots))])

    @cached_property
    def possible(self) -> Bools:
        """(m, n) whether a robot can do a task, were it alone."""
        within = self.least <= self.problem.capacity[:, None] * (1 + _ROUNDING)
        return np.asarray(self.problem.allowed & np.isfinite(self.least) & within)

    @cached_property
    def hardness(self) -> Floats:
        """(n,) least usage of any robot that can do a task; inf where none can."""
        return np.asarray(np.where(self.possible, self.least, math.inf).min(axis=0))

    def groups(self, tasks: Sequence[int]) -> Iterator[tuple[list[int], list[int]]]:
        """Groups of robots, the smallest first, each with those of the tasks that no other robot can do."""
        kinds = {frozenset(np.flatnonzero(self.possible[:, j]).tolist()) for j in tasks}
        everyone = frozenset[int]().union(*kinds)
        unions = {a | b for a, b in itertools.combinations(kinds, 2)} if len(kinds) <= _MOST_KINDS else set()
        chosen = {everyone} if len(tasks) <= FEW else {*kinds, *unions, everyone}
        for group in sorted(chosen, key=lambda group: (len(group), sorted(group))):
            others = [i for i in range(len(self.problem.robots)) if i not in group]
            open_to_others = self.possible[others][:, tasks].any(axis=0)
            yield sorted(group), np.asarray(tasks, np.int64)[~open_to_others].tolist()

    def forbid(self, tasks: Iterable[int]) -> bool:
        """Whether it is proven that no admissible plan does all these tasks."""
        return any(self.exceed(robots, own) for robots, own in self.groups(closed(self.problem, tasks)))

    def exceed(self, robots: list[int], tasks: list[int]) -> bool:
        """Whether it is proven that robots cannot do all the tasks, which no other robot does."""
        if len(tasks) <= FEW:
            return (1 << len(tasks)) - 1 not in self.shares(robots, tasks)
        capacity = float(self.problem.capacity[robots].sum())
        return math.isfinite(capacity) and self.least_together(robots, tasks) > capacity * (1 + _ROUNDING)

    def shares(self, robots: Iterable[int], tasks: Sequence[int]) -> list[int]:
        """The largest sets of few tasks, as bits, that robots may be able to do between them."""
        everything, reached, known = (1 << len(tasks)) - 1, [0], dict[bytes, list[int]]()
        for i in robots:
            if everything in reached:
                break
            ways, capacity = self._ways_of(i, tasks), self.problem.capacity[i] * (1 + _ROUNDING)
            key = b"".join((ways.tobytes(), self.problem.work_usage(i)[list(tasks)].tobytes(), capacity.tobytes()))
            if key not in known:
                known[key] = _largest(np.flatnonzero(self.least_usages(i, tasks) <= capacity).tolist())
            reached = _largest(before | share for before in reached for share in known[key])
        return reached

    def least_usages(self, i: int, tasks: Sequence[int]) -> Floats:
        """(2**k,) least usage of robot i for each set of k tasks, bit by bit; inf where it may not do one of them.

        Tasks of one route keep the order of prerequisites; nothing is waited for.
        """
        count, ways = len(tasks), self._ways_of(i, tasks)
        work = self.problem.work_usage(i)[list(tasks)]
        after = _followers(self.problem, tasks)
        usage = np.full((1 << count, count), math.inf)  # by tasks done and the last of them
        for k in range(count):
            usage[1 << k, k] = ways[0, k + 1] + work[k]
        for done in range(1, 1 << count):
            onward = (usage[done][:, None] + ways[1:-1, 1:-1]).min(axis=0) + work
            for k in range(count):
                if not done >> k & 1 and not done & after[k]:
                    usage[done | 1 << k, k] = onward[k]
        least = np.asarray((usage + ways[1:-1, -1]).min(axis=1, initial=math.inf))
        least[0] = 0.0
        return least

    def _ways_of(self, i: int, tasks: Sequence[int]) -> Floats:
        """(k + 2, k + 2) least travel of robot i between its start, k tasks and its end."""
        problem = self.problem
        places = [problem.start(i), *tasks, problem.end(i)]
        ways = _least_ways(problem, i, places)
        ways[:, [k for k, j in enumerate(tasks, 1) if not problem.allowed[i, j]]] = math.inf
        if problem.robots[i].place_at_end(problem.mission.rules) is None:
            ways[:, -1] = 0.0
        return ways

    def least_together(self, robots: Sequence[int], tasks: Sequence[int]) -> float:
        """What robots use at least, together, to do tasks that no other robot does.

        The least work of each task, and the least forest that joins all of them to the robots' starts: routes are one.
        """
        if self._near is None or not len(tasks):
            return 0.0
        root, near = self._from_start[robots][:, tasks].min(axis=0), self._near[np.ix_(tasks, tasks)]
        allowed = self.problem.allowed[np.ix_(robots, tasks)]
        work = np.array([self.problem.work_usage(i)[list(tasks)] for i in robots])
        return _forest(root, near) + float(np.where(allowed, work, math.inf).min(axis=0).sum())

    @cached_property
    def _near(self) -> Floats | None:
        """(n, n) the shorter of the two ways between tasks, for the best robot; None where there are many tasks."""
        problem, count = self.problem, len(self.problem.tasks)
        if count > _MOST_IN_FOREST or len(problem.shortcuts()) > _MOST_SHORTCUTS:
            return None
        near, known = np.full((count, count), math.inf), set[object]()
        for i, robot in enumerate(problem.robots):
            speed = robot.speed_mps if problem.in_time else 1.0
            kind = speed, len(problem.travel[0]) and robot.type, problem.allowed[i, problem.shortcuts()].tobytes()
            if kind not in known:
                known.add(kind)
                near = np.minimum(near, _least_ways(problem, i, range(count)))
        return np.asarray(np.minimum(near, near.T))

    @cached_property
    def _from_start(self) -> Floats:
        """(m, n) least travel from each robot's start to each task."""
        problem, count = self.problem, len(self.problem.tasks)
        if not len(problem.shortcuts()):
            return np.array([problem.legs(i, [problem.start(i)], range(count))[0] for i in range(len(problem.robots))])
        places = [[problem.start(i), *range(count)] for i in range(len(problem.robots))]
        return np.array([_least_ways(problem, i, listed)[0, 1:] for i, listed in enumerate(places)])


def _least_ways(problem: Problem, i: int, places: Sequence[int]) -> Floats:
    """(p, p) least travel of robot i between places, ways through other tasks included with the work there."""
    through = [int(j) for j in problem.shortcuts() if problem.allowed[i, j]]
    nodes = [*places, *through]
    ways = problem.legs(i, nodes, nodes)
    work = problem.work_usage(i)
    for at, j in enumerate(through, len(places)):
        ways = np.minimum(ways, ways[:, at, None] + work[j] + ways[None, at])
    return ways[: len(places), : len(places)].copy()


def _followers(problem: Problem, tasks: Sequence[int]) -> list[int]:
    """For each of few tasks those that must come after it, as bits."""
    before = [set(closed(problem, [j])) for j in tasks]
    return [sum(1 << k for k in range(len(tasks)) if tasks[k] != j and j in before[k]) for j in tasks]


def _largest(sets: Iterable[int]) -> list[int]:
    """The sets, as bits, that are in no other."""
    kept: list[int] = []
    for one in sorted(set(sets), key=int.bit_count, reverse=True):
        if all(one & ~other for other in kept):
            kept.append(one)
    return kept


def _forest(root: Floats, near: Floats) -> float:
    """Weight of the least forest over all nodes whose trees hang on roots (Prim)."""
    reach, total = root.copy(), 0.0
    outside = np.ones(len(root), dtype=np.bool_)
    for _ in range(len(root)):
        node = int(np.where(outside, reach, math.inf).argmin())
        total += float(reach[node])
        outside[node] = False
        reach = np.minimum(reach, near[node])
    return total
