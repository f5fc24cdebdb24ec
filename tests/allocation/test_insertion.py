"""Incremental insertion: new tasks go between those that are there, which keep their robots and their order."""

from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

from muster import core
from muster.allocation.algorithms.greedy import completed
from muster.allocation.algorithms.insertion import inserted
from muster.mission.model import Mission, Robot, Rules, Task
from muster.model.problem import Problem


def compiled(*tasks, robots=1, objective="makespan", **rules):
    crew = tuple(Robot(id=f"r_{k}", position=(0, 10 * k), **rules) for k in range(robots))
    return Problem.compile(Mission(robots=crew, tasks=tasks, rules=Rules(objective=objective))).ready()


def named(problem, routes):
    return [[problem.tasks[j].id for j in route] for route in routes]


@given(st.integers(0, 10**6), st.integers(0, 3))
def test_all_that_fits_is_put_in_and_the_rest_keeps_its_robots_and_order(seed, every):
    problem = Problem.compile(random_mission(seed)).ready()
    greedy = completed(problem)
    waits_for = {j: set(problem.prerequisites[j]) for j in range(len(problem.tasks))}
    out = {j for route in greedy for k, j in enumerate(route) if every and k % every == 0}
    while more := {j for j, before in waits_for.items() if before & out and j not in out}:
        out |= more
    start = [[j for j in route if j not in out] for route in greedy]
    routes = inserted(problem, start)
    there = {j for route in start for j in route}
    assert [[j for j in route if j in there] for route in routes] == start
    inspection = core.Inspection(problem.core, routes)
    assert inspection.admissible
    assert problem.value(routes)[0] >= problem.value(start)[0]
    assert inserted(problem, routes) == routes


def test_a_task_goes_where_it_lengthens_a_route_least():
    tasks = [Task(id=name, position=(x, 0)) for name, x in (("a", 10), ("b", 30), ("c", 20))]
    problem = compiled(*tasks)
    assert named(problem, inserted(problem, [[0, 1]])) == [["a", "c", "b"]]


def test_the_most_urgent_gets_the_room_that_there_is():
    tasks = (
        Task(id="first", position=(6, 0)),
        Task(id="late", position=(6, 0), deadline_s=50),
        Task(id="early", position=(-6, 0), deadline_s=40),
        Task(id="urgent", position=(0, 6), priority=5),
    )
    for room, chosen in ((7, {"urgent"}), (15, {"urgent", "early"})):
        problem = compiled(*tasks, objective="total", work_capacity=room)
        (route,) = named(problem, inserted(problem, [[]]))
        assert set(route) == chosen


def test_prerequisites_and_tasks_that_begin_together_are_put_in_whole():
    tasks = (
        Task(id="b", position=(5, 0), prerequisites=("a",)),
        Task(id="a", position=(9, 0)),
        Task(id="c", position=(5, 5), robots_needed=2),
        Task(id="d", position=(1, 1), prerequisites=("never",)),
        Task(id="never", position=(1, 1), robots_needed=3),
    )
    problem = compiled(*tasks, robots=2)
    routes = named(problem, inserted(problem, [[], []]))
    assert sorted(name for route in routes for name in route) == ["a", "b", "c", "c"]
