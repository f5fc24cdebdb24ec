"""One run of one solver on one mission, judged; and the runs of all solvers on all missions."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from statistics import fmean

from muster.allocation.registry import allocator_named
from muster.allocation.stop import Stop
from muster.generation.clustered import Clustered, clustered_mission
from muster.generation.customers import customers_mission
from muster.generation.precedence import precedence_mission
from muster.generation.teams import counted_teams
from muster.generation.transports import transports_mission
from muster.generation.uniform import large_mission
from muster.generation.windows import windows_mission
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.system.clock import ProcessorClock
from muster.model.problem import Problem
from muster.verification import verify
from muster_studies.instances.charging import charging_mission
from muster_studies.instances.coalitions import SKILL_SETS
from muster_studies.instances.goods import goods_instance
from muster_studies.instances.orienteering import orienteering_instance
from muster_studies.instances.routing import routing_instance, uniform_tour
from muster_studies.instances.solomon import solomon_instance
from muster_studies.peers.cp_sat import CpSat
from muster_studies.peers.cp_sat_schedule import CpSatSchedule
from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, Peer
from muster_studies.peers.pyvrp_peer import PyVRP
from muster_studies.peers.routing import Routing
from muster_studies.peers.vroom_peer import Vroom
from muster_studies.runs import mission_named

OWN = "search"
"""The allocator that is compared."""
OWN_OTHERS = ("greedy", "auction")
"""Allocators that some tables have beside it."""
PEERS: Mapping[str, Peer] = {peer.name: peer for peer in (Routing(), CpSat(), PyVRP(), Vroom())}
"""Those of most missions."""
WAITING_PEER = CpSatSchedule()
"""That of missions whose tasks wait for each other, and of no others."""

GENERATED: Mapping[str, Callable[[Sequence[str]], Mission]] = {
    "uniform": lambda words: large_mission(int(words[0]), int(words[1])),
    "solomon": lambda words: solomon_instance(words[0], int(words[1])),
    "loads": lambda words: solomon_instance(words[0], int(words[1]), loads=True),
    "goods": lambda words: goods_instance(words[0], int(words[1])),
    "customers": lambda words: customers_mission(words[0], *map(int, words[1:])),
    "transports": lambda words: transports_mission(words[0], *map(int, words[1:])),
    "charging": lambda words: charging_mission(words[0], int(words[1])),
    "windows": lambda words: windows_mission(int(words[0])),
    "waiting": lambda words: precedence_mission(words[0], *map(int, words[1:])),
    "skills": lambda words: SKILL_SETS[words[0]].instance(int(words[1])),
    "counted": lambda words: counted_teams(int(words[0])),
    "orienteering": lambda words: orienteering_instance(words[0]),
    "routes": lambda words: routing_instance(words[0], int(words[1])),
    "clustered": lambda words: clustered_mission(Clustered(robots=int(words[0]), tasks=int(words[1])), int(words[2])),
    "tour": lambda words: uniform_tour(*map(int, words)),
}
"""Missions by the first word of their name, from the words that follow."""

_TRIES = 3
_UNDISTURBED = 0.9
"""A run by the wall clock that had less of a processor, because others use the machine, is repeated."""
_TOO_SHORT_S = 0.05
_ROUNDING = 1e-4
"""What a peer's own count of the objective may be off, relative."""


@dataclass(frozen=True, kw_only=True)
class Match:
    """A mission and an objective.

    Parameters
    ----------
    mission
        the name of a shipped one, or one of `GENERATED`, such as `uniform-TASKS-ROBOTS`.
    complete
        whether a plan that does all tasks is known to exist.
    """

    mission: str
    objective: str
    ignored: tuple[str, ...] = ()
    complete: bool = False

    def problem(self) -> Problem:
        return Problem.compile(mission_of(self.mission), self.objective, self.ignored).ready()


@dataclass(frozen=True, kw_only=True)
class Run:
    """A solver's run on a match. Without randomness one seed is all there is."""

    match: Match
    solver: str
    seconds: float
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class Result:
    """What came of a run.

    `fault` says why there is no value that counts: the solver cannot express the mission, found no plan, or the judge
    rejects it. Times are seconds: `took_s` from when the model is handed over, `build_s` until then.
    """

    run: Run
    fault: str | None = None
    value: float = 0.0
    weight: float = 0.0
    tasks: int = 0
    tasks_total: int = 0
    took_s: float = 0.0
    build_s: float = 0.0
    cpu_s: float = 0.0

    @property
    def rank(self) -> tuple[float, float]:
        """Lower is better: more tasks first, then the objective."""
        return -self.weight, self.value

    @property
    def share(self) -> float:
        """How much of a processor the machine gave the run; 1 of a run too short to tell."""
        return min(1.0, self.cpu_s / self.took_s) if self.took_s > _TOO_SHORT_S else 1.0


