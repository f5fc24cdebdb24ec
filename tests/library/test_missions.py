"""The shipped missions hold what the documents print."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from random import Random

import pytest

from muster.library import mission_names, mission_path, mission_summary
from muster.mission.model import Mission, Task
from muster.mission.reading.yaml_reader import parse_yaml, read_yaml
from muster.mission.yaml_writer import yaml_text
from muster_files.instances.tsplib import read_tsplib

INSTANCES = {"berlin52": 52, "eil51": 51, "eil76": 76}
COUNTS = {  # robots, tasks
    "6T-2R": (2, 6),
    "6T-2R-actions": (2, 6),
    "11T-2R": (2, 11),
    "11T-2R-actions": (2, 11),
    "16T-3R": (3, 16),
    "16T-3R-actions": (3, 16),
    "16T-3R-tags": (3, 16),
    "24T-5R": (5, 24),
    "31T-2R65-4R25": (6, 31),
    "31T-2R65-4R25-as-run": (6, 31),
    "31T-3R44-3R26": (6, 31),
    "31T-3R44-3R26-as-run": (6, 31),
    "31T-6R": (6, 31),
    "31T-6R-as-run": (6, 31),
    "31T-6R50": (6, 31),
    "31T-6R50-actions": (6, 31),
    "31T-6R50-as-run": (6, 31),
    "auction-1": (2, 6),
    "auction-2": (5, 20),
    "auction-2-as-run": (5, 20),
    "auction-3-seeded": (20, 50),
    "berlin52-5": (5, 51),
    "berlin52-5-thesis": (5, 56),
    "collapsed-building": (6, 10),
    "depot": (5, 15),
    "eil51-3": (3, 50),
    "eil51-3-thesis": (3, 53),
    "eil51-5": (5, 50),
    "eil51-5-thesis": (5, 55),
    "eil51-7": (7, 50),
    "eil51-7-thesis": (7, 57),
    "eil76-7": (7, 75),
    "eil76-7-thesis": (7, 82),
    "field-survey": (3, 5),
    "flood": (3, 60),
    "floor": (5, 23),
    "market-rescue": (3, 5),
    "market-rescue-20": (5, 20),
    "market-rescue-arena": (3, 5),
    "scout-and-deliver": (5, 5),
    "six-tags": (1, 18),
    "solar-plant": (3, 20),
    "warehouse": (20, 60),
    "warehouse-charging": (10, 48),
    "yard": (4, 18),
}
THESIS = ["6T-2R", "11T-2R", "16T-3R", "24T-5R", *(name for name in COUNTS if name.startswith("31T"))]
SALESMEN = [("berlin52-5", "berlin52", 5), ("eil76-7", "eil76", 7), *((f"eil51-{k}", "eil51", k) for k in (3, 5, 7))]
CAPACITIES = {  # Table 3.16
    "31T-6R50": [50, 50, 50, 50, 50, 50],
    "31T-3R44-3R26": [44, 44, 44, 26, 26, 26],
    "31T-2R65-4R25": [25, 65, 25, 25, 65, 25],
}
SUITABILITY = {  # Table A.9
    "alpha": {"A1": 0, "A2": 1, "B": 1, "C": 1, "D": 0, "E": 0, "F": 0},
    "delta": {"A1": 0, "A2": 1, "B": 0.5, "C": 0.9, "D": 0, "E": 0, "F": 0},
    "rho": {"A1": 0, "A2": 1, "B": 0.9, "C": 0.5, "D": 0, "E": 0, "F": 0},
    "beta": {"A1": 1, "A2": 0, "B": 0, "C": 0, "D": 0.9, "E": 0.7, "F": 0.5},
    "epsilon": {"A1": 1, "A2": 0, "B": 0, "C": 0, "D": 0.7, "E": 0.5, "F": 0.9},
    "tau": {"A1": 1, "A2": 0, "B": 0, "C": 0, "D": 0.5, "E": 0.9, "F": 0.7},
}


def path_of(name: str) -> Path:
    path = mission_path(name)
    assert path is not None
    return path


@cache
def shipped(name: str) -> Mission:
    return read_yaml(path_of(name))


def task(name: str, wanted: str) -> Task:
    return next(t for t in shipped(name).tasks if t.id == wanted)


def types(name: str) -> str:
    return "".join(t.type or "?" for t in shipped(name).tasks)


def test_names_are_the_yaml_missions_and_then_the_tsplib_instances():
    assert mission_names() == [*COUNTS, *INSTANCES]


@pytest.mark.long(keep=15)
@pytest.mark.parametrize("name", COUNTS)
def test_reads_without_findings_and_goes_round_through_yaml(name):
    mission = shipped(name)
    assert mission.name == name
    assert (len(mission.robots), len(mission.tasks)) == COUNTS[name]
    assert parse_yaml(yaml_text(mission), Path("again.yaml")) == mission


@pytest.mark.parametrize("name", INSTANCES)
def test_tsplib_instance_reads_without_findings(name):
    mission = read_tsplib(path_of(name), 4)
    assert (len(mission.robots), len(mission.tasks)) == (4, INSTANCES[name] - 1)
    assert mission.name == f"{name}-4"


@pytest.mark.parametrize("name", [*COUNTS, *INSTANCES])
def test_summary_says_what_the_reader_reads(name):
    summary = mission_summary(name)
    robots, tasks = COUNTS.get(name) or (None, INSTANCES[name] - 1)
    assert (summary.name, summary.robots, summary.tasks) == (name, robots, tasks)
    assert 20 < len(summary.description) < 110
    assert not summary.description.startswith(("#", "Source", "schema"))


def test_unknown_mission():
    assert mission_path("31T-7R") is None
    assert mission_path("../missions/31T-6R") is None
    with pytest.raises(KeyError):
        mission_summary("31T-7R")


@pytest.mark.parametrize("name", [*COUNTS, *INSTANCES])
def test_file_is_plain_text(name):
    text = path_of(name).read_text(encoding="utf-8")
    assert text.isascii()
    assert text.endswith("\n")
    assert "\t" not in text


# The TCF thesis, Appendix A1


@pytest.mark.parametrize("name", THESIS)
def test_thesis_missions_state_their_rules(name):
    mission = shipped(name)
    assert mission.rules.objective == "total+max"
    assert mission.rules.min_suitability == 0.65
    assert mission.dimensions == 2
    assert [r.id for r in mission.robots] == [f"r_{k}" for k in range(len(mission.robots))]
    assert [t.id for t in mission.tasks] == [str(k) for k in range(len(mission.tasks))]
    assert mission.suitability == (None if name == "6T-2R" else SUITABILITY)


def test_31t_6r_as_table_a3_and_a4_print_it():
    mission = shipped("31T-6R")
    assert types("31T-6R") == "FEFEFEFEFFEFEFEFDFEFEFEFEFEDDDD"
    assert task("31T-6R", "3") == Task(id="3", position=(3.027, 0.691), type="E", prerequisites=("0",))
    assert task("31T-6R", "16") == Task(id="16", position=(1.025, 3.758), type="D", actuation_cost=16)
    assert task("31T-6R", "30") == Task(id="30", position=(-5.5, 5.5), type="D", actuation_cost=12)
    assert sum(t.actuation_cost for t in mission.tasks) == 64
    assert {t.id: t.prerequisites for t in mission.tasks if t.prerequisites} == {
        **dict.fromkeys(("0", "1", "2"), ("30",)),
        "3": ("0",),
        **dict.fromkeys(("5", "14", "22"), ("16",)),
        **dict.fromkeys(("7", "17", "18"), ("28",)),
        **dict.fromkeys(("8", "9", "10"), ("29",)),
        **dict.fromkeys(("11", "12", "13"), ("27",)),
    }
    assert [r.position for r in mission.robots] == [(5, -8), (6.5, -8), (8, -8), (5, -6.5), (6.5, -6.5), (8, -6.5)]
    assert [r.type for r in mission.robots] == ["beta", "epsilon", "tau"] * 2
    assert all(r.work_capacity is None for r in mission.robots)


@pytest.mark.parametrize("name", ["31T-6R", *CAPACITIES])
def test_as_run_differs_in_the_types_of_tasks_9_to_15_alone(name):
    printed, as_run = shipped(name), shipped(f"{name}-as-run")
    swapped = {"E": "F", "F": "E"}
    tasks = tuple(replace(t, type=swapped[t.type or ""]) if 9 <= int(t.id) <= 15 else t for t in printed.tasks)
    assert as_run == replace(printed, name=f"{name}-as-run", tasks=tasks)
    assert types(f"{name}-as-run")[9:16] == "EFEFEFE"


@pytest.mark.parametrize("name", CAPACITIES)
def test_variants_differ_in_work_capacity_alone(name):
    robots = tuple(
        replace(robot, work_capacity=capacity)
        for robot, capacity in zip(shipped("31T-6R").robots, CAPACITIES[name], strict=True)
    )
    assert shipped(name) == replace(shipped("31T-6R"), name=name, robots=robots)


def test_16t_3r_as_tables_a5_and_a6_print_it():
    mission = shipped("16T-3R")
    assert types("16T-3R") == "CCCCCBBBBBBBBBBB"
    assert [t.actuation_cost for t in mission.tasks] == [24] * 5 + [0] * 11
    assert task("16T-3R", "6") == Task(id="6", position=(-11.83, 0.489), type="B", prerequisites=("4",))
    assert [r.position for r in mission.robots] == [(-12, -12), (-12, -15), (-15, -12)]
    assert [r.type for r in mission.robots] == ["alpha", "delta", "rho"]


@pytest.mark.parametrize("name", ["6T-2R", "11T-2R", "24T-5R", "31T-6R", *CAPACITIES])
def test_ground_robots_as_table_a2_prints_them(name):
    for robot in shipped(name).robots:
        body = (robot.kind, robot.kinematics, robot.radius_m, robot.speed_mps, robot.yaw_rate_radps)
        assert body == ("ground", "differential-drive", 0.3, 0.26, 1.82)


def test_flying_robots_as_table_a2_prints_them():
    for robot in shipped("16T-3R").robots:
        body = (robot.kind, robot.kinematics, robot.radius_m, robot.speed_mps, robot.yaw_rate_radps)
        assert body == ("air", "quadcopter", 0.7, 0.5, 2.5)


def test_24t_5r_as_tables_a7_and_a8_print_it():
    mission = shipped("24T-5R")
    assert types("24T-5R") == "DDEFDDEFDDEFDDEFDDEFDDEF"
    assert task("24T-5R", "5").prerequisites == ("1", "18")
    assert task("24T-5R", "20") == Task(
        id="20", position=(-8.875, -0.335), type="D", actuation_cost=2, prerequisites=("13", "16")
    )
    assert [t.actuation_cost for t in mission.tasks if t.type == "D"] == [2, 4] * 6
    assert [r.position for r in mission.robots] == [(0, 0), (-1.5, -1.5), (1.5, 1.5), (-1.5, 1.5), (1.5, -1.5)]
    assert [r.type for r in mission.robots] == ["beta", "epsilon", "tau", "beta", "epsilon"]


def test_11t_2r_as_tables_a13_and_a14_print_it():
    mission = shipped("11T-2R")
    assert types("11T-2R") == "EFDFEFEEFEF"
    assert task("11T-2R", "2") == Task(id="2", position=(-0.5, 0.3), type="D", actuation_cost=2.8)
    assert task("11T-2R", "7").prerequisites == ("5", "6")
    assert task("11T-2R", "10").actuation_cost == 2
    assert [r.position for r in mission.robots] == [(-2.021, 1.461), (-2.023, -0.661)]


def test_6t_2r_as_tables_a11_and_a12_print_it():
    mission = shipped("6T-2R")
    assert types("6T-2R") == "FDFDFF"
    assert task("6T-2R", "3") == Task(id="3", position=(2.3, -1.2), type="D", actuation_cost=2)
    assert not any(t.prerequisites for t in mission.tasks)
    assert [r.position for r in mission.robots] == [(-1.857, 1.315), (-1.784, -0.581)]
    assert [r.type for r in mission.robots] == ["beta", "epsilon"]


# Multiple salesmen


@pytest.mark.parametrize(("name", "instance", "salesmen"), SALESMEN)
def test_salesmen_are_those_read_from_tsplib(name, instance, salesmen):
    assert shipped(name) == replace(read_tsplib(path_of(instance), salesmen), name=name)


@pytest.mark.parametrize(("name", "instance", "salesmen"), SALESMEN)
def test_thesis_form_has_a_return_task_for_each_robot(name, instance, salesmen):
    closed, open_ = shipped(name), shipped(f"{name}-thesis")
    cities = open_.tasks[: len(closed.tasks)]
    returns = open_.tasks[len(closed.tasks) :]
    assert [(t.id, t.position, t.type) for t in cities] == [(t.id, t.position, "city") for t in closed.tasks]
    assert [r.position for r in open_.robots] == [r.position for r in closed.robots]
    assert not open_.rules.return_to_start
    for k, (robot, back) in enumerate(zip(open_.robots, returns, strict=True)):
        assert back.id == back.type == f"return_{k}"
        assert back.position == robot.position
        assert back.prerequisites == tuple(t.id for t in cities)
        assert robot.type == f"salesman_{k}"
    table = open_.suitability or {}
    assert table == {f"salesman_{k}": {"city": 1, f"return_{k}": 1} for k in range(salesmen)}


OPTIMAL_TOURS = {  # one salesman: the tour, and its length as published for TSPLIB, with distances rounded
    "berlin52": (
        7542,
        "1 49 32 45 19 41 8 9 10 43 33 51 11 52 14 13 47 26 27 28 12 25 4 6 15 5 24 48 38 37 40 39 36 35 34 44 46 16 "
        "29 50 20 23 30 2 7 42 21 17 3 18 31 22",
    ),
    "eil51": (
        426,
        "1 22 8 26 31 28 3 36 35 20 2 29 21 16 50 34 30 9 49 10 39 33 45 15 44 42 40 19 41 13 25 14 24 43 7 23 48 6 27 "
        "51 46 12 47 18 4 17 37 5 38 11 32",
    ),
    "eil76": (
        538,
        "1 33 63 16 3 44 32 9 39 72 58 10 31 55 25 50 18 24 49 23 56 41 43 42 64 22 61 21 47 36 69 71 60 70 20 37 5 15 "
        "57 13 54 19 14 59 66 65 38 11 53 7 35 8 46 34 52 27 45 29 48 30 4 75 76 67 26 12 40 17 51 6 68 2 74 28 62 73",
    ),
}


@pytest.mark.parametrize("name", INSTANCES)
def test_tsplib_instance_has_the_optimum_it_is_known_for(name):
    length, nodes = OPTIMAL_TOURS[name]
    mission = read_tsplib(path_of(name), 1)
    positions = {"1": mission.robots[0].position} | {t.id: t.position for t in mission.tasks}
    tour = nodes.split()
    assert sorted(tour) == sorted(positions)
    legs = [math.dist(positions[a], positions[b]) for a, b in zip(tour, [*tour[1:], tour[0]], strict=True)]
    assert sum(round(leg) for leg in legs) == length


# The auction thesis and the market paper


def test_auction_1_as_table_5_1_prints_it():
    mission = shipped("auction-1")
    assert {r.id: r.position for r in mission.robots} == {"firefly0": (0, 0, 0), "firefly1": (2, 0, 0)}
    assert {t.id: t.position for t in mission.tasks} == {
        "task1": (-4, 2, 1),
        "task2": (-3, -4, 3),
        "task3": (-1, -4, 3),
        "task4": (-1, 2, 1),
        "task5": (3, 4, 2),
        "task6": (1, 1, 1),
    }


def test_auction_2_as_tables_5_16_and_5_17_print_it():
    mission = shipped("auction-2")
    assert [r.id for r in mission.robots] == [f"firefly{k}" for k in range(5)]
    assert [r.position for r in mission.robots] == [(9, -7, 0), (-13, 10, 0), (7, -8, 0), (-15, 10, 0), (20, -4, 0)]
    assert [t.id for t in mission.tasks] == [f"task{k}" for k in range(20)]
    assert task("auction-2", "task0").position == (-9, -13, 10)
    assert task("auction-2", "task10").position == (-6, 11, 20)
    assert task("auction-2", "task19").position == (11, 16, 7)


def test_auction_2_as_run_differs_in_task0_alone():
    printed = shipped("auction-2")
    tasks = (replace(printed.tasks[0], position=(-9.0, 13.0, 10.0)), *printed.tasks[1:])
    assert shipped("auction-2-as-run") == replace(printed, name="auction-2-as-run", tasks=tasks)


@pytest.mark.parametrize("name", ["auction-1", "auction-2", "auction-2-as-run", "auction-3-seeded"])
def test_auction_missions_are_of_drones_that_start_on_the_ground(name):
    mission = shipped(name)
    assert mission.rules.objective == "total"
    assert mission.dimensions == 3
    assert all(r.kind == "air" and r.position[2] == 0 for r in mission.robots)


def test_auction_3_seeded_is_drawn_as_its_file_says():
    mission, random = shipped("auction-3-seeded"), Random(2019)
    starts = [(random.randint(28, 47), random.randint(28, 47), 0) for _ in range(20)]
    places = [(random.randint(0, 75), random.randint(0, 75), random.randint(1, 20)) for _ in range(50)]
    assert {r.id: r.position for r in mission.robots} == {f"firefly{k}": start for k, start in enumerate(starts)}
    assert {t.id: t.position for t in mission.tasks} == {f"task{k}": place for k, place in enumerate(places)}


def test_market_rescue_is_figure_3_in_si_units():
    mission = shipped("market-rescue")
    assert (mission.rules.objective, mission.rules.usage) == ("max", "time")
    robots = {r.id: (r.skills, r.speed_mps * 60, r.work_capacity, r.efficiency) for r in mission.robots}
    assert robots == {
        "handBot": (("gripper",), pytest.approx(10.8), 12 * 60, 0.87),
        "eyeBot": (("camera",), pytest.approx(11.1), 12 * 60, 0.92),
        "rangeBot": (("laser-rangefinder",), pytest.approx(8.6), 12 * 60, 0.81),
    }
    tasks = {t.id: (t.requires, (t.duration_s or 0) / 60) for t in mission.tasks}
    assert tasks == {
        "survivor1": (("gripper",), pytest.approx(0.17)),
        "survivor2": (("gripper",), pytest.approx(0.17)),
        "survivor3": (("camera",), pytest.approx(0.03)),
        "survivor4": (("laser-rangefinder",), pytest.approx(0.08)),
        "survivor5": (("camera",), pytest.approx(0.03)),
    }


def test_market_rescue_fits_its_arena():
    mission = shipped("market-rescue")
    places = [*(r.position for r in mission.robots), *(t.position for t in mission.tasks)]
    assert all(0 <= x <= 2 and 0 <= y <= 2 for x, y in places)
    assert min(math.dist(a, b) for k, a in enumerate(places) for b in places[:k]) >= 0.3


def test_market_rescue_arena_is_market_rescue_with_bodies_and_obstacles():
    plain, arena = shipped("market-rescue"), shipped("market-rescue-arena")
    assert (arena.tasks, arena.rules) == (plain.tasks, plain.rules)
    bodies = {"kinematics", "radius_m", "heading_deg", "yaw_rate_radps", "acceleration_mps2"}
    for one, other in zip(plain.robots, arena.robots, strict=True):
        assert replace(other, **{name: getattr(one, name) for name in bodies}) == one
        assert other.kinematics == "differential-drive"
        assert other.radius_m >= 0.065  # a Khepera-III is 0.13 m wide
    assert arena.map is not None
    assert len(arena.map.zones) == 5
