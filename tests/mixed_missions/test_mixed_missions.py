"""Some seeds of the campaign of mixed rules; `make campaign-mixed` tries thousands."""

from collections import Counter

import pytest

from muster.mission.plan import Plan, Route
from muster.verification import verify
from tests import trials
from tests.judged_plans import JudgedPlans
from tests.mixed_missions.missions import RULES, mixed_mission
from tests.mixed_missions.trial import trial

pytest.importorskip("ortools", reason="needs the extra exact")
CHUNK = 5
DECIDED = (7, 11, 60, 190, 293, 381, 430, 480, 501, 609, 738, 1130, 1398, 2276, 3798, 4245, 5715, 6098, 8671, 91020)
"""Seeds of which something was wrong once: crashes, reasons that are refuted, plans that the judge rejects."""


@pytest.mark.long
@pytest.mark.parametrize("first", [0, *(pytest.param(k * CHUNK, marks=pytest.mark.long) for k in range(1, 22))])
def test_nothing_that_is_said_is_refuted(first):
    reports = [trial(seed) for seed in range(first, first + CHUNK)]
    assert {report.seed: report.failures for report in reports if report.failures} == {}
    counts = sum((report.counts for report in reports), Counter())
    assert counts["search finds the best"] >= 0.9 * CHUNK


@pytest.mark.long
@pytest.mark.parametrize("seed", DECIDED)
def test_seeds_that_were_wrong_once(seed):
    assert trial(seed).failures == []


def test_every_kind_of_rule_is_in_some_mission_and_not_in_all():
    missions = [mixed_mission(seed)[0] for seed in range(200)]
    tasks = [task for mission in missions for task in mission.tasks]
    robots = [robot for mission in missions for robot in mission.robots]
    for values in (
        [task.window_s for task in tasks],
        [task.deadline_s for task in tasks],
        [task.due_s for task in tasks],
        [task.prerequisites for task in tasks],
        [any(lag.within_s is not None for lag in task.lags.values()) for task in tasks],
        [task.robots_needed or task.team for task in tasks],
        [task.needs for task in tasks],
        [task.starts_with for task in tasks],
        [task.same_robot_as or task.other_robot_than for task in tasks],
        [task.load for task in tasks],
        [task.delivers for task in tasks],
        [task.requires for task in tasks],
        [task.priority != 1 for task in tasks],
        [task.exit for task in tasks],
        [robot.available_until_s for robot in robots],
        [robot.load_capacity for robot in robots],
        [robot.battery for robot in robots],
        [robot.work_capacity for robot in robots],
        [robot.efficiency != 1 for robot in robots],
        [robot.min_tasks for robot in robots],
        [robot.end_position for robot in robots],
        [mission.stations for mission in missions],
    ):
        assert 0.01 < sum(map(bool, values)) / len(values) < 0.99
    assert len(RULES) == len(set(RULES))


@pytest.mark.parametrize("seed", [0, 4, 9])
def test_no_plan_of_whole_routes_is_better_than_the_best(seed):
    """The bounds by which plans are left out leave out none that is better: all sets of routes are judged here."""
    mission, _ = mixed_mission(seed)
    every = JudgedPlans(mission)
    best = every.best()
    for chosen in (plan for sets in every._classes.values() for plan in every._in_order(sets)):
        routes = tuple(Route(robot.id, own.names) for robot, own in zip(mission.robots, chosen, strict=True))
        verdict = verify(mission, Plan(routes=routes))
        if verdict.valid:
            assert verdict.weight_completed <= best.weight + 1e-9
            if verdict.weight_completed > best.weight - 1e-9:
                assert verdict.value() >= best.objective - 1e-9


@pytest.mark.long
def test_what_goes_wrong_is_a_failure(monkeypatch):
    monkeypatch.setattr("tests.mixed_missions.trial.lower_bound", lambda problem: 1e9)
    whole = next(seed for seed in range(50) if trial(seed).failures)
    assert any("is below the quick bound" in failure for failure in trial(whole).failures)
    monkeypatch.setattr("tests.mixed_missions.trial.lower_bound", lambda problem: 1 / 0)
    assert "ZeroDivisionError: division by zero" in trial(whole).failures


def _endless_at_one(seed):
    while seed == 1:
        pass
    return trials.Report(seed)


@pytest.mark.long
def test_a_trial_that_never_ends_is_a_failure_and_the_others_go_on():
    reports = {report.seed: report.failures for report in trials.tried(_endless_at_one, range(3), 1, 0.3)}
    assert reports == {0: [], 1: ["its process ended: more than 0.3 s of CPU time"], 2: []}