@dataclass(frozen=True)
class Standing:
    """The runs of one solver on one match, by seed. Not empty."""

    results: tuple[Result, ...]

    @property
    def fault(self) -> str | None:
        """The first fault of any run."""
        return next((result.fault for result in self.results if result.fault is not None), None)

    @property
    def mean(self) -> float:
        return fmean(result.value for result in self.results)

    @property
    def worst(self) -> Result:
        return max(self.results, key=lambda result: result.rank)

    @property
    def same_tasks(self) -> bool:
        """Whether all runs do as much."""
        return len({result.weight for result in self.results}) == 1


@cache
def mission_of(name: str) -> Mission:
    """A shipped mission, or a generated one."""
    family, *words = name.split("-")
    return GENERATED[family](words) if family in GENERATED else mission_named(name)


def perform(run: Run) -> Result:
    """Run a solver and judge its plan."""
    problem = run.match.problem()
    begin, cpu = time.perf_counter(), time.process_time()
    if run.solver in (OWN, *OWN_OTHERS):
        stop = Stop(time_limit=run.seconds, clock=ProcessorClock())
        plan = allocator_named(run.solver).solve(problem, stop, seed=run.seed)
        return _judged(run, problem, plan, Answer(None), begin, cpu)
    instance, peer = Instance(problem, run.match.complete), _peer(run.solver)
    unable = peer.cannot(instance)
    if unable is not None:
        return Result(run=run, fault=unable)
    answer = peer.solve(instance, run.seconds, run.seed)
    if answer.routes is None:
        took_s, cpu_s = time.perf_counter() - begin - answer.build_s, time.process_time() - cpu
        return Result(run=run, fault="no plan", took_s=took_s, build_s=answer.build_s, cpu_s=cpu_s)
    return _judged(run, problem, instance.plan(answer.routes, run.solver), answer, begin, cpu)


def undisturbed(run: Run) -> Result:
    """The result of a run; of one by the wall clock the first that had a processor to itself, or most of one."""
    if run.solver not in PEERS or not PEERS[run.solver].by_wall_clock:
        return perform(run)
    results: list[Result] = []
    while len(results) < _TRIES and (not results or results[-1].share < _UNDISTURBED):
        results.append(perform(run))
    return max(results, key=lambda result: result.share)


def _judged(run: Run, problem: Problem, plan: Plan, answer: Answer, begin: float, cpu: float) -> Result:
    took_s, cpu_s = time.perf_counter() - begin - answer.build_s, time.process_time() - cpu
    verdict = verify(problem.mission, plan, problem.ignored, problem.objective)
    value = verdict.value(run.match.objective) or 0.0  # none of a plan that deadlocks, which is invalid
    fault = None
    if not verdict.valid:
        found = verdict.violations[0]
        fault = f"invalid: {found.kind} {found.robot or found.task or ''} {found.detail}"
    elif answer.claimed is not None and abs(answer.claimed - value) > _ROUNDING * max(1e-9, value):
        fault = f"claims {answer.claimed:.6g}, the judge says {value:.6g}"
    return Result(
        run=run,
        fault=fault,
        value=value,
        weight=verdict.weight_completed,
        tasks=verdict.tasks_completed,
        tasks_total=verdict.tasks_total,
        took_s=took_s,
        build_s=answer.build_s,
        cpu_s=cpu_s,
    )


Standings = Mapping[tuple[Match, str], Standing]
"""By match and solver."""


def standings_of(results: Iterable[Result]) -> Standings:
    """The results of each solver on each match."""
    found: dict[tuple[Match, str], list[Result]] = {}
    for result in results:
        found.setdefault((result.run.match, result.run.solver), []).append(result)
    return {key: Standing(tuple(some)) for key, some in found.items()}


def runs_of(matches: Iterable[Match], solvers: Sequence[str], seconds: float, seeds: int) -> list[Run]:
    """The runs of all solvers on all matches; those on one match are adjacent: the load of the machine may change."""
    return [
        Run(match=match, solver=solver, seconds=seconds, seed=seed)
        for match in matches
        for solver in solvers
        for seed in range(seeds if _is_random(solver) else 1)
    ]


def _is_random(solver: str) -> bool:
    return solver == OWN if solver in (OWN, *OWN_OTHERS) else _peer(solver).random


def _peer(name: str) -> Peer:
    return WAITING_PEER if name == WAITING_PEER.name else PEERS[name]
