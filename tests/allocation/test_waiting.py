"""Expected waiting: a cost of ways in time and in usage, the same for the core and for Python."""

from dataclasses import replace

import numpy as np
import pytest

from muster import core
from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_of
from muster.allocation.stop import Stop
from muster.mission.model import Mission, Robot, Rules, Task
from muster.model.problem import Problem
from muster.model.waiting import NO_WAITING, Waiting


def problem_of(usage="distance", objective="total", speed=2.0):
    tasks = tuple(Task(id=f"t{j}", position=(float(x), 0.0)) for j, x in enumerate((4, 8, -4)))
    robots = tuple(Robot(id=f"r{i}", position=(0.0, 0.0), speed_mps=speed) for i in range(2))
    return Problem.compile(
        Mission(name="line", robots=robots, tasks=tasks, rules=Rules(usage=usage, objective=objective))
    )


def waiting(problem, into, seconds, robots=(True, True)):
    places = len(problem.tasks) + 2 * len(problem.robots)
    table = np.zeros((places, places))
    table[:, into] = seconds
    return replace(problem, waiting=Waiting(table, np.array(robots)))


@pytest.mark.parametrize(("usage", "more"), [("distance", 6.0), ("time", 3.0)])
def test_ways_take_longer_and_cost_what_the_robot_would_travel(usage, more):
    problem = problem_of(usage)
    congested = waiting(problem, 0, 3.0, robots=(True, False))
    routes = [[0, 1], []]
    assert congested.value(routes)[1] == pytest.approx(problem.value(routes)[1] + more)
    assert congested.value(routes[::-1]) == problem.value(routes[::-1])
    stops = core.Inspection(congested.core, routes).stops
    assert stops[0][0][1] == pytest.approx(2.0 + 3.0)
    assert congested.legs(0, [3], [0, 1])[0] == pytest.approx(problem.legs(0, [3], [0, 1])[0] + [more, 0.0])
    assert congested.travel_seconds(0, [3], [0])[0, 0] == pytest.approx(5.0)


def test_a_search_spreads_routes_by_it():
    """One robot would go through t0 to t1 at no cost; if going there costs more than a way round, another does."""
    problem = problem_of(objective="total+max")
    search = allocator_of("search")

    def routes(asked):
        plan = search.solve(asked, Stop(iterations=300), seed=1, params=make_parameters(search, {}))
        return {route.tasks for route in plan.routes}

    assert routes(problem) == {("t0", "t1"), ("t2",)}
    places = len(problem.tasks) + 2 * len(problem.robots)
    table = np.zeros((places, places))
    table[2, :] = table[:, 2] = 1.0
    table[0, 1] = 50.0
    assert ("t0", "t1") not in routes(replace(problem, waiting=Waiting(table, np.array([True, True]))))


def test_a_part_waits_as_the_whole():
    congested = waiting(problem_of(), 1, 3.0, robots=(False, True))
    part = congested.part([1], [1, 2])
    assert part.legs(0, [part.start(0)], [0, 1]) == pytest.approx(congested.legs(1, [congested.start(1)], [1, 2]))
    assert problem_of().part([0], [0]).waiting is NO_WAITING
