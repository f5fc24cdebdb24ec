"""Solvers from elsewhere: what each is given means what the mission means, and each plan is judged."""

import builtins
import sys
from dataclasses import replace

import numpy as np
import pytest
from tests.random_missions import random_mission

import muster
from muster import Mission, Robot, Rules, Task
from muster.cli.main import run as cli
from muster.generation.uniform import large_mission
from muster.mission.model import OBJECTIVES
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, PEERS, Match, Result, Run, perform, runs_of, standings_of, undisturbed
from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer
from muster_studies.peers.study import Limits, peers_study
from muster_studies.peers.sweep import RUNS, Routed, swept
from muster_studies.repetition import Repetition
from muster_studies.tables import Report, Table

SECONDS = 0.1
EXACT = "CP-SAT"


@pytest.fixture(autouse=True)
def _peers_are_installed(request):
    if "without" not in request.node.name:
        for package in ("ortools", "pyvrp", "vroom"):
            pytest.importorskip(package)


def answered(mission, peer, objective, ignored=(), seconds=SECONDS):
    instance = Instance(Problem.compile(mission, objective, ignored))
    return instance, PEERS[peer].solve(instance, seconds, 0)


def judged(mission, peer, objective, **more):
    instance, answer = answered(mission, peer, objective, **more)
    assert answer.routes is not None
    return answer, muster.verify(mission, instance.plan(answer.routes, peer), more.get("ignored", ()), objective)


def checked(mission, peer, objective, **more):
    """The verdict on the peer's plan, which is admissible and worth what the peer says."""
    answer, verdict = judged(mission, peer, objective, **more)
    assert verdict.violations == ()
    assert answer.claimed == pytest.approx(verdict.value(objective), rel=1e-4, abs=1e-6)
    return verdict


def taken(mission):
    """The peers and objectives that the mission can be put to."""
    for objective in OBJECTIVES:
        instance = Instance(Problem.compile(mission, objective))
        for name, peer in PEERS.items():
            if peer.cannot(instance) is None:
                yield name, objective


SMALL = ("6T-2R", "uniform-12-3")
PAIRS = [
    (name, peer, objective)
    for name in SMALL
    for objective in OBJECTIVES
    for peer in PEERS
    if peer in ("OR-Tools", "CP-SAT") or objective in ("total", "max", "total+max")
]


@pytest.mark.long(keep=9)
@pytest.mark.parametrize(("name", "peer", "objective"), PAIRS)
def test_plans_are_admissible_and_worth_what_the_peer_says(name, peer, objective):
    mission = large_mission(12, 3) if name.startswith("uniform") else muster.load(name)
    verdict = checked(mission, peer, objective)
    assert verdict.tasks_completed == len(mission.tasks)
    if peer == "OR-Tools" or (peer != EXACT and objective == "total"):  # runs of a sweep are too short here
        best = muster.solve(mission, OWN, objective=objective, iterations=4000)
        assert verdict.value(objective) <= 1.25 * best.objective_value


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_cp_sat_finds_the_best_plan_of_a_small_mission(objective):
    mission = large_mission(5, 2)
    best = muster.solve(mission, OWN, objective=objective, iterations=4000)
    assert checked(mission, EXACT, objective).value(objective) == pytest.approx(best.objective_value, rel=1e-5)


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_cp_sat_has_at_least_the_plan_of_greedy(objective):
    mission = muster.load("31T-6R50")
    greedy = muster.solve(mission, "greedy", objective=objective)
    verdict = checked(mission, EXACT, objective, seconds=0.01)
    assert verdict.weight_completed >= greedy.weight_completed
    if verdict.weight_completed == greedy.weight_completed:
        assert verdict.value(objective) <= greedy.objective_value * (1 + 1e-9)


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", range(12))
def test_every_rule_is_translated(seed):
    """Skills, suitability, locks, capacities, priorities, ends, speeds, entries: what is wrong in a model is seen."""
    mission = random_mission(seed, tasks=6, robots=3)
    mission = replace(mission, tasks=tuple(replace(task, prerequisites=()) for task in mission.tasks))
    objective = OBJECTIVES[seed % len(OBJECTIVES)]
    for peer, own_objective in taken(mission):
        if own_objective == objective:
            verdict = checked(mission, peer, objective)
            best = muster.solve(mission, OWN, objective=objective, iterations=3000)
            if peer != "VROOM":  # its sum over vehicles is heuristic
                assert verdict.weight_completed == best.weight_completed


@pytest.mark.long(keep=3)
@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("seed", range(2))
def test_prerequisites_hold_across_robots(seed, objective):
    mission = random_mission(100 + seed, tasks=6, robots=3)
    for peer, own_objective in taken(mission):
        if own_objective == objective:
            checked(mission, peer, objective)


