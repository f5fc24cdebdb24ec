"""Tasks impossible by times, teams and relations, alone or together: examples, and all plans of small missions."""

from itertools import combinations

import pytest
from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning
from tests.timed_missions.missions import ignored_in, timed_mission

from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.usage_bounds import UsageBounds
from muster.allocation.remedies.conflict_texts import conflict_text
from muster.mission.model import Lag, Mission, Robot, Task, TeamPart
from muster.model.problem import Problem

MOST_PLANS = 3000


def robot(name="r_0", x=0.0, **keys):
    return Robot(id=name, position=(x, 0), **keys)


def task(name, x, **keys):
    return Task(id=name, position=(x, 0), **keys)


def compiled(robots, *tasks, ignored=(), **keys):
    return Problem.compile(Mission(robots=tuple(robots), tasks=tasks, **keys), ignored=ignored)


def why(robots, *tasks, ignored=(), **keys):
    """By task and robot the reason and its detail."""
    found = impossible(compiled(robots, *tasks, ignored=ignored, **keys))
    return {(item.task, r.robot): (r.reason, r.detail) for item in found for r in item.reasons}


def test_a_window_that_closes_before_the_robot_arrives():
    late = task("a", 640, window_s=((0, 600),))
    said = "arrives at 640 s at the earliest, its window closes at 600 s"
    assert why([robot()], late) == {("a", "r_0"): ("window", said)}
    assert why([robot()], late, ignored=("window",)) == {}
    assert why([robot(), robot("r_1", x=50)], late) == {}


def test_a_window_that_closes_before_a_prerequisite_and_its_lag_are_over():
    first = task("a", 10, window_s=((1000, None),), duration_s=200)
    then = task("b", 10, prerequisites=("a",), lags={"a": Lag(after_s=60)}, window_s=((0, 1200),))
    said = "begins after a, at 1,260 s at the earliest, its window closes at 1,200 s"
    assert why([robot()], first, then) == {("b", "r_0"): ("window", said)}


def test_the_time_of_day_stands_beside_the_seconds():
    found = why([robot()], task("a", 700, window_s=((0, 600),)), starts_at="2027-03-01T08:00:00")
    assert found["a", "r_0"][1] == (
        "arrives at 700 s (08:11:40) at the earliest, its window closes at 600 s (08:10:00)"
    )


def test_a_deadline_and_a_shift_that_are_too_early():
    found = why([robot(available_until_s=50)], task("a", 60), task("b", 40, deadline_s=30))
    assert found["a", "r_0"] == ("shift", "its route would end at 60 s at the earliest, its shift ends at 50 s")
    assert found["b", "r_0"] == ("deadline", "ends at 40 s at the earliest, its deadline is 30 s")


def test_teams_that_nobody_can_form():
    able = [robot(skills=("gripper",), type="x", abilities={"lift_kg": 20}), robot("r_1", type="y")]
    two = why(able, task("a", 5, robots_needed=2, requires=("gripper",)))
    assert two["a", "r_0"] == ("team", "needs 2 robots with gripper; r_0 alone can be there")
    assert two["a", "r_1"] == ("skill", "lacks gripper")
    parts = why(able, task("a", 5, team=(TeamPart(count=2, type="x"), TeamPart(type="y"))))
    assert parts["a", "r_0"][0] == "team"
    needs = why(able, task("a", 5, needs={"lift_kg": 35}))
    assert needs["a", "r_0"] == ("team", "needs lift_kg 35; all who can be there have lift_kg 20 together")
    assert why(able, task("a", 5, needs={"lift_kg": 35}), ignored=("team",)) == {}


def test_a_team_is_there_when_its_last_member_is():
    found = why([robot(), robot("r_1", x=100)], task("a", 6, robots_needed=2, window_s=((0, 50),)))
    assert found["a", "r_0"][1] == "its team is there at 94 s at the earliest, its window closes at 50 s"
    assert found["a", "r_1"][1] == "arrives at 94 s at the earliest, its window closes at 50 s"


