"""Missions whose tasks wait for each other: their shapes, the program that CP-SAT is given, the table."""

import math

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.cli.main import run as cli
from muster.generation.precedence import SHAPES, precedence_mission
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.peers.contest import OWN, WAITING_PEER, Match, Result, Run, mission_of, perform
from muster_studies.peers.instance import Instance
from muster_studies.peers.timed_studies import peers_waiting_study
from muster_studies.peers.waiting_table import PEER, Waiting

SECONDS = 1.0
RETURNS = Rules(objective="makespan", return_to_start=True, makespan_includes_return=True)


@pytest.fixture(autouse=True)
def _cp_sat_is_installed():
    pytest.importorskip("ortools")


def before(shape, tasks=30):
    return {task.id: set(task.prerequisites) for task in precedence_mission(shape, tasks, 3).tasks}


@pytest.mark.parametrize("shape", SHAPES)
def test_some_robot_can_do_each_task(shape):
    mission = mission_of(f"waiting-{shape}-30-3-1")
    assert len(mission.tasks) == 30
    assert not Instance(Problem.compile(mission)).optional
    assert {need for task in mission.tasks for need in task.requires} <= {s for r in mission.robots for s in r.skills}
    assert mission == precedence_mission(shape, 30, 3, 1) != precedence_mission(shape, 30, 3, 2)


def test_all_but_the_last_of_a_tree_are_waited_for_once():
    waited_for = [task for some in before("tree").values() for task in some]
    assert sorted(waited_for) == sorted(f"t{k}" for k in range(1, 30))


def test_tasks_wait_for_the_layer_before():
    for task, some in before("layers").items():
        layer = int(task[1:]) // 5
        assert {int(other[1:]) // 5 for other in some} == ({layer - 1} if layer else set())


def test_tasks_on_a_piece_stand_in_one_place_in_order():
    tasks = precedence_mission("pieces", 30, 3).tasks
    for k, task in enumerate(tasks):
        assert task.prerequisites == ((f"t{k - 1}",) if k % 5 else ())
        assert task.position == tasks[k - k % 5].position


def answered(mission, seconds=SECONDS):
    instance = Instance(Problem.compile(mission, "makespan"))
    assert WAITING_PEER.cannot(instance) is None
    plan = instance.plan(WAITING_PEER.solve(instance, seconds, 0).routes, WAITING_PEER.name)
    verdict = muster.verify(mission, plan, (), "makespan")
    assert verdict.violations == ()
    assert verdict.tasks_completed == len(mission.tasks)
    return verdict


def test_robots_wait_for_each_other():
    """The far robot does the first task on its way, and the near one waits 10 s less than if it did both."""
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(100, 0), speed_mps=2.0)),
        tasks=(
            Task(id="1", position=(90, 0), duration_s=20),
            Task(id="2", position=(10, 0), duration_s=5, prerequisites=("1",)),
        ),
        rules=Rules(objective="makespan"),
    )
    assert answered(mission).makespan_s == pytest.approx(30)


@pytest.mark.parametrize(("rules", "end"), [(Rules(objective="makespan"), 31), (RETURNS, 61)])
def test_the_way_back_counts_where_the_mission_says_so(rules, end):
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)),),
        tasks=(Task(id="1", position=(30, 0), duration_s=1),),
        rules=rules,
    )
    assert answered(mission).makespan_s == pytest.approx(end)


@pytest.mark.long
@pytest.mark.parametrize("shape", SHAPES)
def test_few_tasks_end_as_early_as_with_search(shape):
    match, limits = Match(mission=f"waiting-{shape}-8-2-0", objective="makespan"), {OWN: 0.3, PEER: 6.0}
    if shape == "pieces":
        match = Match(mission="waiting-pieces-8-3-0", objective="makespan")
    own, peer = (perform(Run(match=match, solver=solver, seconds=s)) for solver, s in limits.items())
    assert peer.fault is None
    assert own.value == pytest.approx(peer.value, rel=1e-6)


def test_what_it_is_not_given_is_told():
    line = (Task(id="1", position=(9, 0)),)
    windows = Mission(robots=(Robot(id="a", position=(0, 0), available_until_s=50),), tasks=line)
    team = Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(0, 0))),
        tasks=(Task(id="1", position=(9, 0), robots_needed=2),),
    )
    assert WAITING_PEER.cannot(Instance(Problem.compile(windows, "makespan"))) == "no tasks left out"
    assert WAITING_PEER.cannot(Instance(Problem.compile(team, "makespan"))) == "no teams"
    one = Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=line)
    assert WAITING_PEER.cannot(Instance(Problem.compile(one, "total"))) == "no objective total"


def test_gaps_are_to_cp_sat():
    table, effort = Waiting(limits_s=(2.0, 5.0)), Effort(seeds=2)
    ends = {(PEER, 60.0): (200.0,), ("greedy", 60.0): (300.0,), (OWN, 2.0): (198.0, 202.0), (OWN, 5.0): (190.0, 194.0)}
    found = {
        run: Result(run=run, value=ends[run.solver, run.seconds][run.seed], weight=9, tasks=9, tasks_total=9)
        for run in table.jobs(effort)
    }
    rows = table.table(effort, found).records()
    assert len(rows) == len(table.sizes) * (len(SHAPES) + 1)
    assert rows[0]["mission"] == "waiting-tree-20-3-0"
    for row in (rows[0], rows[4]):
        assert row["greedy"] == pytest.approx(50)
        assert (row["search 2 s"], row["search 2 s, worst"]) == (pytest.approx(0, abs=1e-9), pytest.approx(1))
        assert (row["search 5 s"], row["search 5 s, worst"]) == (pytest.approx(-4), pytest.approx(-3))
    assert (rows[4]["mission"], rows[4]["CP-SAT 60 s, end [s]"]) == ("mean, 20 tasks", None)
    lost = {run: Result(run=run, fault="no plan") if run.solver == PEER else result for run, result in found.items()}
    assert table.table(effort, lost).records()[0]["search 5 s"] is None


@pytest.mark.long
def test_the_study_is_quick_where_asked():
    report = peers_waiting_study().run(Effort(quick=True))
    rows = report.tables[0].records()
    assert [row["mission"] for row in rows[:-1]] == [f"waiting-{shape}-20-3-0" for shape in SHAPES]
    assert all(math.isfinite(row["search 5 s"]) for row in rows)


def test_the_bench_leads_to_the_study(asked_of_studies):
    assert cli(["bench", "peers-waiting", "--seeds", "2"]) == 2
    assert asked_of_studies == [("peers-waiting", Effort(seeds=2))]