def waiting(speed=1.0):
    """The task that is near waits for one that is far."""
    return Mission(
        robots=(
            Robot(id="near", position=(0, 0), available_from_s=3),
            Robot(id="far", position=(10, 0), speed_mps=speed, efficiency=0.5),
        ),
        tasks=(
            Task(id="first", position=(12, 0), duration_s=4, only_robots=("far",)),
            Task(id="second", position=(1, 0), prerequisites=("first",), duration_s=2, only_robots=("near",)),
        ),
        rules=Rules(return_to_start=True),
    )


@pytest.mark.parametrize("peer", ["OR-Tools", "CP-SAT"])
@pytest.mark.parametrize("speed", [1.0, 0.5])
def test_waiting_counts_in_the_makespan(peer, speed):
    assert checked(waiting(speed), peer, "makespan").makespan_s == pytest.approx(2 / speed + 8 + 2)


@pytest.mark.parametrize("peer", ["OR-Tools", "CP-SAT"])
def test_a_robot_that_leaves_later_is_late(peer):
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0), available_from_s=100), Robot(id="b", position=(50, 0))),
        tasks=(Task(id="1", position=(1, 0)),),
    )
    assert checked(mission, peer, "makespan").makespan_s == pytest.approx(49)


@pytest.mark.parametrize("peer", PEERS)
def test_what_does_not_fit_a_capacity_is_left_out(peer):
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0), work_capacity=10),),
        tasks=tuple(Task(id=str(k), position=(x, 0)) for k, x in enumerate((4, -7, 9, 30))),
    )
    verdict = checked(mission, peer, "total")
    assert [route.tasks for route in verdict.routes] == [("0", "2")]


def test_what_a_peer_cannot_express_is_said():
    prerequisites = Instance(Problem.compile(muster.load("31T-6R"), "total"))
    waits = Instance(Problem.compile(muster.load("6T-2R"), "makespan"))
    for name in ("PyVRP", "VROOM"):
        assert PEERS[name].cannot(prerequisites) == "no prerequisites"
        assert PEERS[name].cannot(waits) == "no makespan"
    assert PEERS["OR-Tools"].cannot(prerequisites) is None
    result = perform(Run(match=Match(mission="31T-6R", objective="total"), solver="VROOM", seconds=SECONDS))
    assert result.fault == "no prerequisites"


def test_whole_numbers_are_not_below_the_true_ones():
    instance = Instance(Problem.compile(muster.load("eil51-3")))
    costs, metres = instance.usage, instance.problem.legs(0, list(range(50)), list(range(50)))
    legs = costs.legs[0][:50, :50] / costs.scale
    assert (legs >= metres - 1e-9).all()
    assert np.abs(legs - metres).max() <= 1e-6 * metres.max()
    assert instance.node_count == 51  # all robots start and end at one place


@pytest.mark.parametrize("mission", [large_mission(12, 3), muster.load("31T-6R50")], ids=["uniform", "capacities"])
def test_numbers_too_large_for_vroom_are_divided(monkeypatch, mission):
    mission = replace(mission, tasks=tuple(replace(task, prerequisites=()) for task in mission.tasks))
    monkeypatch.setattr("muster_studies.peers.vroom_peer._MOST_COST", 10**7)
    checked(mission, "VROOM", "total")