@pytest.mark.parametrize(
    ("limit", "word", "said"),
    [
        ({"deadline_s": 50}, "deadline", "what it waits for is too late for its deadline, which is 50 s"),
        ({"window_s": ((0, 50),)}, "window", "what it waits for is too late for its window, which closes at 50 s"),
    ],
)
def test_no_time_is_named_that_only_the_limit_itself_makes_so_late(limit, word, said):
    """By the limit far cannot lift, so it must light, from 100 s on; without the limit the team is there at 90 s."""
    robots = [robot(), robot("r_1"), robot("far", x=100)]
    found = why(robots, task("lift", 10, robots_needed=2, **limit), task("light", 0, starts_with=("lift",)))
    assert found["lift", "r_0"] == found["lift", "r_1"] == (word, said)
    assert "90 s" in found["lift", "far"][1]


def test_a_lag_that_would_hold_a_prerequisite_back_for_too_long():
    first = task("a", 10, deadline_s=100)
    then = task("b", 10, prerequisites=("a",), lags={"a": Lag(within_s=60)}, window_s=((500, 600),))
    found = why([robot()], first, then)
    assert set(found) == {("b", "r_0")}
    assert found["b", "r_0"][0] == "prerequisite"


def test_a_load_that_would_be_on_board_for_too_long():
    """The rule that says how long is named, not the order of the two tasks."""
    take, bring = task("take", 1, load=1), task("bring", 30, delivers="take", longest_aboard_s=10)
    found = why([robot(load_capacity=1)], take, bring)
    assert found["bring", "r_0"][0] == "aboard"
    assert found["bring", "r_0"][1].startswith("begins at most 10 s after take ends")


def test_relations_that_no_robots_keep():
    gripping, filming = robot(skills=("g",)), robot("r_1", skills=("f",))
    a, b = task("a", 6, requires=("g",)), task("b", 6, requires=("f",), same_robot_as=("a",), prerequisites=("a",))
    assert why([gripping, filming], a, b)["b", "r_1"][0] == "relation"
    together = task("b", 6, requires=("g",), starts_with=("a",))
    found = why([gripping, filming], a, together)
    assert {found["a", "r_0"][0], found["b", "r_0"][0]} == {"relation"}


def test_two_tasks_too_far_apart_for_the_only_robot():
    problem = compiled([robot()], task("a", 100, deadline_s=120), task("b", -100, deadline_s=120))
    bounds = UsageBounds(problem)
    assert bounds.forbid([0, 1])
    assert conflict_text(bounds, [0], [0, 1]) == (
        "only r_0 can do them: with a first, b ends at 300 s at the earliest, its deadline is 120 s; "
        "with b first, a ends at 300 s at the earliest, its deadline is 120 s"
    )
    assert not UsageBounds(compiled([robot(), robot("r_1")], *problem.tasks)).forbid([0, 1])


@pytest.mark.long(keep=10)
@pytest.mark.parametrize("seed", range(30))
def test_no_plan_does_what_is_said_to_be_impossible(seed):
    """Of tasks alone and of pairs of tasks, beside every plan of small missions."""
    mission, ignored = timed_mission(seed), ignored_in(seed)
    every = EveryPlan(Meaning(mission, ignored=ignored), MOST_PLANS)
    assert every.complete, "not all plans were looked at"
    done = every.done()
    problem = Problem.compile(mission, ignored=ignored)
    number = {one.id: j for j, one in enumerate(mission.tasks)}
    lost = {number[item.task] for item in impossible(problem)}
    assert not lost & frozenset().union(*done)
    bounds = UsageBounds(problem)
    for pair in combinations(range(len(problem.tasks)), 2):
        if bounds.forbid(pair):
            names = {number[problem.tasks[j].id] for j in pair}
            assert not any(names <= tasks for tasks in done)
