"""Parts of a problem: what they have of the mission, and that they can be sent."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster import core
from muster.generation.uniform import large_mission
from muster.library import mission_names, mission_path
from muster.mission.model import Mission, Robot, Rules, Task, TravelTable
from muster.model.problem import Problem


def sent(problem):
    return pickle.loads(pickle.dumps(problem))


def figures(problem, routes):
    inspection = core.Inspection(problem.core, routes)
    return inspection.usages, inspection.objective, inspection.makespan, inspection.admissible


@given(seed=st.integers(0, 10**6))
def test_a_problem_that_was_sent_is_the_same(seed):
    problem = Problem.compile(random_mission(seed, tasks=8, robots=3)).ready()
    arrived = sent(problem)
    assert (arrived.mission, arrived.robots, arrived.tasks) == (problem.mission, problem.robots, problem.tasks)
    routes = [list(range(8)), [], []]
    assert figures(arrived, routes) == figures(problem, routes)


@pytest.mark.parametrize("name", mission_names())
def test_shipped_missions_can_be_sent(name):
    salesmen = 3 if mission_path(name).suffix == ".tsp" else None
    problem = Problem.compile(muster.load(name, salesmen=salesmen))
    assert sent(problem).mission == problem.mission


@given(seed=st.integers(0, 10**6), data=st.data())
def test_a_part_answers_as_the_whole_does(seed, data):
    problem = Problem.compile(random_mission(seed, tasks=10, robots=4))
    robots = sorted(data.draw(st.sets(st.integers(0, 3), min_size=1)))
    tasks = [j for j in range(10) if not problem.prerequisites[j] and not problem.dependants[j]]
    part = sent(problem.part(robots, tasks))
    assert [robot.id for robot in part.mission.robots] == [problem.robots[i].id for i in robots]
    assert np.array_equal(part.allowed, problem.allowed[np.ix_(robots, tasks)])
    assert np.array_equal(part.capacity, problem.capacity[robots])
    whole_routes = [tasks if i == robots[0] else [] for i in range(4)]
    part_routes = [list(range(len(tasks))) if i == robots[0] else [] for i in robots]
    assert figures(part, part_routes)[0] == [figures(problem, whole_routes)[0][i] for i in robots]


def test_a_part_has_the_rows_of_its_own_places():
    """Of travel tables, as of the locks that name robots of other parts."""
    names = ("a", "b", "1", "2", "3")
    metres = tuple(tuple(float(10 * r + c) for c in range(5)) for r in range(5))
    mission = Mission(
        rules=Rules(travel="matrix"),
        travel={"t": "t.csv", "u": "u.csv"},
        travel_tables={"t": TravelTable(names, metres), "u": TravelTable(names, metres)},
        robots=(Robot(id="a", type="t", position=(0, 0)), Robot(id="b", type="u", position=(0, 0))),
        tasks=tuple(Task(id=name, position=(0, 0), only_robots=("a",)) for name in "123"),
    )
    problem = Problem.compile(mission)
    part = sent(problem.part([1], [0, 2]))
    assert part.mission.travel_tables == {"u": TravelTable(("b", "1", "3"), ((11, 12, 14), (21, 22, 24), (41, 42, 44)))}
    assert not part.allowed.any()
    own = sent(problem.part([0], [0, 2]))
    assert own.allowed.all()
    assert figures(own, [[0, 1]])[0] == figures(problem, [[0, 2], []])[0][:1]


def test_a_part_does_not_grow_with_the_mission():
    small, large = (Problem.compile(large_mission(tasks, 40)) for tasks in (400, 4_000))
    sizes = [len(pickle.dumps(problem.part(range(10), range(100)))) for problem in (small, large)]
    assert max(sizes) < 1.1 * min(sizes)
    assert max(sizes) < 200 * 100
