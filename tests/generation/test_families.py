"""The families of random missions: one file for a seed on every machine, and missions that can be planned."""

import hashlib

import pytest

import muster
from muster import ParameterError
from muster.generation.generator import Generator
from muster.generation.registry import GENERATORS
from muster.mission.yaml_writer import yaml_text

DIGESTS = {
    "uniform": "59f8d4eb0557",
    "clustered": "513eb1b0aca0",
    "heterogeneous": "ee976f4ab32d",
    "orienteering": "c8866c3049e8",
    "ordered": "0f8560881fdc",
    "precedence": "dc0e9ffa0e27",
    "windows": "2f59409dea65",
    "customers": "5cc21458027e",
    "transports": "b6422a7a4880",
    "logistics": "b6feab1a17ec",
    "charging": "b24437bda241",
    "teams": "e795e748ee67",
    "coalitions": "abd9f5f04831",
    "warehouse": "ecb09b5f2a39",
    "drones": "6e62857b9a20",
    "moving": "1f538ab601c0",
    "narrow": "0f5416c088ab",
    "mixed": "270473f367f4",
}
"""Of the files of seed 7. Where one changes, whoever has results on the family can no longer make its missions."""
SMALLEST = {
    "uniform": {"robots": 1, "tasks": 1},
    "clustered": {"robots": 1, "tasks": 1, "clusters": 1, "spread_m": 0},
    "heterogeneous": {"robots": 1, "tasks": 1, "robot_types": 4, "task_types": 3},
    "orienteering": {"robots": 1, "tasks": 1, "most_priority": 1},
    "ordered": {"robots": 1, "tasks": 1, "most": 0},
    "precedence": {"robots": 1, "tasks": 1, "shape": "chains"},
    "windows": {"robots": 1, "tasks": 1, "ordered": 0},
    "customers": {"kind": "RC2", "customers": 1},
    "transports": {"kind": "C1", "transports": 1},
    "logistics": {"robots": 1, "tasks": 1},
    "charging": {"kind": "C2", "customers": 1, "stations": 0},
    "teams": {"robots": 1, "tasks": 1, "most": 1},
    "coalitions": {"species": 1, "robots_each": 2, "tasks": 1},
    "warehouse": {"robots": 1, "tasks": 1, "aisles": 1, "length_m": 2},
    "drones": {"robots": 1, "tasks": 1, "pads": 1},
    "moving": {"kinds": "air"},
    "narrow": {"robots": 2, "place": "circle"},
    "mixed": {"robots": 1, "tasks": 1},
}


@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_a_seed_gives_the_same_file_everywhere(family):
    (mission,) = muster.generate(family, seed=7)
    assert hashlib.sha256(yaml_text(mission).encode()).hexdigest()[:12] == DIGESTS[family]


@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_a_mission_is_that_of_its_own_seed_and_name(family, tmp_path):
    missions = muster.generate(family, count=3, seed=5)
    assert missions[1:2] == muster.generate(family, seed=6)
    assert len({yaml_text(mission) for mission in missions}) == 3
    for seed, mission in enumerate(missions, start=5):
        assert mission.name == f"{family}-{len(mission.tasks)}T-{len(mission.robots)}R-{seed}"
    missions[0].save(tmp_path / "m.yaml")
    assert muster.load(tmp_path / "m.yaml") == missions[0]


@pytest.mark.long(keep=6)
@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_most_tasks_can_be_done(family):
    (mission,) = muster.generate(family)
    plan = muster.solve(mission, "greedy")
    assert muster.verify(mission, plan).valid
    assert plan.tasks_completed >= 0.8 * plan.tasks_total


@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_the_smallest_missions_are_missions(family):
    (mission,) = muster.generate(family, seed=1, **SMALLEST[family])
    assert muster.verify(mission, muster.solve(mission, "greedy")).valid


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(("battery", "stations"), [(20, 40), (1, 3)])
def test_a_battery_lasts_to_each_customer_and_back(battery, stations):
    for seed in range(8):
        (mission,) = muster.generate("charging", seed=seed, battery_m=battery, stations=stations)
        assert mission.robots[0].battery.capacity >= battery
        plan = muster.solve(mission, "greedy")
        assert muster.verify(mission, plan).valid
        assert plan.tasks_completed == plan.tasks_total


@pytest.mark.parametrize("values", [pytest.param({"tasks": 10_000}, marks=pytest.mark.long), {"species": 1, "most": 1}])
def test_coalitions_of_many_tasks_are_drawn(values):
    assert all(task.needs for task in muster.generate("coalitions", **values)[0].tasks)


def test_coalitions_that_hardly_come_about_are_refused():
    with pytest.raises(ParameterError, match="expected less, or more robots_each"):
        muster.generate("coalitions", tasks=10_000, most=9, robots_each=1)


