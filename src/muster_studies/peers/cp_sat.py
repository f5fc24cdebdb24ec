"""OR-Tools CP-SAT as an anytime solver: the constraint program of `muster.allocation.exact`, from the greedy plan.

In `exact` the program is for a proof; here it is for a good plan soon: no linear relaxation, short presolving, half the
time tree search and half large neighbourhood search (LNS), as neither is better throughout. Where greedy leaves tasks
out, a tree search for more tasks comes first.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from muster.allocation.algorithms import greedy
from muster.allocation.bounds.feasibility import usable_pairs
from muster.allocation.exact.scale import whole_weights
from muster.model.problem import Problem
from muster.verification import verify
from muster_studies.peers.instance import Instance, Routes
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.processor_time import ProcessorStop

if TYPE_CHECKING:
    from muster.allocation.exact.program import Program

_MOST_TASKS = 80
"""Arcs grow with the square of the tasks, times robots."""
TREE: Mapping[str, Any] = {
    "linearization_level": 0,
    "cp_model_probing_level": 0,
    "symmetry_level": 0,
    "max_presolve_iterations": 1,
}
LNS: Mapping[str, Any] = {**TREE, "interleave_search": True, "use_lns_only": True}


class CpSat:
    """OR-Tools CP-SAT with one worker."""

    name = "CP-SAT"
    distribution = "ortools"
    settings = (
        "OR-Tools' CP-SAT, one circuit a robot, 1 worker, from the plan of greedy, which stands where nothing better "
        "is found; half the time tree search, half LNS, after a tree search for more tasks where greedy leaves some "
        f"out; missions of up to {_MOST_TASKS} tasks"
    )
    random = False
    by_wall_clock = False

    def cannot(self, instance: Instance) -> str | None:
        if len(instance.tasks) > _MOST_TASKS:
            return f"over {_MOST_TASKS} tasks"
        if any(instance.goods.loads):
            return "no goods"
        return None if _weights(instance.problem) else "no priorities of so many digits"

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        run = _Run(instance, seed)
        left = seconds
        if run.count < len(instance.tasks):
            left -= run.complete_more(seconds / 2)
        run.lower_value(max(0.0, left))
        return Answer(run.answer(run.routes), run.claimed, run.build_s)


def _weights(problem: Problem) -> list[int]:
    return whole_weights([task.priority for task in problem.tasks]) or []


class _Run:
    """The best plan so far, with the problem's indices of tasks; and its objective by the program."""

    def __init__(self, instance: Instance, seed: int) -> None:
        try:
            import ortools.sat.python.cp_model  # noqa: F401
        except ImportError:
            raise missing("CP-SAT") from None
        self._instance, self._problem, self._seed = instance, instance.problem, seed
        self._weights = _weights(self._problem)
        self.routes = greedy.completed(self._problem)
        self.claimed: float | None = None
        self.build_s = 0.0

    @property
    def count(self) -> int:
        return sum(map(len, self.routes))

    def complete_more(self, seconds: float) -> float:
        """Maximise the weight of tasks; returns the seconds that it took."""
        begin = time.perf_counter()
        program = self._program()
        program.maximise_weight()
        program.hint(self.routes)
        self.build_s += time.perf_counter() - begin
        return self._search(program, seconds, TREE)

    def lower_value(self, seconds: float) -> None:
        """Minimise the objective at the weight, and number of tasks, that the plan has."""
        begin = time.perf_counter()
        program = self._program()
        weight = sum(self._weights[j] for route in self.routes for j in route)
        program.minimise_value(weight, self.count, None, self._problem.value(self.routes)[1])
        self.build_s += time.perf_counter() - begin
        for parameters in (TREE, LNS):
            program.hint(self.routes)
            program.complete_hint()
            self._search(program, seconds / 2, parameters)
        program.hint(self.routes)
        units = program.complete_hint()
        if units is not None:
            self.claimed = units / program.per / program.scale.units

    def _program(self) -> Program:
        from muster.allocation.exact.program import Program

        return Program(self._problem, usable_pairs(self._problem), self._weights)

    def _search(self, program: Program, seconds: float, parameters: Mapping[str, Any]) -> float:
        """Take over the program's plan if it is better; returns the seconds that it took.

        The program rounds costs down: what is above a capacity in real numbers does not count.
        """
        begin = time.process_time()
        stop = ProcessorStop(seconds)
        routes = program.solve(math.inf, self._seed, 1, parameters, stop.due).routes
        took = time.process_time() - begin
        if routes is not None and self._admissible(routes):
            self.routes = min(self.routes, routes, key=self._rank)
        return took

    def answer(self, routes: Routes) -> Routes:
        """Routes with their tasks counted as the instance's."""
        index = {j: k for k, j in enumerate(self._instance.tasks)}
        return [[index[j] for j in route] for route in routes]

    def _admissible(self, routes: Routes) -> bool:
        problem, plan = self._problem, self._instance.plan(self.answer(routes), CpSat.name)
        return verify(problem.mission, plan, problem.ignored, problem.objective).valid

    def _rank(self, routes: list[list[int]]) -> tuple[float, float]:
        weight, value = self._problem.value(routes)
        return -weight, value
