"""Tasks that no plan does together: examples with exact numbers, and all plans there are."""

import math
from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.all_plans import AllPlans
from tests.mission.strategies import examples, tiny_missions
from tests.random_missions import random_mission

from muster.allocation.bounds.feasibility import impossible
from muster.allocation.remedies.conflicts import Conflict, Together, together
from muster.mission.model import Lag, Mission, Robot, Rules, Task
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem
from muster.verification import verify


def judge(mission, plan, ignored):
    return verify(mission, plan, ignored).valid


def look(mission, *ignored, readings=300):
    """Ends after so many readings of the clock, on a fast machine as on a slow one."""
    clock = VirtualClock(step_s=1.0)
    return together(Problem.compile(mission, ignored=ignored), judge, time_limit=readings, clock=clock)


# --- examples --------------------------------------------------------------------------------------------------------


def task(name, *position, **keys):
    return Task(id=name, position=position, **keys)


def robot(name="r_0", *position, **keys):
    return Robot(id=name, position=position or (0, 0), **keys)


def mission(robots, tasks, **rules):
    return Mission(robots=tuple(robots), tasks=tuple(tasks), rules=Rules(**rules))


def conflict(*tasks, robots=("r_0",), prerequisites=(), detail):
    return Together(
        Conflict(tasks=tasks, prerequisites=prerequisites, robots=robots, detail=detail, minimal=True), unknown=False
    )


EAST, WEST, NEAR = task("east", 40, 0), task("west", -40, 0), task("near", 1, 0)


def test_two_tasks_in_opposite_directions():
    asked = mission([robot(work_capacity=60)], [WEST, NEAR, EAST])
    detail = "only r_0 can do them, and would use at least 120.00 m, of 60.00 m"
    assert look(asked) == conflict("west", "east", detail=detail)
    assert look(asked, "capacity") == Together()


@pytest.mark.parametrize(("capacity", "fits"), [(120, True), (120.01, True), (119.99, False)])
def test_a_capacity_that_is_filled_exactly(capacity, fits):
    assert (look(mission([robot(work_capacity=capacity)], [WEST, EAST])) == Together()) == fits


def test_the_way_home_counts():
    asked = mission([robot(work_capacity=130)], [WEST, EAST], return_to_start=True)
    assert look(asked).conflict.detail == "only r_0 can do them, and would use at least 160.00 m, of 130.00 m"


def test_the_reserve_counts():
    asked = mission([robot(work_capacity=120)], [WEST, EAST], capacity_reserve=0.25)
    assert look(asked).conflict.detail == "only r_0 can do them, and would use at least 120.00 m, of 90.00 m"


def test_three_tasks_for_the_only_robot_with_a_skill():
    """It can do any two of them: the way round is 4 + 4 + 4, and there are many other tasks and robots."""
    skilled = [task(name, *at, requires=("C",)) for name, at in (("1", (4, 0)), ("2", (4, 4)), ("3", (0, 4)))]
    others = [task(f"t{k}", k, -k) for k in range(20)]
    team = [robot("r_1"), robot("r_0", work_capacity=10, skills=("C",))]
    detail = "only r_0 can do them, and would use at least 12.00 m, of 10.00 m (others: skill, lacks C)"
    assert look(mission(team, [*others, *skilled])) == conflict("1", "2", "3", detail=detail)


def test_a_task_too_far_behind_its_prerequisite():
    work = [task("then", -4, 0, prerequisites=("first",)), task("first", 4, 0)]
    detail = "only r_0 can do them, and would use at least 12.00 m, of 10.00 m"
    asked = mission([robot(work_capacity=10)], work)
    assert look(asked) == conflict("then", prerequisites=("first",), detail=detail)
    assert look(asked, "prerequisites").conflict.tasks == ("then", "first")


def test_two_robots_that_cannot_share():
    """Three tasks, each 10 m from the start and 17.3 m from each other; each robot has capacity for one."""
    corners = [task(str(k), 10 * math.cos(2.1 * k), 10 * math.sin(2.1 * k)) for k in range(3)]
    found = look(mission([robot("r_0", work_capacity=15), robot("r_1", work_capacity=14)], corners)).conflict
    assert (found.tasks, found.robots, found.minimal) == (("0", "1", "2"), ("r_0", "r_1"), True)
    assert found.detail == "together r_0, r_1 would use at least 30.00 m, of 29.00 m"


def test_capacity_that_only_together_would_be_enough():
    """Together the robots have 120 m for two tasks that take 80 m, but no robot has 80 m, and r_0 can do neither."""
    team = [robot("r_0", work_capacity=39), robot("r_1", work_capacity=81)]
    found = look(mission(team, [WEST, NEAR, EAST])).conflict
    assert (found.tasks, found.robots, found.minimal) == (("west", "east"), ("r_1",), True)


def test_more_tasks_than_can_be_looked_at_one_by_one():
    """Sixteen tasks of 10 m of work each and 4 m of ways, at least; fifteen of them take 155.24 m."""
    around = [task(str(k), *at, actuation_cost=10) for k, at in enumerate([(1, 0), (0, 1), (-1, 0), (0, -1)] * 4)]
    found = look(mission([robot(work_capacity=156)], around), readings=5000).conflict
    assert found.minimal
    assert found.tasks == tuple(str(k) for k in range(16))
    assert found.detail == "only r_0 can do them, and would use at least 164.00 m, of 156.00 m"


