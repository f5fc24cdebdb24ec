"""Plans found by a short search, which show that a set of tasks can be done together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from muster.allocation.allocator import Routes, scheduled
from muster.allocation.search import search
from muster.allocation.stop import Progress, Stop
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import Clock
from muster.model.problem import Problem

Judge = Callable[[Mission, Plan, tuple[str, ...]], bool]
"""Whether a plan is admissible, some rules ignored: given by the caller, as this room may not import `verification`."""

_ITERATIONS, _EFFORT = 5000, 800_000  # most steps of a short search; most steps times tasks and robots
_LEAST_S = 1.5e-4  # for each task and robot: what the least search takes, and the judging of its plan
_OTHERS_WEIGHT = 1e-6  # of a task that only shortens ways


def least_seconds(problem: Problem) -> float:
    """How long an attempt takes at least: it cannot be cut short before it has a plan of all robots and tasks."""
    return _LEAST_S * (len(problem.tasks) + len(problem.robots))


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
    others = set(problem.closed(problem.shortcuts().tolist())).difference(tasks)
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
    """A plan of nothing but routes, with calls at stations."""
    if problem.stations:
        by_robot = {route.robot: replace(route, usage=None) for route in scheduled(problem, routes)}
    else:
        by_robot = {
            robot.id: Route(robot.id, tuple(problem.tasks[j].id for j in route))
            for robot, route in zip(problem.robots, routes, strict=True)
        }
    return Plan(routes=tuple(by_robot[robot.id] for robot in problem.mission.robots), ignored=problem.ignored)


def does_all(problem: Problem, routes: Routes, tasks: Sequence[int], judge: Judge) -> bool:
    """Whether routes hold all the tasks and the judge admits them."""
    return not set(tasks).difference(*routes) and judge(problem.mission, bare_plan(problem, routes), problem.ignored)


def can_do(
    problem: Problem, tasks: Sequence[int], judge: Judge, *, time_limit: float | None = None, clock: Clock | None = None
) -> bool:
    """Whether a short search finds an admissible plan that does all the tasks; it may miss one."""
    return does_all(problem, attempt(problem, tasks, time_limit=time_limit, clock=clock), tasks, judge)
