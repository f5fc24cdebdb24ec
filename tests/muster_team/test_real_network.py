"""Robots that agree over a network that loses, delays and is cut: each a `muster auction --robot` in a namespace."""

import json
import sys
import time
from random import Random

import pytest
from tests.muster_team.real_network import RealNetwork, why_not

from muster import Mission, Robot, Task, verify
from muster.mission.reading.plan_reader import read_plan
from muster.mission.yaml_writer import yaml_text
from muster_team.network.keys import new_key, write_key

TASKS = 12
TEAMS = pytest.mark.parametrize("robots", [2, pytest.param(6, marks=pytest.mark.long)])
"""Numbers of robots; one process each."""

obstacle = why_not()
pytestmark = [pytest.mark.skipif(obstacle is not None, reason=str(obstacle)), pytest.mark.xdist_group("real network")]


@pytest.fixture
def mission(tmp_path, monkeypatch, robots):
    """A team in the folder of the test, with its key."""
    monkeypatch.chdir(tmp_path)
    random = Random(7)

    def place():
        return random.uniform(0, 100), random.uniform(0, 100)

    mission = Mission(
        name="field",
        robots=tuple(Robot(id=f"r_{k}", position=place()) for k in range(1, robots + 1)),
        tasks=tuple(Task(id=str(k), position=place()) for k in range(TASKS)),
    )
    (tmp_path / "field.yaml").write_text(yaml_text(mission), encoding="utf-8")
    write_key(tmp_path / "key", new_key())
    return mission


def start(network, robots, *others):
    """A robot on each host."""
    peers = ",".join(f"r_{k}={network.address(k)}:7783" for k in range(1, robots + 1))
    return [
        network.start(
            k,
            *(sys.executable, "-m", "muster.cli", "auction", "field.yaml", "--robot", f"r_{k}", "--key-file", "key"),
            *("--connect", peers, "-q", "-o", f"{k}.json", *others),
        )
        for k in range(1, robots + 1)
    ]


def assert_all_agree(mission, processes):
    assert [process.wait(60) for process in processes] == [0] * len(processes)
    plans = [read_plan(f"{k}.json") for k in range(1, len(processes) + 1)]
    assert len({json.dumps([route.tasks for route in plan.routes]) for plan in plans}) == 1
    verdict = verify(mission, plans[0])
    assert verdict.valid, verdict.violations
    assert sorted(task for route in plans[0].routes for task in route.tasks) == sorted(t.id for t in mission.tasks)


@TEAMS
def test_all_agree_through_loss_and_delay(mission, robots):
    with RealNetwork(robots, loss=0.5, delay_s=0.05) as network:
        assert_all_agree(mission, start(network, robots, "--linger", "2"))


@pytest.mark.long
@pytest.mark.parametrize("robots", [6])
def test_all_agree_when_a_cut_has_healed(mission, robots):
    with RealNetwork(robots, delay_s=0.05, loss=0.1) as network:
        processes = start(
            network, robots, "--wait", "50", "--linger", "7"
        )  # nobody leaves before the cut, or with half the team
        time.sleep(1.5)
        network.cut([1, 2, 3, 4], [5, 6])
        time.sleep(4)  # longer than it takes to be taken for lost
        network.heal()
        assert_all_agree(mission, processes)
