"""Goods and energy beside other solvers: the instances, what solvers are told, the tables."""

import math
from dataclasses import replace

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import impossible
from muster.cli.main import run as cli
from muster.generation.customers import customers_mission
from muster.generation.transports import transports_mission
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.instances.charging import CHARGING_REFERENCES, charging_mission
from muster_studies.instances.goods import GOODS_REFERENCES, goods_instance
from muster_studies.instances.solomon import REFERENCES, solomon_instance
from muster_studies.peers.contest import OWN, PEERS, Result, mission_of
from muster_studies.peers.instance import Instance
from muster_studies.peers.timed_studies import (
    CHARGING,
    CUSTOMERS,
    LOADS,
    PEERS_WITH_GOODS,
    TRANSPORTS,
    peers_goods_study,
)

SECONDS = 0.3
RULES = Rules(objective="total", return_to_start=True)
FAMILIES = ("R1", "R2", "C1", "C2", "RC1", "RC2")


@pytest.fixture(autouse=True)
def _peers_are_installed():
    for package in ("ortools", "pyvrp", "vroom"):
        pytest.importorskip(package)


def answered(mission, peer):
    """The verdict on the plan of a peer, who may leave tasks out."""
    instance = Instance(Problem.compile(mission, "total"))
    assert PEERS[peer].cannot(instance) is None
    verdict = muster.verify(mission, instance.plan(PEERS[peer].solve(instance, SECONDS, 0).routes, peer))
    assert verdict.violations == ()
    return verdict


def on_a_line(*tasks, robots=1, **robot):
    team = tuple(Robot(id=f"r{k}", position=(0, 0), **robot) for k in range(robots))
    return Mission(robots=team, tasks=tasks, rules=RULES)


def task(name, x, **more):
    return Task(id=name, position=(x, 0), **more)


@pytest.mark.long
@pytest.mark.parametrize("peer", PEERS_WITH_GOODS)
def test_what_finds_no_room_is_left_out(peer):
    tasks = (task("1", 10, load=3), task("2", 20, load=2), task("3", 30, load=2), task("4", 40))
    verdict = answered(on_a_line(*tasks, load_capacity=4), peer)
    assert verdict.tasks_completed == 3
    assert "1" not in verdict.routes[0].tasks
    assert answered(on_a_line(*tasks), peer).tasks_completed == 4
    assert answered(on_a_line(*tasks, robots=2, load_capacity=5.9), peer).tasks_completed == 4


@pytest.mark.long
@pytest.mark.parametrize("peer", PEERS_WITH_GOODS)
def test_one_robot_picks_up_and_delivers(peer):
    far = (task("1", 30, load=2), task("2", 10, delivers="1"), task("3", 20, load=1), task("4", 15, delivers="3"))
    mission = on_a_line(*far, robots=2, load_capacity=2)
    verdict = answered(mission, peer)
    assert verdict.tasks_completed == 4
    assert verdict.value("total") == pytest.approx(70)  # with room for both at once 60
    windows = (replace(far[0], window_s=((0, 29),)), *far[1:])
    assert answered(replace(mission, tasks=windows), peer).tasks_completed == 2


def test_what_no_peer_is_given_is_told():
    plain, electric = on_a_line(task("1", 5, load=1), load_capacity=3), charging_mission("R101", 0)
    told = {
        "goods of this kind": (
            on_a_line(task("1", 5, load=0.5), load_capacity=3),
            on_a_line(task("1", 5, load=-1), load_capacity=3, load_at_start=1),
            on_a_line(task("1", 5, load={"water": 1}), load_capacity={"water": 3}),
        ),
        "charging stations": (electric, replace(electric, stations=())),
    }
    for rule, missions in told.items():
        for mission in missions:
            instance = Instance(Problem.compile(mission, "total"))
            assert {PEERS[peer].cannot(instance) for peer in PEERS_WITH_GOODS} == {f"no {rule}"}
    assert PEERS["CP-SAT"].cannot(Instance(Problem.compile(plain, "total"))) == "no goods"


@pytest.mark.parametrize(("name", "robots"), GOODS_REFERENCES)
def test_published_instances_are_missions(name, robots):
    mission = goods_instance(name, robots)
    assert len(mission.robots) == robots
    assert (mission.robots[0].battery is not None) == ("10" in name and not name.startswith("l"))
    problem = Problem.compile(mission).ready()
    assert impossible(problem) == ()
    assert (sum(partner is not None for partner in problem.model.partners) > 100) == name.startswith("l")


