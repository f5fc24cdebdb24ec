"""Explanations end when their time is up, and say so."""

import json

import pytest

import muster
from muster.allocation.stop import Stop
from muster.cli.main import run
from muster.mission.model import Mission, Robot, Task
from muster.mission.system.clock import VirtualClock
from muster.planning.explaining import left_out, one_task
from muster.planning.explaining.tables import tables_on_left_out, tables_on_task


@pytest.fixture(scope="module")
def mission():
    robots = [Robot(id=f"r{k}", position=(0, k), work_capacity=0) for k in range(5)]
    return Mission(robots=robots, tasks=[Task(id=f"t{k}", position=(10, k)) for k in range(20)])


@pytest.fixture(scope="module")
def plan(mission):
    return muster.solve(mission, "greedy")


def readings(most):
    """A budget that ends after the clock was read so many times."""
    return Stop(time_limit=float(most), clock=VirtualClock(step_s=1.0))


def test_without_a_limit_all_is_looked_for(mission, plan):
    found = left_out(mission, plan, (), Stop())
    assert len(found.changes) == len(found.unassigned) == 20
    assert all(item.reasons for item in found.unassigned)
    assert not found.cut_short
    assert not one_task(mission, plan, "t1", (), Stop()).cut_short


@pytest.mark.parametrize("most", [0, 10, 20, 40])
def test_tasks_left_out_in_little_time(mission, plan, most):
    found = left_out(mission, plan, (), readings(most))
    assert found.cut_short
    assert found.as_dict()["cut_short"]
    assert len(found.changes) <= most
    assert sum(bool(item.reasons) for item in found.unassigned) <= most / 2
    assert [item.task for item in found.unassigned] == [task.id for task in mission.tasks]
    assert tables_on_left_out(found)[-1].startswith("time limit: not all was looked for; ")


def test_one_task_in_little_time(mission, plan):
    found = one_task(mission, plan, "t1", (), readings(2))
    assert found.cut_short
    assert [remedy.searched for remedy in found.remedies].count(True) <= 2
    assert tables_on_task(found)[-1] == "time limit: not all was looked for: what robots would need"


def test_the_command_in_no_time(mission, plan, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mission.save("mission.yaml")
    plan.save("plan.json")
    assert run(["explain", "mission.yaml", "plan.json", "--time-limit", "0", "--format", "json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["cut_short"], said["smallest"]) == (True, [])


@pytest.mark.long
def test_a_table_of_very_many_reasons_is_not_printed(plan):
    robots = [Robot(id=f"r{k:02}", position=(0, k), work_capacity=0) for k in range(60)]
    many = Mission(robots=robots, tasks=[Task(id=f"t{k:02}", position=(10, k)) for k in range(60)])
    parts = tables_on_left_out(left_out(many, muster.solve(many, "greedy"), (), Stop()))
    assert len(parts[0].rows) == 2_000
    assert f"and {60 * 60 - 2_000} more reasons: --format json has all" in parts