def test_impossible_tasks_are_not_in_conflicts():
    work = [WEST, EAST, task("never", 500, 0), task("after", 1, 1, prerequisites=("never",))]
    assert look(mission([robot(work_capacity=60)], work)).conflict.tasks == ("west", "east")
    assert look(mission([robot(work_capacity=130)], work)) == Together()


def test_what_cannot_be_proven_is_unknown():
    """Twenty tasks on a circle around the start and end of a robot: the forest lacks the way home."""
    angles = [2 * math.pi * k / 20 for k in range(20)]
    ring = [task(str(k), 10 * math.cos(angle), 10 * math.sin(angle)) for k, angle in enumerate(angles)]
    assert look(mission([robot(work_capacity=79)], ring, return_to_start=True), readings=100) == Together(unknown=True)
    assert look(mission([robot(work_capacity=79.5)], ring, return_to_start=True)) == Together()


def test_no_tasks():
    assert look(mission([robot()], [])) == Together()


def test_the_same_robots_cannot_be_one_and_two():
    robots = [robot("r_0", abilities={"lift": 1.0}), robot("r_1", 9, 0, abilities={"lift": 1.0})]
    lift = task("lift", 1, 1, robots_needed=2, same_robot_as=("look",))
    found = look(mission(robots, [lift, task("look", 2, 1)])).conflict
    assert (found.tasks, found.minimal) == (("lift", "look"), True)
    assert found.detail == "the same robots must do lift and look; lift needs 2 robots, look 1 robot"
    assert look(mission(robots, [lift, task("look", 2, 1, needs={"lift": 1.0})])) == Together()


# --- against all plans there are -------------------------------------------------------------------------------------


def holds(asked):
    """Whether what is said of a mission is true of all its plans; returns what was said."""
    found = look(asked)
    sets = AllPlans(asked).sets()

    def can(names):
        return any(names <= done for done in sets)

    lost = {item.task for item in impossible(Problem.compile(asked))}
    if found.conflict is not None:
        names = frozenset(found.conflict.tasks)
        assert not can(names)
        assert names.isdisjoint(lost)
        if found.conflict.minimal:
            assert all(can(names - {name}) for name in names)
    elif not found.unknown:
        assert can(frozenset(one.id for one in asked.tasks) - lost)
    return found


seeds = st.integers(0, 10**6)


@examples(40)
@given(seed=seeds, tasks=st.integers(2, 5), robots=st.integers(2, 3))
def test_what_is_said_of_random_missions_is_true(seed, tasks, robots):
    holds(random_mission(seed, tasks=tasks, robots=robots))


@examples(6)
@given(seed=seeds)
def test_what_is_said_of_six_tasks_is_true(seed):
    holds(random_mission(seed, tasks=6, robots=2))


@examples(60)
@given(asked=tiny_missions(max_robots=2, max_tasks=4))
def test_what_is_said_of_tiny_missions_is_true(asked):
    holds(asked)


def crowded(seed, tasks=5, robots=2):
    """A mission in which every robot may do every task, and none has much capacity."""
    random = Random(seed)

    def point():
        return round(random.uniform(-10, 10), 1), round(random.uniform(-10, 10), 1)

    team = [robot(f"r_{k}", *point(), work_capacity=round(random.uniform(12, 36), 1)) for k in range(robots)]
    work = [
        task(str(k), *point(), prerequisites=tuple(str(j) for j in range(k) if random.random() < 0.15))
        for k in range(tasks)
    ]
    return mission(team, work, return_to_start=random.random() < 0.3)


@examples(40)
@given(seed=seeds, robots=st.integers(1, 3))
def test_what_is_said_of_crowded_missions_is_true(seed, robots):
    holds(crowded(seed, robots=robots))


@pytest.mark.long
def test_little_is_unknown():
    found = [holds(crowded(seed)) for seed in range(40)]
    conflicts = [one.conflict for one in found if one.conflict is not None]
    assert len(conflicts) > 10
    assert all(one.minimal for one in conflicts)
    assert not any(one.unknown for one in found)


def test_lags_that_exclude_each_other_are_named_with_their_numbers():
    lags = {"b": {"a": Lag(after_s=100)}, "c": {"a": Lag(within_s=60), "b": Lag(after_s=5)}, "a": {}}
    tasks = [task(name, 1, 0, duration_s=10, prerequisites=tuple(of), lags=of) for name, of in sorted(lags.items())]
    (lost,) = impossible(Problem.compile(mission([robot("r"), robot("s"), robot("t")], tasks)))
    first, second, third = (
        "c begins at most 60 s after a ends",
        "b begins at least 100 s after a ends",
        "c begins at least 5 s after b ends",
    )
    assert lost.task == "c"
    assert {(reason.reason, reason.detail) for reason in lost.reasons} == {
        ("prerequisite", f"{first}; {second}; {third}: with the work 55 s too long")
    }
    looser = [replace(tasks[2], lags={"a": Lag(within_s=115), "b": Lag(after_s=5)})]
    assert not impossible(Problem.compile(mission([robot("r"), robot("s"), robot("t")], [*tasks[:2], *looser])))
