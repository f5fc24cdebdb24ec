"""The search on a schedule: windows with prerequisites, and a large mission whose tasks wait for each other."""

from __future__ import annotations

import time

from muster.allocation.problem import Problem
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster_studies.benches.measurement import Measurement
from muster_studies.instances.waiting import ordered_mission, windows_mission

SECONDS = 1.0


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
    steps, began_s = 10_000, time.process_time()
    ALLOCATORS["search"].solve(problem, Stop(iterations=steps), seed=seed)
    return steps / (time.process_time() - began_s)
