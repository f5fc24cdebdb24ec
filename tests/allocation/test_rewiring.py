"""Re-wiring: waiting time filled with a robot's own later tasks."""

from dataclasses import replace

import pytest
from tests.random_missions import random_mission
from tests.timed_missions.missions import ignored_in, timed_mission

import muster
from muster import Mission, Plan, Robot, Route, Task
from muster.allocation.algorithms.rewiring import rewire, rewired
from muster.allocation.fixed import with_fixed_routes
from muster.mission.errors import ParameterError
from muster.model.problem import Problem


def thesis_example():
    """6.3.1: r_f is at its task after 100, which can begin after 125; what it does next takes less than 25."""
    return Mission(
        robots=(Robot(id="f", position=(0, 0)), Robot(id="n", position=(0, 100))),
        tasks=(
            Task(id="g", position=(125, 100)),
            Task(id="j", position=(100, 0), prerequisites=("g",)),
            Task(id="later", position=(100, 10)),
        ),
    )


def plan_of(**routes):
    return Plan(routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items()))


def waiting_s(mission, plan):
    """By the judge."""
    return sum(
        visit.starts_s - visit.arrives_s for route in muster.verify(mission, plan).routes for visit in route.visits
    )


def test_the_thesis_example():
    mission = thesis_example()
    found = rewire(Problem.compile(mission), plan_of(f=["j", "later"], n=["g"]))
    assert found.plan.routes[0].tasks == ("later", "j")
    assert found.waiting_before_s == pytest.approx(25)
    assert found.waiting_after_s == pytest.approx(125 - 10 - (100**2 + 10**2) ** 0.5)


def test_a_task_that_takes_longer_than_the_waiting_stays_where_it_is():
    mission = thesis_example()
    long = replace(mission, tasks=(*mission.tasks[:2], Task(id="later", position=(200, 0))))
    plan = plan_of(f=["j", "later"], n=["g"])
    assert rewire(Problem.compile(long), plan).plan.routes[0].tasks == ("j", "later")


def test_capacity_holds():
    mission = thesis_example()
    plan = plan_of(f=["j", "later"], n=["g"])
    assert rewire(Problem.compile(mission), plan).plan.routes[0].tasks == ("later", "j")
    tight = replace(mission, robots=(replace(mission.robots[0], work_capacity=110.2), mission.robots[1]))
    assert rewire(Problem.compile(tight), plan).plan.routes[0].tasks == ("j", "later")


@pytest.mark.parametrize("seed", range(30))
def test_it_never_waits_more_nor_ends_later_and_stays_admissible(seed):
    mission = random_mission(seed, tasks=12, robots=3)
    plan = muster.solve(mission, "greedy")
    found = rewire(Problem.compile(mission), plan)
    assert muster.verify(mission, found.plan).valid
    assert found.waiting_before_s == pytest.approx(waiting_s(mission, plan))
    assert found.waiting_after_s == pytest.approx(waiting_s(mission, found.plan))
    assert found.waiting_after_s <= found.waiting_before_s
    assert found.plan.makespan_s <= plan.makespan_s + 1e-6
    assert [set(route.tasks) for route in found.plan.routes] == [set(route.tasks) for route in plan.routes]


@pytest.mark.parametrize("name", ["31T-6R", "24T-5R", "31T-6R50"])
def test_shipped_missions_wait_less(name):
    mission = muster.load(name)
    found = rewire(Problem.compile(mission), muster.solve(mission, iterations=3000))
    assert found.waiting_after_s < 0.5 * found.waiting_before_s


def test_what_is_fixed_stays():
    mission = thesis_example()
    problem = Problem.compile(mission)
    fixed = with_fixed_routes(problem, plan_of(f=["j"], n=["g"]))
    robot, task = problem.robot_index, problem.task_index
    routes = [[], []]
    routes[robot["f"]], routes[robot["n"]] = [task["j"], task["later"]], [task["g"]]
    assert rewired(fixed, routes) == routes
    assert rewired(problem, routes) != routes


def test_a_plan_that_is_not_admissible_is_refused():
    with pytest.raises(ParameterError, match="plan: the plan is not admissible"):
        rewire(Problem.compile(thesis_example()), plan_of(f=["j"], n=[]))


def test_waiting_for_a_window_is_filled_unless_a_deadline_is_missed():
    """r waits 90 s at a; b takes 40 s on the way, and its team of two is there."""
    window, deadline = ((100.0, None),), 120.0
    early = Task(id="a", position=(10, 0), duration_s=10.0, window_s=window)
    shared = Task(id="b", position=(20, 0), duration_s=30.0, robots_needed=2)
    robots = (Robot(id="r", position=(0, 0)), Robot(id="other", position=(20, 0)))
    mission = Mission(robots=robots, tasks=(early, shared))
    found = rewire(Problem.compile(mission), plan_of(r=["a", "b"], other=["b"]))
    assert found.plan.routes[0].tasks == ("b", "a")
    assert found.waiting_after_s < found.waiting_before_s
    late = replace(mission, tasks=(replace(early, window_s=((45.0, None),), deadline_s=56.0), shared))
    kept = rewire(Problem.compile(late), plan_of(r=["a", "b"], other=["b"]))
    assert kept.plan.routes[0].tasks == ("a", "b")
    assert muster.verify(mission, found.plan).valid
    assert muster.verify(replace(late, tasks=(replace(late.tasks[0], deadline_s=deadline), shared)), kept.plan).valid


@pytest.mark.parametrize("seed", range(30))
def test_rules_of_time_teams_and_relations_are_kept(seed):
    mission, ignored = timed_mission(seed), ignored_in(seed)
    plan = muster.solve(mission, "greedy", ignore=ignored)
    found = rewire(Problem.compile(mission, ignored=ignored), plan)
    assert muster.verify(mission, found.plan, ignored).valid
    assert found.waiting_after_s <= found.waiting_before_s
    assert found.plan.makespan_s <= plan.makespan_s + 1e-6
    if mission.rules.objective == "lateness":
        assert found.plan.objective_value <= plan.objective_value + 1e-6
    assert [set(route.tasks) for route in found.plan.routes] == [set(route.tasks) for route in plan.routes]
