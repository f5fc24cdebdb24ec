"""The search on a schedule: windows with prerequisites, and a large mission whose tasks wait for each other."""

from __future__ import annotations

import time
from random import Random

from muster.allocation.problem import Problem
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.mission.model import Mission, Robot, Rules, Task
from muster_studies.benches.measurement import Measurement

SECONDS = 1.0
_SIDE_M = 100.0


def windows_mission(seed: int) -> Mission:
    """3 to 10 robots, 9 to 60 tasks with work of 20 to 40 s and one time window each, a tenth of the pairs ordered."""
    draw = Random(seed)
    robots = tuple(Robot(id=f"r{k}", position=_place(draw)) for k in range(draw.randint(3, 10)))
    tasks = []
    for k in range(draw.randint(9, 60)):
        opens = draw.uniform(0, 400)
        before = tuple(f"t{j}" for j in range(k) if draw.random() < 0.1)
        window = ((opens, opens + draw.uniform(30, 1600)),)
        tasks.append(
            Task(
                id=f"t{k}",
                position=_place(draw),
                duration_s=draw.uniform(20, 40),
                window_s=window,
                prerequisites=before,
            )
        )
    return Mission(name=f"windows-{seed}", rules=Rules(objective="makespan"), robots=robots, tasks=tuple(tasks))


def ordered_mission(tasks: int, robots: int, seed: int) -> Mission:
    """Tasks that each wait for up to two of the hundred before them."""
    draw = Random(seed)
    team = tuple(Robot(id=f"r{k}", position=_place(draw)) for k in range(robots))
    work = tuple(
        Task(
            id=f"t{k}",
            position=_place(draw),
            actuation_cost=draw.choice((0.0, 2.0, 8.0, 20.0)),
            prerequisites=tuple(f"t{j}" for j in draw.sample(range(max(0, k - 100), k), min(k, draw.randint(0, 2)))),
        )
        for k in range(tasks)
    )
    return Mission(name=f"ordered-{tasks}", rules=Rules(objective="makespan"), robots=team, tasks=work)


def _place(draw: Random) -> tuple[float, float, float]:
    return draw.uniform(0, _SIDE_M), draw.uniform(0, _SIDE_M), 0.0


def schedules(runs: int) -> list[Measurement]:
    """Tasks done within their windows, and steps of the search with 2,000 tasks that wait for each other."""
    done = [_done(seed) for seed in range(runs)]
    steps = [_steps_per_second(seed) for seed in range(runs)]
    return [
        Measurement.over_runs(f"windows with prerequisites, search, {SECONDS:g} s", "% of tasks", done, ""),
        Measurement.over_runs("search, makespan, 2,000 tasks that wait", "steps/s", steps, ">= 5000"),
    ]


def _done(seed: int) -> float:
    problem = Problem.compile(windows_mission(seed)).ready()
    plan = ALLOCATORS["search"].solve(problem, Stop(time_limit=SECONDS), seed=seed)
    return 100.0 * len({task for route in plan.routes for task in route.tasks}) / len(problem.tasks)


def _steps_per_second(seed: int) -> float:
    problem = Problem.compile(ordered_mission(2000, 20, seed)).ready()
    steps, began_s = 1000, time.process_time()
    ALLOCATORS["search"].solve(problem, Stop(iterations=steps), seed=seed)
    return steps / (time.process_time() - began_s)
