"""What rules come to as primitives, and what is left of that where they are ignored."""

import math

from muster import Mission, Robot, Task
from muster.mission.model import Lag, TeamPart
from muster.model.problem import Problem

MISSION = Mission(
    robots=(
        Robot(id="a", position=(0, 0), type="arm", abilities={"lift": 3}, available_until_s=90),
        Robot(id="b", position=(1, 0), skills=("camera",), abilities={"lift": 2}),
        Robot(id="c", position=(1, 0), kind="air"),
    ),
    tasks=(
        Task(id="1", position=(0, 0), window_s=((1, 2), (5, None)), deadline_s=9, due_s=4),
        Task(id="2", position=(0, 0), prerequisites=("1",), lags={"1": Lag(after_s=2)}, robots_needed=2),
        Task(id="3", position=(0, 0), starts_with=("4",), team=(TeamPart(count=2), TeamPart(requires=("camera",)))),
        Task(id="4", position=(0, 0), needs={"lift": 4}, other_robot_than=("1",)),
        Task(id="5", position=(0, 0), same_robot_as=("2",)),
    ),
)


def model(*ignored):
    return Problem.compile(MISSION, ignored=ignored).model


def test_times():
    some = model()
    assert some.openings == [[(1, 2), (5, math.inf)], [], [], [], []]
    assert (some.ends_by[0], some.due[0], some.over_by.tolist()) == (9, 4, [90, math.inf, math.inf])
    assert some.gaps(1) == [(0, 2, math.inf)]
    assert Problem.compile(MISSION).has_timed_rules


def test_teams():
    some = model()
    assert [some.is_for_team(j) for j in range(5)] == [False, True, True, True, False]
    assert [some.least_members(j) for j in range(5)] == [1, 2, 3, 2, 1]
    assert [(count, fits.tolist()) for count, fits in some.seats(2)] == [(2, [True] * 3), (1, [False, True, False])]
    assert {name: (least, able.tolist()) for name, (least, able) in some.sums(3).items()} == {"lift": (4, [3, 2, 0])}


def test_relations():
    some = model()
    assert some.units == [[0], [1], [2, 3], [4]]
    assert some.unit == [0, 1, 2, 2, 3]
    assert (some.same_crew, some.apart) == ([[], [4], [], [], [1]], [[3], [], [], [0], []])


def test_what_is_ignored_does_not_bind():
    assert not any(model("window").openings)
    assert model("deadline").ends_by[0] == model("shift").over_by[0] == math.inf
    assert model("deadline").due[0] == 4
    assert [model("team").least_members(j) for j in range(5)] == [1] * 5
    assert len(model("relation").units) == 5
    assert model("prerequisite").gaps(1) == []
    words = ("window", "deadline", "shift", "team", "relation", "prerequisite")
    assert not Problem.compile(MISSION, ignored=words).has_timed_rules


def test_what_asks_for_more_is_named_by_the_key_of_its_rule():
    tasks = (
        Task(id="a", position=(0, 0), load=1, robots_needed=1),
        Task(id="b", position=(0, 0), load=2, delivers="a", longest_aboard_s=9),
        Task(id="c", position=(0, 0), prerequisites=("a",)),
        Task(id="d", position=(0, 0), starts_with=("e",)),
        Task(id="e", position=(0, 0), other_robot_than=("a",)),
    )
    robots = (Robot(id="r", position=(0, 0), min_tasks=1), Robot(id="s", position=(0, 0), min_tasks=2))
    assert Problem.compile(Mission(robots=robots, tasks=tasks)).asked == {
        "load": "task a: load",
        "lag": "task b: longest_aboard_s",
        "relation": "task e: other_robot_than",
        "starts-with": "task d: starts_with",
        "min-tasks": "robot s: min_tasks",
    }
