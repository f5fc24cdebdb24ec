"""Solvers from elsewhere on missions in time: what each is given means what the mission means; the tables."""

import time
from dataclasses import replace

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.cli.main import run as cli
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, PEERS, Match, Result, Run, mission_of, perform, runs_of
from muster_studies.peers.instance import Instance
from muster_studies.peers.processor_time import ProcessorStop
from muster_studies.peers.teams_table import SETS, Teams
from muster_studies.peers.timed_studies import ORDERED, WINDOWS, peers_timed_study

SECONDS = 0.15


@pytest.fixture(autouse=True)
def _peers_are_installed():
    for package in ("ortools", "pyvrp", "vroom"):
        pytest.importorskip(package)


def checked(mission, peer, objective="total", seconds=SECONDS):
    """The verdict on the peer's plan, which is admissible and worth what the peer says."""
    instance = Instance(Problem.compile(mission, objective))
    assert PEERS[peer].cannot(instance) is None
    answer = PEERS[peer].solve(instance, seconds, 0)
    assert answer.routes is not None
    verdict = muster.verify(mission, instance.plan(answer.routes, peer), (), objective)
    assert verdict.violations == ()
    assert answer.claimed == pytest.approx(verdict.value(objective), rel=1e-4, abs=1e-6)
    return verdict


def on_a_line(*windows, **robot):
    """One robot at 0 and a task at 10, 20 ... each, with work of 1 s."""
    return Mission(
        robots=(Robot(id="r", position=(0, 0), **robot),),
        tasks=tuple(
            Task(id=str(k), position=(10 * k, 0), duration_s=1, window_s=window)
            for k, window in enumerate(windows, start=1)
        ),
        rules=Rules(return_to_start=True),
    )


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("peer", PEERS)
def test_work_begins_within_its_window(peer):
    verdict = checked(on_a_line(((60, 100),), ((0, 20),)), peer)
    assert verdict.total_cost == pytest.approx(40)
    assert [route.tasks for route in verdict.routes] == [("2", "1")]
    assert [visit.starts_s for visit in verdict.routes[0].visits] == pytest.approx([20, 60])


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("peer", PEERS)
def test_a_task_whose_window_is_missed_is_left_out(peer):
    verdict = checked(on_a_line(((0, 10),), ((0, 19.9),), ((31, 40),)), peer)
    assert [route.tasks for route in verdict.routes] == [("1", "3")]


@pytest.mark.parametrize("peer", PEERS)
def test_the_way_back_counts_in_a_shift(peer):
    assert checked(on_a_line((), (), available_until_s=42), peer).tasks_completed == 2
    assert checked(on_a_line((), (), available_until_s=41.9), peer).tasks_completed == 1


@pytest.mark.parametrize("peer", PEERS)
def test_a_robot_leaves_when_it_is_available(peer):
    assert checked(on_a_line(((0, 15),), available_from_s=5), peer).tasks_completed == 1
    assert checked(on_a_line(((0, 14.9),), ((0, 99),), available_from_s=5), peer).tasks_completed == 1


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("peer", ["OR-Tools", "CP-SAT", "VROOM"])
def test_one_of_several_windows_will_do(peer):
    verdict = checked(on_a_line(((0, 5), (60, 70)), ((0, 21),)), peer)
    assert [route.tasks for route in verdict.routes] == [("2", "1")]


def test_what_no_peer_is_given_is_told():
    line = on_a_line((), ())
    first, second = line.tasks
    changed = {
        "teams": replace(first, robots_needed=2),
        "relations": replace(first, other_robot_than=("2",)),
        "deadlines": replace(first, deadline_s=50.0),
    }
    for rule, task in changed.items():
        robots = (*line.robots, replace(line.robots[0], id="s"))
        instance = Instance(Problem.compile(replace(line, robots=robots, tasks=(task, second)), "total"))
        for name in ("OR-Tools", "PyVRP", "VROOM"):
            assert PEERS[name].cannot(instance) == f"no {rule}"
    several = Instance(Problem.compile(on_a_line(((0, 5), (60, 70))), "total"))
    assert PEERS["PyVRP"].cannot(several) == "no task with several windows"


