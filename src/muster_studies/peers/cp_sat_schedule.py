"""OR-Tools CP-SAT on the end of missions with prerequisites, up to hundreds of tasks, from the plan of greedy.

Tree search, which is good for few tasks, then large neighbourhood search (LNS), which is for many.
"""

from __future__ import annotations

import math
import time

from muster.allocation.algorithms import greedy
from muster_studies.peers.cp_sat import LNS, TREE
from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.processor_time import ProcessorStop

_ROOM = 1 + 1e-5
"""Rounded up, a plan takes longer by less."""
_TREE_SHARE = 1 / 3


class CpSatSchedule:
    """OR-Tools CP-SAT with one worker, on a program with arcs for all robots together."""

    name = "CP-SAT, one circuit"
    distribution = "ortools"
    settings = (
        "OR-Tools' CP-SAT, one circuit of all robots with arcs from each task to the 30 nearest, an interval for each "
        "task and robot, 1 worker, from the plan of greedy; a third of the time tree search, then LNS"
    )
    random = False
    by_wall_clock = False

    def cannot(self, instance: Instance) -> str | None:
        rule = instance.unusual_rule
        if rule is not None:
            return f"no {rule}"
        if instance.objective != "makespan":
            return f"no objective {instance.objective}"
        if any(instance.goods.loads):
            return "no goods"
        return "no tasks left out" if instance.optional else None

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        begin = time.perf_counter()
        try:
            from muster_studies.peers.schedule_program import ScheduleProgram
        except ImportError:
            raise missing(self.name) from None
        index = {j: k for k, j in enumerate(instance.tasks)}
        routes = greedy.completed(instance.problem)
        plan = [[index[j] for j in route] for route in routes]
        latest = math.ceil(instance.problem.value(routes)[1] * instance.seconds.scale * _ROOM)
        program = ScheduleProgram(instance, plan, latest)
        build_s = time.perf_counter() - begin
        for parameters, share in ((TREE, _TREE_SHARE), (LNS, 1 - _TREE_SHARE)):
            program.improve(seed, parameters, ProcessorStop(seconds * share).due)
        return Answer(program.plan, None, build_s)
