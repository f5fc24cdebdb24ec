"""Tasks that can never be done, of few robots and of many: one by one, without a table of all pairs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.allocation.bounds import feasibility
from muster.allocation.bounds.feasibility import impossible, limits_of
from muster.allocation.remedies import conflicts
from muster.allocation.remedies.conflicts import Together, together
from muster.mission.model import Mission, Robot, Rules, Task
from muster.model.problem import Problem


@st.composite
def missions(draw):
    place = st.tuples(st.integers(-9, 9), st.integers(-9, 9))
    robots = [
        Robot(
            id=f"r{k}",
            position=draw(place),
            work_capacity=draw(st.none() | st.integers(0, 20)),
            skills=draw(st.sampled_from([(), ("dig",)])),
            end_position=draw(st.none() | place),
        )
        for k in range(draw(st.integers(1, 4)))
    ]
    tasks = [
        Task(
            id=f"t{k}",
            position=draw(place),
            exit=draw(st.none() | place),
            actuation_cost=draw(st.integers(0, 5)),
            requires=draw(st.sampled_from([(), (), ("dig",)])),
            prerequisites=[f"t{k - 1}"] if k and draw(st.booleans()) else [],
        )
        for k in range(draw(st.integers(1, 6)))
    ]
    return Mission(robots=robots, tasks=tasks, rules=Rules(return_to_start=draw(st.booleans())))


def waiting_for(mission, lost):
    """The tasks, and all that wait for them."""
    for task in mission.tasks:  # each after its prerequisite
        if lost.intersection(task.prerequisites):
            lost = lost | {task.id}
    return lost


@given(missions())
def test_they_are_those_of_the_table_of_all_pairs(mission):
    problem = Problem.compile(mission)
    none_can = np.flatnonzero(~limits_of(problem).usable.any(axis=0)).tolist()
    expected = waiting_for(mission, {problem.tasks[j].id for j in none_can})
    found = impossible(problem)
    assert {item.task for item in found} == expected
    assert all(len(item.reasons) == len(mission.robots) for item in found)


@pytest.fixture
def city():
    """200 robots, of which each reaches the 20 tasks around it, and 2,000 tasks, of which the last is too far."""
    robots = [Robot(id=f"r{k}", position=(100 * k, 0), work_capacity=100) for k in range(200)]
    tasks = [Task(id=f"t{k}", position=(10 * k, 0)) for k in range(1_999)]
    return Problem.compile(Mission(robots=robots, tasks=[*tasks, Task(id="far", position=(0, 9_999))]))


def test_of_a_city_no_table_of_all_pairs_is_made(city, monkeypatch):
    monkeypatch.setattr(feasibility, "limits_of", None)
    looked_at = []
    legs = Problem.legs
    monkeypatch.setattr(
        Problem,
        "legs",
        lambda self, i, places, to: looked_at.append(len(places) * len(to)) or legs(self, i, places, to),
    )
    (far,) = impossible(city)
    assert far.task == "far"
    assert {reason.reason for reason in far.reasons} == {"capacity"}
    assert sum(looked_at) < 200 * 2_000 * 0.6


def test_a_search_that_cannot_end_in_time_is_not_begun(city, monkeypatch):
    monkeypatch.setattr(conflicts, "attempt", None)
    assert together(city, None, time_limit=0.1) == Together(unknown=True)
