"""Some seeds of the campaign; `make campaign` runs thousands."""

import pytest

from muster.model.problem import Problem
from tests.action_missions import ACTIONS
from tests.campaign.missions import case
from tests.campaign.trial import trial

pytest.importorskip("ortools", reason="needs the extra exact")
pytest.importorskip("shapely", reason="needs the extra `map`")
FIRST, CHUNK = 15, 20


@pytest.mark.long
@pytest.mark.parametrize("first", [FIRST, pytest.param(FIRST + CHUNK, marks=pytest.mark.long)])
def test_nothing_fails(first):
    failures = {seed: report.failures for seed in range(first, first + CHUNK) if (report := trial(seed)).failures}
    assert failures == {}


def test_a_trial_that_goes_wrong_is_a_failure(monkeypatch):
    monkeypatch.setattr("tests.campaign.trial.lower_bound", lambda problem: 1e9)
    small = next(seed for seed in range(100) if case(seed).small and trial(seed).failures)
    assert any("below the bound" in failure for failure in trial(small).failures)
    monkeypatch.setattr("tests.campaign.trial.lower_bound", lambda problem: 1 / 0)
    assert trial(small).failures == ["ZeroDivisionError: division by zero"]


@pytest.mark.long
def test_the_missions_have_every_rule():
    missions = [case(seed).mission for seed in range(200)]
    rules = [mission.rules for mission in missions]
    robots = [robot for mission in missions for robot in mission.robots]
    tasks = [task for mission in missions for task in mission.tasks]
    assert {rule.objective for rule in rules} == {"total", "max", "total+max", "average", "makespan"}
    assert {rule.usage for rule in rules} == {"distance", "time"}
    assert {rule.travel for rule in rules} == {None, "matrix", "euclidean"}
    assert {mission.travel_rule for mission in missions} == {"euclidean", "matrix", "map"}
    acting = [mission for mission in missions if any(task.action for task in mission.tasks)]
    assert {(mission.dimensions, mission.map is None) for mission in acting} == {
        (2, True),
        (2, False),
        (3, True),
        (3, False),
    }
    assert {task.action.name for mission in acting for task in mission.tasks if task.action} == set(ACTIONS)
    assert {robot.kind for robot in robots} == {"ground", "air"}
    assert {robot.return_to_start for robot in robots} == {None, True, False}
    for values in (
        [mission.suitability for mission in missions],
        [rule.capacity_reserve for rule in rules],
        [robot.work_capacity for robot in robots],
        [robot.skills for robot in robots],
        [robot.end_position for robot in robots],
        [robot.available_from_s for robot in robots],
        [robot.efficiency - 1 for robot in robots],
        [robot.camera for robot in robots],
        [task.action for task in tasks],
        [task.prerequisites for task in tasks],
        [task.only_robots for task in tasks],
        [task.requires for task in tasks],
        [task.entry for task in tasks],
        [task.exit for task in tasks],
        [task.duration_s for task in tasks],
        [task.priority - 1 for task in tasks],
    ):
        assert 0.05 < sum(bool(value) for value in values) / len(values) < 0.95
    across = [
        set(locks).isdisjoint(task.only_robots)
        for mission in missions
        for task in mission.tasks
        for locks in (other.only_robots for other in mission.tasks if other.id in task.prerequisites)
        if task.only_robots and locks
    ]
    assert sum(across) > 20
    assert any(Problem.compile(mission).travel[0].size for mission in missions)
