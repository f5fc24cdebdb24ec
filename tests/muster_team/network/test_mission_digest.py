"""What robots must have in common, and what may differ."""

from dataclasses import replace

import pytest

import muster
from muster.allocation.auctions.auction import Parameters
from muster.mission.yaml_writer import yaml_text
from muster.model.problem import Problem
from muster_team.network.mission_digest import mission_digest

MISSION = muster.load("auction-1")


def digest(mission=MISSION, objective=None, ignored=(), **terms):
    return mission_digest(Problem.compile(mission, objective, ignored), Parameters(**terms))


def test_how_it_is_written_does_not_count(tmp_path):
    path = tmp_path / "again.yaml"
    path.write_text(yaml_text(MISSION), encoding="utf-8")
    shuffled = replace(MISSION, robots=MISSION.robots[::-1], tasks=MISSION.tasks[::-1])
    assert digest(muster.load(path)) == digest(shuffled) == digest()


def test_the_rule_of_bids_that_is_the_default_may_be_named():
    assert digest(bid=MISSION.rules.objective) == digest()


def moved(mission):
    task = mission.tasks[0]
    x, *rest = task.position
    return replace(mission, tasks=(replace(task, position=(x + 1e-9 + 1e-6 * abs(x), *rest)), *mission.tasks[1:]))


def test_all_else_counts():
    others = [
        digest(moved(MISSION)),
        digest(replace(MISSION, robots=MISSION.robots[:-1])),
        digest(objective="max"),
        digest(ignored=("capacity",)),
        digest(bid="average"),
        digest(winner="least-contested"),
        digest(placement="append"),
        digest(battery_weight=0.5),
    ]
    assert len({digest(), *others}) == 1 + len(others)


@pytest.mark.parametrize("cell", [0, 255])
def test_the_cells_of_a_map_count_wherever_it_is(tmp_path, cell):
    image = pytest.importorskip("PIL.Image", reason="the extra `map` is not installed")
    pytest.importorskip("shapely", reason="the extra `map` is not installed")
    digests = []
    for folder, value in (("one", 255), ("two", cell)):
        (tmp_path / folder).mkdir()
        floor = image.new("L", (20, 20), 255)
        floor.putpixel((3, 3), value)
        floor.save(tmp_path / folder / "floor.png")
        (tmp_path / folder / "m.yaml").write_text(
            "schema: muster/1\nmap: {image: floor.png, resolution_m: 1.0, origin: [0, 0, 0]}\n"
            "robots: [{id: r_0, position: [10.5, 10.5]}]\ntasks: [{id: t_0, position: [15.5, 15.5]}]\n"
        )
        digests.append(digest(muster.load(tmp_path / folder / "m.yaml")))
    assert (digests[0] == digests[1]) == (cell == 255)
