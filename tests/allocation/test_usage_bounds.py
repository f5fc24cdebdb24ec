"""The least usage of robots that do certain tasks, against all plans there are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.all_plans import ROUNDING, AllPlans
from tests.mission.strategies import examples
from tests.random_missions import random_mission, with_travel_tables

from muster.allocation.bounds.usage_bounds import UsageBounds
from muster.mission.model import Mission, Robot, Task
from muster.model.problem import Problem


@pytest.mark.parametrize("tabled", [False, True])
@examples(30)
@given(seed=st.integers(0, 10**6))
def test_bounds_are_below_what_plans_use(tabled, seed):
    asked = random_mission(seed, tasks=4, robots=2)
    plans = AllPlans(with_travel_tables(asked, seed) if tabled else asked)
    bounds = UsageBounds(plans.problem)
    names = [one.id for one in plans.problem.tasks]
    for k, one in enumerate(asked.robots):
        least = bounds.subset_usages(plans.problem.robot_index[one.id], range(len(names)))
        for plan in plans.plans:
            bits = sum(1 << names.index(name) for name in plan[k])
            assert least[bits] <= plans.usage(k, plan[k]) * (1 + ROUNDING)
    robots = range(len(asked.robots))
    for plan in plans.plans:
        total = sum(plans.usage(k, route) for k, route in enumerate(plan))
        done = sorted(names.index(name) for route in plan for name in route)
        assert bounds.least_together(robots, done) <= total * (1 + ROUNDING)


def test_many_tasks_hang_on_a_forest():
    """Two starts, and six tasks on a line that is left from the nearer one: 1 + 5 m of way and 2 m of work each."""
    asked = Mission(
        robots=(Robot(id="r_0", position=(0, 0)), Robot(id="r_1", position=(-9, 0))),
        tasks=tuple(Task(id=str(k), position=(1 + k, 0), actuation_cost=2) for k in range(6)),
    )
    bounds = UsageBounds(Problem.compile(asked))
    assert bounds.least_together([0, 1], range(6)) == pytest.approx(18)
    assert bounds.least_together([1], range(6)) == pytest.approx(27)
    assert bounds.subset_usages(0, [2, 5])[[0, 1, 2, 3]] == pytest.approx(np.array([0, 5, 8, 10]))
