"""The best plans of missions with goods and energy, by hand, and against planner and bounds.

`make campaign-carry` tries thousands.
"""

import pytest

from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task
from tests.carried_missions import frontiers
from tests.carried_missions.every_plan import EveryPlan
from tests.carried_missions.missions import carried_mission
from tests.carried_missions.trial import Report, Trial, trial

CHUNK = 20
# Where calls after the last task, two or three calls on one way, windows that close, or a capacity decided once.
DECIDED = (33, 68, 99, 127, 130, 136, 140, 349, 381, 90201)


@pytest.mark.long
@pytest.mark.parametrize("first", [*(pytest.param(k, marks=pytest.mark.long) for k in (0, CHUNK)), 2 * CHUNK])
def test_routes_and_bounds_agree_with_every_plan(first):
    reports = [trial(seed, planned=False) for seed in range(first, first + CHUNK)]
    assert {report.seed: report.failures for report in reports if report.failures} == {}
    assert sum(report.counts["routes that keep the rules"] for report in reports) > 100


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", DECIDED)
def test_routes_that_were_wrong_once_agree_with_every_plan(seed):
    assert trial(seed, planned=False).failures == []


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", [*range(8), 662, 904])
def test_no_plan_is_better_than_the_best(seed):
    report = trial(seed)
    assert report.failures == []
    assert report.counts["search misses the best"] == 0


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", [1, 5, 8, 13, 19])
def test_the_exact_solver_proves_the_best(seed):
    pytest.importorskip("ortools", reason="needs the extra exact")
    report = Report(seed)
    Trial(report, carried_mission(seed)).exactly()
    assert report.failures == []
    assert report.counts["exact: proven"] == 1


def test_a_robot_charges_as_much_as_it_needs_on_its_way():
    robot = Robot(id="r_0", position=(0, 0), battery=Battery(capacity=10))
    station = Station(id="s_0", position=(4, 0), services=("charge",), charge_per_s=2.0)
    rules = Rules(objective="makespan", timing="constant")
    far = Mission(rules=rules, robots=(robot,), tasks=(Task(id="a", position=(12, 0)),), stations=(station,))
    assert EveryPlan(far).best == (1.0, 13.0, (("a",),))


def test_a_load_is_put_down_on_the_way():
    robot = Robot(id="r_0", position=(0, 0), load_capacity=1)
    tasks = (Task(id="a", position=(1, 0), load=1), Task(id="b", position=(2, 0), load=1))
    station = Station(id="s_0", position=(1, 1), services=("unload",))
    mission = Mission(rules=Rules(objective="total"), robots=(robot,), tasks=tasks, stations=(station,))
    assert EveryPlan(mission).best[:2] == (2.0, pytest.approx(1 + 1 + 2**0.5))


def test_frontiers_by_hand():
    points = [(1.0, 2.0), (3.0, 6.0)]
    assert frontiers.charged(points, 1.0, 8.0) == [(1.0, 2.0), (3.0, 6.0), (5.0, 8.0)]
    assert frontiers.charged(points, 4.0, 8.0)[-1] == (2.5, 8.0)
    assert frontiers.filled(points, 1.0, 8.0) == [(5.0, 8.0)]
    assert frontiers.begun(points, ((0.0, 2.0), (4.0, 9.0)), 9.0) == [(1.0, 2.0), (2.0, 4.0), (4.0, 4.0), (4.0, 6.0)]
    assert frontiers.covers(points, [(2.0, 4.0)])
    assert not frontiers.covers(points, [(2.0, 4.5)])
