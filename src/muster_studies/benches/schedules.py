"""The search on a schedule: windows with prerequisites, a large mission whose tasks wait, and a lattice of tasks."""

from __future__ import annotations

import time

from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.generation.ordered import ordered_mission
from muster.generation.windows import windows_mission
from muster.mission.system.clock import ProcessorClock
from muster.model.problem import Problem
from muster_studies.benches.measurement import Measurement
from muster_studies.instances.lattice import lattice_mission
from muster_studies.runs import accepted

SECONDS, LATTICE_S = 1.0, 5.0


def schedules(runs: int) -> list[Measurement]:
    """Tasks done within their windows, steps with 2,000 tasks that wait for each other, and the end of a lattice."""
    done = [_done(seed) for seed in range(runs)]
    steps = [_steps_per_second(seed) for seed in range(runs)]
    ends = [_end_of_lattice(seed) for seed in range(runs)]
    return [
        Measurement.over_runs(f"windows with prerequisites, search, {SECONDS:g} s", "% of tasks", done, ""),
        Measurement.over_runs("search, makespan, 2,000 tasks that wait", "steps/s", steps, ">= 5000"),
        Measurement.over_runs(f"search, makespan, lattice of 20 x 20, {LATTICE_S:g} s", "s", ends, "<= 410"),
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


def _end_of_lattice(seed: int) -> float:
    """The end of 400 tasks: together with 15 robots more places than the search once kept the times of."""
    problem = Problem.compile(lattice_mission(20, 20, 15)).ready()
    plan = ALLOCATORS["search"].solve(problem, Stop(time_limit=LATTICE_S, clock=ProcessorClock()), seed=seed)
    verdict = accepted(problem.mission, plan, f"lattice, seed {seed}")
    end = verdict.value("makespan")
    return float("inf") if end is None or verdict.tasks_completed < verdict.tasks_total else end
