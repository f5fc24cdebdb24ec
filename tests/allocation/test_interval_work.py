"""Shortages of work in intervals of time, against all plans of tiny missions, and the changes that lift them."""

from dataclasses import replace

import pytest
from tests.allocation.tight_missions import tight_mission
from tests.judged_plans import JudgedPlans

import muster
from muster import Mission, Robot, Task
from muster.allocation.bounds.feasibility import lost_tasks
from muster.allocation.bounds.work_shortfall import shortfalls
from muster.allocation.remedies.mission_remedies import mission_remedies
from muster.model.problem import Problem

SEEDS, EACH = 3000, 60


def short_of(problem):
    lost = lost_tasks(problem)
    tasks = [j for j in range(len(problem.tasks)) if j not in lost]
    return tasks, shortfalls(problem, tasks)


def short(*tasks, robots=1, **keys):
    mission = Mission(robots=tuple(Robot(id=f"r{k}", position=(0, 0), **keys) for k in range(robots)), tasks=tasks)
    return short_of(Problem.compile(mission))[1]


# --- proofs ----------------------------------------------------------------------------------------------------------


def refuted(mission, found):
    """A plan that does more than what is said to be left out; None: there is none."""
    names = {*found.tasks, *found.after}
    most = len(names) - found.alternatives - found.left_out
    return JudgedPlans(mission).find(lambda orders: len(names & set().union(*orders)) > most)


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, SEEDS, EACH))
def test_no_plan_refutes_a_shortage(first):
    proofs = 0
    for seed in range(first, first + EACH):
        mission = tight_mission(seed)
        for found in short_of(Problem.compile(mission))[1]:
            assert refuted(mission, found) is None, f"seed {seed}: {found}"
            proofs += 1
    assert proofs


@pytest.mark.parametrize("seed", [1141, 1301, 2035])
def test_what_comes_after_is_named_and_what_only_costs_ways_too(seed):
    """Without these names a plan of the tasks that are named refutes the proof."""
    mission = tight_mission(seed)
    found = short_of(Problem.compile(mission))[1]
    assert found
    assert all(refuted(mission, one) is None for one in found)


# --- what counts -----------------------------------------------------------------------------------------------------


def test_work_that_falls_into_an_interval_wherever_it_begins():
    """Each begins within 5 s and takes 10 s: two robots have time for two of three."""
    tasks = [Task(id=str(k), position=(0, 0), duration_s=10, window_s=((20 + k, 25),)) for k in range(3)]
    (found,) = short(*tasks, robots=2)
    assert found.lacking > 0
    assert found.when
    assert found.detail.startswith("27 robot-seconds of work in ") or found.needed <= 30
    assert not short(*tasks, robots=3)


def test_ways_between_tasks_count_but_for_the_first_of_each_robot():
    tasks = [Task(id=str(k), position=(20 * k, 0), duration_s=10) for k in range(4)]
    (found,) = short(*tasks, available_until_s=95)
    assert (found.needed, found.travel, found.available) == pytest.approx((40, 60, 95))
    assert found.detail == (
        "40 robot-seconds of work and at least 60 of ways between in 95 of time between 0 s and 95 s:"
        " 5 robot-seconds short"
    )
    assert found.left_out == 1
    assert not short(*tasks, available_until_s=100)


def test_of_alternatives_the_least_counts():
    long = Task(id="a", position=(0, 0), duration_s=30)
    either = Task(id="b", position=(0, 0), duration_s=8, either_or=("a",))
    other = Task(id="c", position=(0, 0), duration_s=25)
    assert not short(long, either, other, available_until_s=33)
    (found,) = short(long, either, other, available_until_s=32)
    assert (found.needed, found.available, found.tasks, found.alternatives) == (33, 32, ("a", "b", "c"), 1)


def test_a_seat_that_only_some_can_take_counts_for_these():
    """Both robots that lift are needed at each task; of those without there are enough."""
    lifts = muster.TeamPart(count=1, requires=("lift",))
    robots = [Robot(id="l", position=(0, 0), skills=("lift",), available_until_s=30)]
    robots += [Robot(id=f"r{k}", position=(0, 0)) for k in range(3)]
    team = (lifts, muster.TeamPart(count=1))
    tasks = [Task(id=str(k), position=(0, 0), duration_s=11, team=team) for k in range(3)]
    (found,) = short_of(Problem.compile(Mission(robots=tuple(robots), tasks=tuple(tasks))))[1]
    assert (found.robots, found.shared, found.needed, found.available) == (("l",), True, 33, 30)
    assert found.detail.startswith("3 tasks that l must do, at least in part: ")


def test_breaks_and_duties_are_no_time_for_work():
    tasks = [Task(id=str(k), position=(0, 0), duration_s=5) for k in range(4)]
    assert not short(*tasks, shifts_s=((0, 10), (50, 60)))
    (found,) = short(*tasks, shifts_s=((0, 10), (50, 59)))
    assert found.available == pytest.approx(19)
    assert not short(*tasks, longest_duty_s=20, available_until_s=100)
    (found,) = short(*tasks, longest_duty_s=19, available_until_s=100)
    assert found.available == pytest.approx(19)


# --- changes ---------------------------------------------------------------------------------------------------------


@pytest.mark.long
def test_changes_lift_all_that_is_short_and_less_does_not():
    changed = 0
    for seed in range(3000, 3040):
        problem = Problem.compile(tight_mission(seed))
        tasks, found = short_of(problem)
        for one in mission_remedies(problem, tasks, found, lambda: False) if found else ():
            compiled = Problem.compile(one.problem.mission)
            assert not shortfalls(compiled, tasks), f"seed {seed}: {one.remedy}"
            changed += 1
    assert changed > 5


def test_the_fewest_robots_and_the_least_longer_shift_are_said_with_a_plan_where_one_was_found():
    robots = tuple(Robot(id=name, position=(0, 0), skills=("arm",), available_until_s=30) for name in ("a", "b"))
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=15, requires=("arm",)) for k in range(7))
    mission = Mission(robots=robots, tasks=tasks)
    first, second = muster.check(mission, time_limit=5.0).together.remedies
    assert (first.robots, first.said, first.plan_found) == (("a", "a"), "2 more robots like a (arm)", True)
    assert second.said.startswith("shifts of a, b ")
    assert 22.5 <= second.seconds <= 23.5
    assert second.at_least_s <= 22.5
    longer = [replace(robot, available_until_s=30 + second.seconds) for robot in robots]
    assert not shortfalls(Problem.compile(replace(mission, robots=tuple(longer))), range(7))


def test_later_deadlines_and_longer_windows_are_changes_of_tasks():
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=10, deadline_s=25) for k in range(3))
    problem = Problem.compile(Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=tasks))
    said = [one.remedy.said for one in mission_remedies(problem, *short_of(problem), lambda: False)]
    assert said[0] == "1 more robot like r"
    assert said[1].startswith("deadlines of 3 tasks 5")


def test_all_robots_that_would_have_to_be_added_are_too_many():
    """Each robot starts too far away to do any of the work in time."""
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=10, deadline_s=12) for k in range(30))
    problem = Problem.compile(Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=tasks))
    changes = list(mission_remedies(problem, *short_of(problem), lambda: False))
    assert not any(one.remedy.robots for one in changes)
    assert not list(mission_remedies(problem, *short_of(problem), lambda: True))
