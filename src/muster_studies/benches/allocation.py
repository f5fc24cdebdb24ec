"""Speed of allocators: part of `muster bench`."""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

from muster.allocation.algorithms.genetic import Parameters, evolve, first_population
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.generation.uniform import large_mission
from muster.model.problem import Problem
from muster.planning.judging import verify
from muster.planning.loading import load
from muster_studies.benches.measurement import Measurement


def greedy_small(runs: int) -> list[Measurement]:
    """Greedy on eil51 with 5 salesmen, the problem compiled before."""
    milliseconds = []
    problem = Problem.compile(load("eil51-5-thesis")).ready()
    for _ in range(runs):
        begin = time.perf_counter()
        plan = ALLOCATORS["greedy"].solve(problem, Stop())
        milliseconds.append(1000 * (time.perf_counter() - begin))
    value = verify(problem.mission, plan).value("total+max")
    return [Measurement.over_runs("greedy, eil51-5-thesis, in process", "ms", milliseconds, "< 10", f"F = {value:.2f}")]


def genetic_iterations(runs: int) -> list[Measurement]:
    """Iterations of GenTA with a population of 10 per second of CPU, and the share of each step."""
    found = []
    for name, aim in (("eil51-5", ">= 20000"), ("eil51-5-thesis", "")):
        problem = Problem.compile(load(name)).ready()
        params = Parameters()
        rates = []
        for seed in range(runs):
            population = first_population(problem, seed, params, None)
            begin = time.process_time()
            evolve(population, Stop(iterations=20_000), params)
            rates.append(20_000 / (time.process_time() - begin))
        found.append(
            Measurement.over_runs(f"genetic, {name}", "iterations / CPU s", rates, aim, _shares(problem, params))
        )
    return found


class _Timed:
    """A population that measures the time in each of its verbs."""

    def __init__(self, population: Any) -> None:
        self._population = population
        self.seconds: dict[str, float] = {}

    def __getattr__(self, name: str) -> Callable[..., Any]:
        verb = getattr(self._population, name)

        def timed(*arguments: Any) -> Any:
            begin = time.perf_counter()
            result = verb(*arguments)
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - begin
            return result

        return timed


def _shares(problem: Problem, params: Parameters) -> str:
    timed: Any = _Timed(first_population(problem, 0, params, None))
    begin = time.perf_counter()
    evolve(timed, Stop(iterations=20_000), params)
    whole = time.perf_counter() - begin
    steps = {name: timed.seconds[name] / whole for name in ("replace_worst", "mutate", "cross")}
    steps["loop in Python"] = 1.0 - sum(steps.values())
    return ", ".join(f"{name} {100 * share:.0f} %" for name, share in steps.items())


def greedy_large(runs: int) -> list[Measurement]:
    """Greedy on 10,000 tasks and 200 robots."""
    return _large("greedy", 10_000, 200, min(runs, 3), "< 5", "< 500")


def auction_large(runs: int) -> list[Measurement]:
    """The auction with insertion, total+max bids and lowest bid."""
    return [
        *_large("auction", 1_000, 100, runs, "< 1", "< 1000"),
        *_large("auction", 10_000, 200, min(runs, 3), "< 60", "< 1000"),
    ]


def _large(allocator: str, tasks: int, robots: int, runs: int, seconds: str, megabytes: str) -> list[Measurement]:
    """Each run in a process of its own, so that its peak memory can be measured."""
    code = f"from {__name__} import large_once; print(*large_once({allocator!r}, {tasks}, {robots}))"
    found = []
    for _ in range(runs):
        words = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
        found.append([float(word) for word in words])
    name = f"{allocator}, {tasks:,} tasks x {robots} robots"
    return [
        Measurement.over_runs(name, "s", [run[0] for run in found], seconds, f"F = {found[0][2]:.2f}"),
        Measurement.over_runs(f"{name}, peak memory", "MB", [run[1] for run in found], megabytes, "the whole process"),
    ]


def large_once(allocator: str, tasks: int, robots: int) -> tuple[float, float, float]:
    """Seconds, peak memory in MB and F of one run."""
    problem = Problem.compile(large_mission(tasks, robots)).ready()
    begin = time.perf_counter()
    plan = ALLOCATORS[allocator].solve(problem, Stop())
    seconds = time.perf_counter() - begin
    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    value = verify(problem.mission, plan).value("total+max")
    assert value is not None
    return seconds, megabytes, value