@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_a_family_says_what_it_is(family):
    generator = GENERATORS[family]
    assert generator.summary
    assert generator.source
    for f in generator.parameters.__dataclass_fields__.values():
        assert f.metadata["doc"], f.name


def test_parameters_do_what_they_say():
    (uniform,) = muster.generate("uniform", robots=3, tasks=200, side_m=10, objective="max", return_to_start=True)
    assert (len(uniform.robots), len(uniform.tasks)) == (3, 200)
    assert 9 < max(max(task.position) for task in uniform.tasks) <= 10
    assert (uniform.rules.objective, uniform.rules.return_to_start) == ("max", True)
    (ordered,) = muster.generate("ordered", tasks=50, most=4, reach=6)
    for k, task in enumerate(ordered.tasks):
        assert all(k - 6 <= int(before[1:]) < k for before in task.prerequisites)
    assert max(len(task.prerequisites) for task in ordered.tasks) == 4
    (teams,) = muster.generate("teams", robots=4, tasks=100, most=3)
    assert {task.robots_needed for task in teams.tasks} == {1, 2, 3}
    (logistics,) = muster.generate("logistics", tasks=401, robots=7, transports=0.5, teams=0.2, ordered=0.5, windows=1)
    jobs = [task for task in logistics.tasks if task.delivers is None]
    assert (len(logistics.tasks), len(logistics.robots)) == (401, 7)
    assert 0.4 < (401 - len(jobs)) / len(jobs) < 0.6
    assert 0.1 < sum(task.robots_needed == 2 for task in jobs) / len(jobs) < 0.3
    assert 0.4 < sum(bool(task.prerequisites) for task in jobs) / len(jobs) < 0.6
    assert all(bool(task.window_s) != bool(task.prerequisites) for task in jobs)
    (drones,) = muster.generate("drones", pads=2, highest_m=20)
    assert {len(task.position) for task in drones.tasks} == {3}
    assert all(10 <= task.position[2] <= 20 for task in drones.tasks)
    assert [station.services for station in drones.stations] == [("swap",)] * 2
    (warehouse,) = muster.generate("warehouse", aisles=3, robots=40)
    assert len(warehouse.map.zones) == 4
    assert len({robot.position for robot in warehouse.robots}) == 40


def test_every_type_of_tasks_suits_somebody():
    for mission in muster.generate("heterogeneous", count=20, robot_types=2, task_types=6):
        for kind in {task.type for task in mission.tasks}:
            assert max(row[kind] for row in mission.suitability.values()) >= mission.rules.min_suitability


@pytest.mark.parametrize(
    ("arguments", "values", "said"),
    [
        (("unifrom",), {}, "generator: unifrom; expected uniform, .*; did you mean 'uniform'"),
        (("uniform",), {"taks": 3}, "uniform: taks: unknown; did you mean 'tasks'"),
        (("uniform",), {"tasks": 0}, "uniform: tasks: 0, expected a whole number of at least 1"),
        (("uniform",), {"tasks": 2.5, "robots": 0}, "tasks: 2.5, .*robots: 0|robots: 0, .*tasks: 2.5"),
        (("customers",), {"kind": "R3"}, 'customers: kind: "R3", expected R1 or'),
        (("teams",), {"robots": 2}, r"teams: most: 5; expected at most robots \(2\)"),
        (("coalitions",), {"most": 90, "robots_each": 1}, "coalitions: most: 90; expected less"),
        (("uniform", 0), {}, "count: 0; expected a whole number from 1"),
        (("uniform", 1, -1), {}, "seed: -1; expected a whole number from 0"),
        (("uniform", 1, True), {}, "seed: true; expected a whole number"),
    ],
)
def test_what_is_wrong_is_told(arguments, values, said):
    with pytest.raises(muster.ParameterError, match=said):
        muster.generate(*arguments, **values)


def test_others_can_add_a_family():
    uniform = GENERATORS["uniform"]
    tiny = Generator(
        name="tiny",
        summary="two tasks",
        source="here",
        parameters=uniform.parameters,
        make=lambda given, seed: uniform.mission(seed, tasks=2),
    )
    GENERATORS.add("tiny", tiny)
    try:
        assert [len(mission.tasks) for mission in muster.generate("tiny", 2)] == [2, 2]
    finally:
        GENERATORS.remove("tiny")
    with pytest.raises(muster.ParameterError, match="generator tiny: it is a function; expected a Generator"):
        GENERATORS.add("tiny", test_others_can_add_a_family)
    with pytest.raises(muster.ParameterError, match=r"parameters: .*; expected a dataclass"):
        Generator(name="none", summary="", source="", parameters=int, make=print)