def test_a_solver_is_stopped_by_processor_time():
    begin, stop = time.process_time(), ProcessorStop(0.05)
    time.sleep(0.1)
    assert not stop.due()
    while not stop(0):
        pass
    assert time.process_time() - begin >= 0.05


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("solver", [OWN, "PyVRP", "OR-Tools"])
def test_all_have_as_much_processor_time(solver):
    match = Match(mission="solomon-R201-4", objective="total", complete=True)
    result = perform(Run(match=match, solver=solver, seconds=0.4))
    assert result.fault in (None, "no plan")
    assert 0.3 <= result.cpu_s <= 1.5


@pytest.mark.parametrize(
    ("name", "tasks"),
    [("solomon-C101-10", 100), ("windows-3", 44), ("skills-several-2", 50), ("skills-one-2", 50), ("counted-7", 50)],
)
def test_generated_missions_have_names(name, tasks):
    assert len(mission_of(name).tasks) == tasks


def result_of(run, value, tasks=100):
    return Result(run=run, value=value, weight=tasks, tasks=tasks, tasks_total=100, took_s=1, cpu_s=1)


def test_windows_are_told_as_gaps():
    effort = Effort(quick=True, seeds=2)
    values = {OWN: (828.94, 837.2294), "PyVRP": (828.94, 828.94), "OR-Tools": (911.834,), "VROOM": (829.0,)}
    jobs = WINDOWS.jobs(effort)
    found = {run: result_of(run, values[run.solver][run.seed], 99 if run.solver == "VROOM" else 100) for run in jobs}
    row, mean = WINDOWS.table(effort, found).records()
    assert row["instance-robots"] == "C101-10"
    assert (row["search"], row["search, worst"]) == (pytest.approx(0.5), pytest.approx(1.0))
    assert (row["PyVRP"], row["OR-Tools"], row["VROOM"]) == (pytest.approx(0), pytest.approx(10), "99 tasks")
    assert mean["search"] is None  # one solver leaves a task out
    found = {run: replace(result, tasks=100) for run, result in found.items()}
    assert WINDOWS.table(effort, found).records()[1]["OR-Tools"] == pytest.approx(10)


def test_windows_with_prerequisites_are_counted():
    effort = Effort(quick=True)
    done = {OWN: 90, "greedy": 90, "auction": 89, "CP-SAT": 91, "OR-Tools": 90}
    ends = {OWN: 100.0, "greedy": 110.0, "auction": 50.0, "CP-SAT": 200.0, "OR-Tools": 100.0001}
    found = {run: result_of(run, ends[run.solver], done[run.solver]) for run in ORDERED.jobs(effort)}
    *rows, last = ORDERED.table(effort, found).records()
    assert [row["mission"] for row in rows] == ["windows-0", "windows-1"]
    assert last["auction"] == 178
    marks = {solver: last[f"{solver}, makespan [s]"] for solver in done}
    assert marks == {
        OWN: None,
        "greedy": "2 / 0 / 0",
        "auction": "2 / 0 / 0",
        "CP-SAT": "0 / 0 / 2",
        "OR-Tools": "0 / 2 / 0",
    }


def test_teams_are_told_beside_the_best_known():
    effort = Effort(quick=True)
    found = {run: result_of(run, 19.365229 * 1.03) for run in Teams().jobs(effort)}
    several, one, counted = Teams().table(effort, found).records()
    assert several["gap, mean [%]"] == pytest.approx(3.0)
    assert one["gap, worst [%]"] < 0
    assert counted["gap, mean [%]"] is None
    assert [team_set.instances for team_set in SETS] == [10, 10, 50]
    left_out = {run: replace(result, tasks=99) for run, result in found.items()}
    assert Teams().table(effort, left_out).records()[0]["makespan, mean [s]"] == "tasks left out"


def test_allocators_without_randomness_run_once():
    match = Match(mission="windows-0", objective="makespan")
    runs = runs_of([match], (OWN, "greedy", "auction"), SECONDS, 2)
    assert [(run.solver, run.seed) for run in runs] == [(OWN, 0), (OWN, 1), ("greedy", 0), ("auction", 0)]
    assert [perform(run).fault for run in runs[1:]] == [None, None, None]


def test_the_bench_leads_to_the_study(asked_of_studies):
    assert cli(["bench", "peers-timed", "--tables", "teams", "--seeds", "2"]) == 2
    assert asked_of_studies == [("peers-timed", Effort(seeds=2, tables=("teams",)))]


def test_iterations_are_refused():
    with pytest.raises(muster.ParameterError, match="all solvers have the same time"):
        peers_timed_study().run(Effort(iterations=5))
