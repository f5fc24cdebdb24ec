"""Missions on which robots cannot agree without a centre are refused by name, wherever a user can ask for one."""

from dataclasses import replace

import pytest

from muster import Event, Mission, Negotiation, Robot, Rules, Task, simulate
from muster.allocation.auctions.auction import AUCTION
from muster.allocation.capabilities import those_that_can
from muster.mission.errors import ParameterError
from muster.mission.model import Battery, Lag, TeamPart
from muster.model.problem import Problem
from muster_team.auctions.capabilities import refuse_mission, refuse_what_is_not_agreed
from muster_team.negotiators.methods import METHODS

ROBOTS = tuple(Robot(id=name, position=(5.0 * k, 0.0), radius_m=0.3) for k, name in enumerate("ab"))
PLAIN = Mission(robots=ROBOTS, tasks=(Task(id="s", position=(1.0, 5.0)), Task(id="t", position=(9.0, 5.0))))


def word_of(where):
    return where[where.rindex("(") + 1 : -1]


def with_task(**keys):
    return replace(PLAIN, tasks=(PLAIN.tasks[0], replace(PLAIN.tasks[1], **keys)))


REFUSED = {
    "task t: window_s (window)": with_task(window_s=((50.0, 90.0),)),
    "task t: deadline_s (deadline)": with_task(deadline_s=90.0),
    "robot b: available_until_s (shift)": replace(
        PLAIN, robots=(ROBOTS[0], replace(ROBOTS[1], available_until_s=80.0))
    ),
    "task t: prerequisites with after_s or within_s (lag)": with_task(
        prerequisites=("s",), lags={"s": Lag(after_s=5.0)}
    ),
    "task t: robots_needed (team)": with_task(robots_needed=2),
    "task t: team (team)": with_task(team=(TeamPart(count=2),)),
    "task t: same_robot_as (relation)": with_task(same_robot_as=("s",)),
    "task t: other_robot_than (relation)": with_task(other_robot_than=("s",)),
    "starts_with (starts-with)": with_task(starts_with=("s",)),
    "objective lateness (lateness)": replace(with_task(due_s=20.0), rules=Rules(objective="lateness")),
}


CASES = [("consensus-bundle", where) for where in REFUSED]


def test_the_auction_agrees_on_what_the_central_one_keeps_but_goods_and_batteries_and_bundles_on_none():
    assert METHODS["auction"].can == AUCTION.can - {"load", "battery", "rests", "duty", "either-or"}
    assert METHODS["consensus-bundle"].can == set()


@pytest.mark.parametrize("where", REFUSED)
def test_the_error_names_the_key_and_what_can(where):
    with pytest.raises(ParameterError) as refused:
        refuse_mission(REFUSED[where], METHODS["consensus-bundle"].can)
    able = " or ".join(those_that_can([word_of(where)]))
    assert f"{where}; expected the method auction or a plan of {able}" in str(refused.value)


@pytest.mark.parametrize("where", REFUSED)
def test_what_the_auction_agrees_on_is_carried_out(where):
    refuse_what_is_not_agreed(Problem.compile(REFUSED[where]), METHODS["auction"].can)
    refuse_mission(REFUSED[where], METHODS["auction"].can)


@pytest.mark.parametrize("keys", [{"robots_needed": 2}, {"starts_with": ("s",)}])
def test_what_several_begin_may_be_begun_again(keys):
    mission = with_task(**keys, across_partition="at-most-once")
    with pytest.raises(ParameterError, match="at-most-once of t; expected at-least-once for tasks that several robots"):
        refuse_mission(mission, METHODS["auction"].can)


@pytest.mark.parametrize(("method", "where"), CASES)
def test_the_package_refuses_before_a_record_is_begun(method, where, tmp_path):
    with pytest.raises(ParameterError, match="without a centre"):
        simulate(REFUSED[where], Negotiation(method=method), record=tmp_path / "run.mcap")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("where", REFUSED)
def test_no_robot_takes_part_in_what_its_method_does_not_agree_on(where):
    chosen = METHODS["consensus-bundle"]
    problem = Problem.compile(REFUSED[where]).ready()
    with pytest.raises(ParameterError, match="without a centre"):
        chosen.negotiator(problem, chosen.allocator.parameters(), "a", incarnation=1)


def test_robots_and_tasks_of_events_are_looked_at():
    late = Event(at_s=5.0, new_task=Task(id="u", position=(3.0, 3.0), deadline_s=60.0))
    joins = Event(at_s=5.0, robot_joins=Robot(id="c", position=(3.0, 3.0), available_until_s=60.0))
    none = METHODS["consensus-bundle"].can
    with pytest.raises(ParameterError, match="task u: deadline_s"):
        refuse_mission(replace(PLAIN, events=(late,)), none)
    with pytest.raises(ParameterError, match="robot c: available_until_s"):
        refuse_mission(replace(PLAIN, events=(joins,)), none)
    refuse_mission(replace(PLAIN, events=(late, joins)), METHODS["auction"].can)


def test_a_bid_rule_that_sees_no_times_is_refused_with_them():
    chosen = METHODS["auction"]
    terms = chosen.allocator.parameters(bid="average-as-printed")
    with pytest.raises(ParameterError, match="average-as-printed, with times"):
        chosen.negotiator(Problem.compile(with_task(deadline_s=90.0)).ready(), terms, "a", incarnation=1)
    robot = chosen.negotiator(Problem.compile(PLAIN).ready(), terms, "a", incarnation=1)
    with pytest.raises(ParameterError, match="average-as-printed, with times"):
        robot.announce(Task(id="u", position=(3.0, 3.0), deadline_s=20.0))


@pytest.mark.parametrize(
    ("keys", "named"),
    [({"robots_needed": 2}, "task u: robots_needed"), ({"window_s": ((10.0, 20.0),)}, "task u: window_s")],
)
def test_a_robot_does_not_announce_a_task_on_which_they_cannot_agree(keys, named):
    chosen = METHODS["consensus-bundle"]
    robot = chosen.negotiator(Problem.compile(PLAIN).ready(), chosen.allocator.parameters(), "a", incarnation=1)
    before = list(robot.facts)
    with pytest.raises(ParameterError, match=named):
        robot.announce(Task(id="u", position=(3.0, 3.0), **keys))
    assert list(robot.facts) == before
    robot.announce(Task(id="u", position=(3.0, 3.0)))
    assert len(list(robot.facts)) == len(before) + 1


def test_plain_missions_due_times_and_ignored_rules_are_accepted():
    none = METHODS["consensus-bundle"].can
    refuse_mission(PLAIN, none)
    refuse_mission(with_task(due_s=20.0), none)
    refuse_mission(with_task(prerequisites=("s",)), none)
    for ignored, keys in {"window": {"window_s": ((5.0, 9.0),)}, "team": {"robots_needed": 2}}.items():
        refuse_what_is_not_agreed(Problem.compile(with_task(**keys), None, (ignored,)), none)


@pytest.mark.parametrize(
    ("of_robot", "of_task", "why"), [({"battery": Battery(capacity=9)}, {}, "battery"), ({}, {"load": 1}, "load")]
)
def test_missions_with_goods_or_batteries_are_not_carried_out_without_a_centre(of_robot, of_task, why):
    robots, tasks = (Robot(id="r", position=(0, 0), **of_robot),), (Task(id="t", position=(1, 0), **of_task),)
    with pytest.raises(ParameterError, match=rf"cannot agree on .*\({why}\)"):
        refuse_mission(Mission(robots=robots, tasks=tasks), frozenset())
