"""When tasks can begin and end at the earliest in a plan of all tasks, by hand."""

import math

import numpy as np

from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import limits_of
from muster.allocation.bounds.of_objective import earliest_ends
from muster.mission.model import Lag
from muster.model.bottleneck import kth_least
from muster.model.problem import Problem


def limits(*tasks, robots=2, **rules):
    """Of robots at 0, 10, 20, ... on a line."""
    made = tuple(Robot(id=f"r_{k}", position=(10 * k, 0)) for k in range(robots))
    problem = Problem.compile(Mission(rules=Rules(timing="constant", **rules), robots=made, tasks=tasks))
    return limits_of(problem, timed=True).with_all_done()


def task(name, x, **more):
    return Task(id=name, position=(x, 0), duration_s=5, **more)


def test_a_task_waits_for_its_nearest_robot_and_its_window():
    found = limits(task("a", 2), task("b", 9), task("c", 3, window_s=((0, 2), (7, 8))))
    assert found.begin.tolist() == [2, 1, 7]
    assert earliest_ends(found).tolist() == found.earliest(found.over).tolist() == [7, 6, 12]


def test_the_way_home_counts_for_the_robot_that_is_soonest():
    found = limits(task("a", 2), return_to_start=True)
    assert found.earliest(found.over).tolist() == [2 + 5 + 2]


def test_a_team_waits_for_its_second_member():
    assert limits(task("a", 2, robots_needed=2)).begin.tolist() == [8]
    assert earliest_ends(limits(task("a", 2, robots_needed=3))).tolist() == [math.inf]


def test_lags_hold_both_back():
    found = limits(task("a", 0), task("b", 0, prerequisites=("a",), lags={"a": Lag(after_s=4)}))
    assert found.begin.tolist() == [0, 9]
    later = task("b", 0, prerequisites=("a",), lags={"a": Lag(within_s=3)}, window_s=((30, 40),))
    assert limits(task("a", 0), later).begin.tolist() == [22, 30]


def test_tasks_that_begin_together_wait_for_each_other():
    assert limits(task("a", 0), task("b", 14, starts_with=("a",))).begin.tolist() == [4, 4]


def test_a_deadline_that_cannot_be_kept_makes_the_end_infinite():
    assert earliest_ends(limits(task("a", 2, deadline_s=6))).tolist() == [math.inf]
    assert earliest_ends(limits(task("a", 2, deadline_s=7))).tolist() == [7]


def test_what_must_follow_soon_makes_a_deadline_too_early():
    later = task("b", 0, prerequisites=("a",), lags={"a": Lag(within_s=3)}, window_s=((30, 40),))
    assert earliest_ends(limits(task("a", 0, deadline_s=20), later)).tolist()[0] == math.inf


def test_kth_least():
    values = np.array([[3.0, 1.0], [2.0, math.inf]])
    assert kth_least(values, [1, 1]).tolist() == [2, 1]
    assert kth_least(values, [2, 3]).tolist() == [3, math.inf]
