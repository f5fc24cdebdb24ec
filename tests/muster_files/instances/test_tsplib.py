"""TSPLIB: what is written is read back, and what cannot be written is refused."""

from dataclasses import replace

import pytest
from hypothesis import given
from tests.mission.strategies import examples, salesmen
from tests.muster_files.instances.tsplib_writer import write_tsplib

import muster
from muster.mission.errors import MissionError
from muster.mission.model import (
    Mission,
    Robot,
    Rules,
    Task,
)
from muster_files.instances.tsplib import read_tsplib

R = Robot(id="r_0", position=(0, 0))


@examples(80)
@given(salesmen())
def test_tsplib_is_read_back(folder, mission):
    path = folder / "places.tsp"
    write_tsplib(mission, path)
    assert read_tsplib(path, salesmen=len(mission.robots)) == mission


@pytest.mark.parametrize("name", ["eil51-3", "eil51-5", "berlin52-5", "eil76-7"])
def test_shipped_salesmen_are_the_shipped_tsplib_files(name, tmp_path):
    mission, (stem, count) = muster.load(name), name.split("-")
    assert muster.load(stem, salesmen=int(count)) == mission
    write_tsplib(mission, tmp_path / "again.tsp")
    assert read_tsplib(tmp_path / "again.tsp", salesmen=int(count)) == mission


CLOSED = Mission(
    name="places-1",
    rules=Rules(return_to_start=True),
    robots=(R,),
    tasks=(Task(id="2", position=(4, 5)), Task(id="3", position=(4, 6))),
)


@pytest.mark.parametrize(
    "mission",
    [
        replace(CLOSED, rules=Rules()),
        replace(CLOSED, rules=Rules(return_to_start=True, objective="max")),
        replace(CLOSED, robots=(R, Robot(id="r_1", position=(1, 0)))),
        replace(CLOSED, robots=(replace(R, work_capacity=9),)),
        replace(CLOSED, robots=(replace(R, id="drone"),)),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[0], actuation_cost=1),)),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[0], id="a"),)),
        replace(CLOSED, tasks=CLOSED.tasks[::-1]),
        replace(CLOSED, tasks=(replace(CLOSED.tasks[1], prerequisites=("2",)), CLOSED.tasks[0])),
        replace(CLOSED, robots=(Robot(id="r_0", position=(0, 0, 0)),), tasks=()),
    ],
)
def test_what_tsplib_cannot_say_is_refused_and_nothing_is_written(mission, tmp_path):
    with pytest.raises(
        MissionError, match="more than TSPLIB can say; expected salesmen, one depot, plain tasks in 2-D"
    ):
        write_tsplib(mission, tmp_path / "places.tsp")
    assert list(tmp_path.iterdir()) == []


def test_the_depot_can_be_any_node(tmp_path):
    path = tmp_path / "three.tsp"
    path.write_text(
        "NAME: three\nTYPE: TSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EUC_2D\n"
        "NODE_COORD_SECTION\n1 0 0\n2 1.5 1e1\n 3 2 2\n",
        encoding="utf-8",
    )
    mission = muster.load(path, salesmen=2, depot="2")
    assert mission.name == "three-2"
    assert [robot.position for robot in mission.robots] == [(1.5, 10)] * 2
    assert [task.id for task in mission.tasks] == ["1", "3"]
    assert mission.rules == Rules(return_to_start=True)
