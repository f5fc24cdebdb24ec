"""Quick bounds of missions with alternatives, against all plans of tiny ones."""

from dataclasses import replace
from random import Random

import pytest
from tests.allocation.tight_missions import tight_mission
from tests.judged_plans import JudgedPlans

from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds import of_objective
from muster.allocation.bounds.of_objective import best_bound, lower_bound
from muster.model.problem import Problem

OBJECTIVES = ("total", "max", "total+max", "average", "makespan", "lateness")
SEEDS, EACH = 1200, 60


def roomy_mission(seed):
    """The tight mission of a seed with one of the objectives, mostly without shifts; None: it has no alternatives."""
    mission, random = tight_mission(seed), Random(f"roomy {seed}")
    if not any(task.either_or for task in mission.tasks):
        return None
    rules = replace(mission.rules, objective=random.choice(OBJECTIVES), usage=random.choice(("time", "distance")))
    tasks = tuple(replace(task, due_s=random.randint(0, 15)) for task in mission.tasks)
    robots = mission.robots
    if random.random() < 0.7:
        robots = tuple(replace(r, available_until_s=None, shifts_s=(), longest_duty_s=None) for r in robots)
    return replace(mission, rules=rules, tasks=tasks, robots=robots)


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, SEEDS, EACH))
def test_no_plan_that_does_one_of_each_is_below_the_bound(first, monkeypatch):
    complete, above = 0, 0
    for mission in filter(None, map(roomy_mission, range(first, first + EACH))):
        problem, best = Problem.compile(mission), JudgedPlans(mission).best()
        done = {name for route in best.plan.routes for name in route.tasks}
        if len(done) < problem.model.most_done:
            continue
        for most in (32, 0):  # as if there were too many choices
            monkeypatch.setattr(of_objective, "_MOST_CHOICES", most)
            bound = best_bound(problem)
            assert bound.value <= best.objective * (1 + 1e-6) + 1e-6, f"{mission.name}, {most}: {bound}"
            above += bound.value > 0
        complete += 1
    assert complete > 3
    assert above > complete


def test_the_nearer_alternatives_count_and_what_needs_the_other_is_no_choice():
    robot = Robot(id="r", position=(0, 0))
    tasks = (
        Task(id="far", position=(9, 0)),
        Task(id="near", position=(1, 0), either_or=("far",)),
        Task(id="then", position=(0, 1), prerequisites=("far",)),
    )
    rules = Rules(objective="total")
    free = Mission(robots=(robot,), tasks=tasks[:2], rules=rules)
    assert lower_bound(Problem.compile(free)) == pytest.approx(1)
    needed = Mission(robots=(robot,), tasks=tasks, rules=rules)
    assert lower_bound(Problem.compile(needed)) > 9  # with the nearer one it would be 3 at most


def test_many_alternatives_leave_the_tasks_that_all_plans_do():
    sets = [
        Task(id=f"{k}{name}", position=(x, k), either_or=(f"{k}a",) if name == "b" else ())
        for k in range(12)
        for name, x in (("a", 1), ("b", 2))
    ]
    sure = Task(id="sure", position=(50, 0))
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=(*sets, sure), rules=Rules(objective="total"))
    assert lower_bound(Problem.compile(mission)) >= 50 * (1 - 1e-9)