def test_a_sweep_takes_the_best_of_its_runs():
    instance = Instance(Problem.compile(large_mission(4, 2), "total+max"))
    caps = []

    def run(cap, seconds):
        caps.append(cap)
        long = 10_000_000 if cap is None else cap
        return Routed([[0, 1], [2, 3]], [long, 30_000_000 - 2 * long // 3]) if long > 7_000_000 else None

    best = swept(instance, run, 0.5)
    assert caps[0] is None
    assert len(caps) > RUNS / 2
    assert best.value("total+max") == min(
        sum(r) + max(r) for cap in list(caps) if (routed := run(cap, 0)) is not None for r in [routed.lengths]
    )


def test_a_sweep_for_the_total_is_one_run():
    instance = Instance(Problem.compile(large_mission(4, 2), "total"))
    asked = []

    def run(cap, seconds):
        asked.append((cap, seconds))
        return Routed([[0, 1], [2, 3]], [5, 6])

    assert swept(instance, run, 0.25).value("total") == 11
    assert len(asked) == 1
    assert asked[0][1] == pytest.approx(0.25, abs=0.01)


class Cheat:
    """Does all with the first robot, allowed or not, and says that it costs nothing."""

    name, distribution, settings, random = "VROOM", "pyvroom", "", False

    def __init__(self, claimed):
        self.claimed = claimed

    def cannot(self, instance):
        return None

    def solve(self, instance, seconds, seed):
        routes = [list(range(len(instance.tasks))), *[[] for _ in range(instance.robot_count - 1)]]
        return Answer(routes, self.claimed)


def test_an_invalid_plan_is_told(monkeypatch):
    monkeypatch.setattr("muster_studies.peers.contest.PEERS", dict(PEERS) | {"VROOM": Cheat(None)})
    result = perform(Run(match=Match(mission="31T-6R50", objective="total"), solver="VROOM", seconds=SECONDS))
    assert result.fault.startswith("invalid: suitability r_0")


def test_a_false_claim_is_told(monkeypatch):
    monkeypatch.setattr("muster_studies.peers.contest.PEERS", dict(PEERS) | {"VROOM": Cheat(1.0)})
    result = perform(Run(match=Match(mission="6T-2R", objective="total"), solver="VROOM", seconds=SECONDS))
    assert result.fault.startswith("claims 1, the judge says")


def test_only_random_solvers_run_with_several_seeds():
    match = Match(mission="6T-2R", objective="total")
    runs = runs_of([match], (OWN, "OR-Tools", "PyVRP", "VROOM"), SECONDS, 3)
    assert [(run.solver, run.seed) for run in runs if run.seed] == [(OWN, 1), (OWN, 2), ("PyVRP", 1), ("PyVRP", 2)]
    standings = standings_of(undisturbed(run) for run in runs if run.solver == OWN)
    assert len(standings[match, OWN].results) == 3
    assert isinstance(standings[match, OWN].worst, Result)


@pytest.mark.long
def test_the_report_has_every_mission_solver_and_the_machine():
    counted = []
    report = peers_study(Limits(0.05, 0.05, 0.2)).run(
        Effort(quick=True, tables=("total+max", "large")), 1, lambda done, runs: counted.append((done, runs))
    )
    table, large = report.tables
    assert [row["mission"] for row in table.records()] == [*SMALL, "mean"]
    assert {"search", "search, worst", "OR-Tools / search", "PyVRP, worst", "VROOM"} <= set(table.columns)
    assert [row["solver"] for row in large.records()] == [OWN, "OR-Tools", "PyVRP", "VROOM"]
    assert counted[-1] == (report.runs, report.runs)
    legend = "\n".join(report.legend)
    assert "cores" in legend
    assert "ortools 9" in legend
    assert "sweep over a cap" in legend


def test_the_bench_leads_to_the_study(monkeypatch, tmp_path, capsys):
    asked = []

    def run(self, effort, workers=1, on_done=None):
        asked.append(effort)
        table = Table("total", "a title", ("mission",), (("6T-2R",),))
        return Report(study="peers", document="", seeds=2, runs=1, cpu_s=0.0, legend=(), tables=(table,))

    monkeypatch.setattr(Repetition, "run", run)
    file = tmp_path / "benchmarks.md"
    assert cli(["bench", "peers", "--tables", "total", "--seeds", "2", "-o", str(file)]) == 0
    assert cli(["study", "peers", "--tables", "total", "--seeds", "2"]) == 0
    assert asked == 2 * [Effort(seeds=2, tables=("total",))]
    assert "| 6T-2R |" in file.read_text()


def test_iterations_are_refused():
    with pytest.raises(muster.ParameterError, match="all solvers have the same time"):
        peers_study().run(Effort(iterations=5))


def test_time_limits_are_checked():
    with pytest.raises(muster.ParameterError, match="all: 0"):
        Limits(0, 1.0, 1.0)


@pytest.mark.parametrize("name", PEERS)
def test_without_the_package_one_line_says_what_to_install(monkeypatch, name):
    package = {"pyvroom": "vroom"}.get(PEERS[name].distribution, PEERS[name].distribution)
    real = builtins.__import__

    def absent(module, *arguments, **more):
        if module.split(".")[0] == package:
            raise ModuleNotFoundError(f"No module named {package!r}", name=package)
        return real(module, *arguments, **more)

    for module in [module for module in sys.modules if module.split(".")[0] == package]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setattr(builtins, "__import__", absent)
    with pytest.raises(muster.MusterError, match=r"pip install 'muster-robotics\[studies\]'") as raised:
        answered(muster.load("6T-2R"), name, "total")
    assert "\n" not in str(raised.value)


def test_without_the_packages_the_study_says_so_at_once(monkeypatch):
    from importlib.metadata import PackageNotFoundError

    def absent(name):
        raise PackageNotFoundError(name)

    monkeypatch.setattr("muster_studies.peers.machine.version", absent)
    with pytest.raises(muster.MusterError, match=r"needs an optional part: pip install 'muster-robotics\[studies\]'"):
        peers_study().run(Effort(quick=True))