@pytest.mark.parametrize(("name", "robots"), [("c101C5", 2), ("r105C5", 2)])
def test_small_instances_come_to_the_published_distance(name, robots):
    mission = goods_instance(name, robots)
    verdict = muster.verify(mission, muster.solve(mission, "search", iterations=3000, seed=1))
    assert verdict.valid
    assert verdict.tasks_completed == 5
    assert verdict.value("total") == pytest.approx(GOODS_REFERENCES[name, robots], abs=0.005)


def test_an_instance_that_is_not_shipped_is_told():
    with pytest.raises(muster.ParameterError, match="instance: lc999; expected c101C5 or"):
        goods_instance("lc999", 3)
    with pytest.raises(muster.ParameterError, match="family: R3; expected R1 or R2"):
        customers_mission("R3", 20, 0)


def test_solomons_demands_are_loads_where_asked():
    mission = solomon_instance("C101", 10, loads=True)
    assert {robot.load_capacity for robot in mission.robots} == {200}
    assert sum(each.load for each in mission.tasks) == 1810


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("make", [customers_mission, transports_mission])
def test_generated_missions_are_those_of_their_seed(make, family):
    mission = make(family, 20, 3)
    assert mission == make(family, 20, 3) != make(family, 20, 4)
    assert len(mission.tasks) == (20 if make is customers_mission else 40)
    assert impossible(Problem.compile(mission).ready()) == ()


@pytest.mark.parametrize("family", FAMILIES)
def test_a_plan_does_all_transports(family):
    mission = transports_mission(family, 12, 5)
    verdict = muster.verify(mission, muster.solve(mission, "search", iterations=4000, seed=1))
    assert verdict.valid
    assert verdict.tasks_completed == 24


@pytest.mark.parametrize("name", ["R101", "C101", "R201"])
def test_batteries_last_to_every_customer_alone(name):
    mission = charging_mission(name, 1)
    assert mission == charging_mission(name, 1) != charging_mission(name, 2)
    assert len(mission.stations) == 21
    assert mission.stations[0].position == mission.robots[0].position
    fleet = min(robots for instance, robots in REFERENCES if instance == name)
    capacity = {robot.battery.capacity for robot in mission.robots}
    assert min(capacity) == max(capacity) >= 0.6 * REFERENCES[name, fleet] / fleet
    assert impossible(Problem.compile(mission).ready()) == ()


def test_every_mission_of_the_tables_has_a_name():
    counts = dict.fromkeys(LOADS.missions, 100) | dict.fromkeys(CUSTOMERS.missions, 200)
    counts |= {f"charging-{name}-{seed}": 100 for name, seed in CHARGING_REFERENCES}
    assert {name: len(mission_of(name).tasks) for name in counts} == counts
    for name in [*CHARGING.missions, *(match.mission for match in TRANSPORTS.matches)]:
        assert mission_of(name).tasks
    assert set(CHARGING.known) >= set(CHARGING.missions)
    assert CHARGING_REFERENCES


def test_some_missions_alone_have_the_longest_limit():
    effort = Effort(seeds=1)
    runs = CUSTOMERS.jobs(effort)
    assert {run.match.mission for run in runs if run.seconds == 60} == set(CUSTOMERS.only[60.0])
    assert {run.match.complete for run in runs} == {True}
    values = {20.0: 110.0, 60.0: 100.0}
    found = {run: Result(run=run, value=values[run.seconds], weight=9, tasks=9, tasks_total=9) for run in runs}
    rows = CUSTOMERS.table(effort, found).records()
    assert [(row["mission"], row["limit [s]"]) for row in rows[-3:]] == [
        ("customers-R1-200-0", 60.0),
        ("customers-RC1-200-0", 60.0),
        ("mean", 60.0),
    ]
    assert (rows[0]["reference"], rows[0][OWN], rows[1][OWN]) == (100.0, pytest.approx(10), 0)


@pytest.mark.long
def test_the_study_is_quick_where_asked():
    report = peers_goods_study().run(Effort(quick=True))
    loads, customers, transports, charging = (table.records() for table in report.tables)
    assert loads[0][OWN] == pytest.approx(0, abs=0.01)
    assert customers[0]["mission"] == "customers-R1-20-0"
    assert [row["tasks"] for row in transports] == [100, 100, 200]
    assert charging[0][OWN] == pytest.approx(0, abs=0.01)
    assert all(math.isfinite(row[OWN]) for row in (loads[0], customers[0], charging[0]))


def test_the_bench_leads_to_the_study(asked_of_studies):
    assert cli(["bench", "peers-goods", "--tables", "charging", "--seeds", "2"]) == 2
    assert asked_of_studies == [("peers-goods", Effort(seeds=2, tables=("charging",)))]
