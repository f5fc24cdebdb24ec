"""Reasons given for tasks left out: true ones pass, false ones are found, by trying all places in a route."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission
from tests.timed_missions.meaning import Meaning
from tests.timed_missions.missions import timed_mission
from tests.timed_missions.places import Places

import muster
from muster.mission.model import Map, Mission, Robot, Rules, Task, TravelTable, Zone
from muster.mission.plan import REASONS, Plan, Reason, Route, Unassigned
from muster.verification import verify
from muster.verification.rules.deadline import Deadline


def with_reason(plan: Plan, task: str, robot: str, word: str) -> Plan:
    """The routes of a plan, with one reason."""
    bare = tuple(Route(route.robot, route.tasks) for route in plan.routes)
    left_out = tuple(Unassigned(item.task, ()) for item in plan.unassigned if item.task != task)
    return Plan(routes=bare, unassigned=(Unassigned(task, (Reason(robot, word, "..."),)), *left_out))


def found(mission: Mission, plan: Plan, ignore=()) -> list[tuple[str, str | None, str | None]]:
    return [(v.kind, v.robot, v.task) for v in verify(mission, plan, ignore).violations]


def kinds_by_place(mission: Mission, plan: Plan, task: str, robot: str, ignore) -> list[set[str]]:
    """For each place in the robot's route the kinds of violations with the task there."""
    routes = {route.robot: route.tasks for route in plan.routes}
    own = routes[robot]
    trials = [routes | {robot: (*own[:k], task, *own[k:])} for k in range(len(own) + 1)]
    plans = [Plan(routes=tuple(Route(r, tasks) for r, tasks in trial.items())) for trial in trials]
    return [{violation.kind for violation in verify(mission, trial, ignore).violations} for trial in plans]


def is_true(word: str, places: list[set[str]]) -> bool:
    if word == "not-chosen":
        return any(not kinds for kinds in places)
    places = [kinds for kinds in places if word == "prerequisite" or "deadlock" not in kinds]
    if word == "capacity":  # where there is no way the usage is infinite
        return all(kinds & {"capacity", "unreachable"} for kinds in places)
    return all(word in kinds for kinds in places)


@given(
    seed=st.integers(0, 10**6),
    robots=st.integers(1, 3),
    word=st.sampled_from(REASONS),
    ignore=st.sets(st.sampled_from(["skill", "capacity", "suitability", "prerequisite"])),
    late=st.booleans(),
)
def test_a_reason_is_a_violation_if_and_only_if_it_is_false(seed, robots, word, ignore, late):
    mission = random_mission(seed, tasks=9, robots=robots)
    if late:
        mission = replace(mission, rules=replace(mission.rules, usage="time"))
    plan = muster.solve(mission, "greedy", ignore=ignore)
    for item in plan.unassigned[:3]:
        for robot in mission.robots:
            places = kinds_by_place(mission, plan, item.task, robot.id, ignore)
            said = found(mission, with_reason(plan, item.task, robot.id, word), ignore)
            assert said == ([] if is_true(word, places) else [("reason", robot.id, item.task)]), (word, places)


LEFT_OUT = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("near", ()), Unassigned("far", ())))


def test_a_robot_with_room_cannot_lack_capacity():
    mission = Mission(
        robots=(Robot(id="r", position=(0, 0), work_capacity=10),),
        tasks=(Task(id="near", position=(4, 0)), Task(id="far", position=(40, 0))),
    )
    for name, word, is_false in (("near", "capacity", True), ("far", "capacity", False), ("far", "not-chosen", True)):
        plan = with_reason(LEFT_OUT, name, "r", word)
        assert found(mission, plan) == ([("reason", "r", name)] if is_false else [])


@pytest.mark.parametrize(("word", "is_false"), [("unreachable", False), ("not-chosen", True), ("capacity", True)])
def test_a_task_behind_a_wall(word, is_false):
    pytest.importorskip("shapely")
    wall = Zone(polygon=((4, -1), (5, -1), (5, 11), (4, 11)))
    mission = Mission(
        map=Map(boundary=((0, 0), (10, 0), (10, 10), (0, 10)), zones=(wall,)),
        robots=(Robot(id="r", position=(1, 1)),),
        tasks=(Task(id="beyond", position=(8, 8)),),
    )
    plan = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("beyond", (Reason("r", word, "..."),)),))
    assert found(mission, plan) == ([("reason", "r", "beyond")] if is_false else [])


@pytest.mark.parametrize(("capacity", "word"), [(10.9, "capacity"), (11.1, "not-chosen")])
def test_over_a_map_the_way_around_counts(capacity, word):
    pytest.importorskip("shapely")
    """By (4, 5) and (5, 5) it is 5 + 1 + 5 m, straight 7 m."""
    zone = Zone(polygon=((4, 0), (5, 0), (5, 5), (4, 5)))
    mission = Mission(
        map=Map(boundary=((0, 0), (10, 0), (10, 10), (0, 10)), zones=(zone,)),
        robots=(Robot(id="r", position=(1, 1), work_capacity=capacity),),
        tasks=(Task(id="beyond", position=(8, 1)),),
    )
    for said in ("capacity", "not-chosen"):
        plan = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("beyond", (Reason("r", said, "..."),)),))
        assert found(mission, plan) == ([] if said == word else [("reason", "r", "beyond")])


def test_travel_tables_are_looked_up_in_every_gap():
    places = ("r", "a", "b")
    metres = ((0, 1, 9), (1, 0, 9), (9, 2, 0))  # b is far from everything; a is near it on the way back only
    mission = Mission(
        rules=Rules(travel="matrix"),
        robots=(Robot(id="r", position=(0, 0), type="t", work_capacity=11.5),),
        tasks=(Task(id="a", position=(1, 0)), Task(id="b", position=(2, 0))),
        travel={"t": "t.csv"},
        travel_tables={"t": TravelTable(places=places, metres=metres)},
    )
    for word in ("capacity", "not-chosen"):
        plan = Plan(routes=(Route("r", ("a",)),), unassigned=(Unassigned("b", (Reason("r", word, "..."),)),))
        assert found(mission, plan) == ([("reason", "r", "b")] if word == "capacity" else [])


def test_reasons_name_robots_of_the_mission_and_known_words():
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=(Task(id="a", position=(1, 0)),))
    for reason, is_false in (
        (("x", "lock"), True),
        (("r", "tired"), True),
        (("r", "not-chosen"), False),
        (("", "lock"), False),
    ):
        plan = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("a", (Reason(*reason, "..."),)),))
        assert found(mission, plan) == ([("reason", reason[0], "a")] if is_false else [])


# --- with rules of time, teams and relations --------------------------------------------------------------------------


def reasons_judged(seed):
    """For each task left out, robot and word: whether it is true, whether the robot could do it, and the verdict."""
    mission = timed_mission(seed)
    number = Meaning(mission).number
    plan = muster.solve(mission, "greedy", seed=seed)
    by_robot = {route.robot: tuple(number[name] for name in route.tasks) for route in plan.routes}
    routes = tuple(by_robot[robot.id] for robot in mission.robots)
    for item in plan.unassigned:
        for i, robot in enumerate(mission.robots):
            places = Places(mission, (), routes, i, number[item.task])
            for word in ("not-chosen", "window", "deadline", "shift", "team", "relation", "prerequisite", "capacity"):
                verdict = verify(mission, with_reason(plan, item.task, robot.id, word))
                said_of_it = {"relation": bool(places.all), "team": mission.tasks[places.j].is_for_team}
                yield word, places.is_true(word) and said_of_it.get(word, True), bool(places.left()), verdict


@pytest.mark.parametrize("seed", range(12))
def test_no_true_reason_is_rejected_and_false_ones_are_found(seed):
    for word, is_true, could, verdict in reasons_judged(seed):
        assert not (is_true and not verdict.valid), word
        is_contradicted = could == (word != "not-chosen")
        assert verdict.valid != is_contradicted or verdict.reasons_undecided or (word != "not-chosen" and not could)


@pytest.mark.long
def test_few_reasons_are_left_undecided():
    verdicts = [verdict for seed in range(6) for *_, verdict in reasons_judged(seed)]
    assert sum(verdict.reasons_undecided for verdict in verdicts) <= len(verdicts) / 10


def late(**limits):
    """A robot with nothing to do, and a task that it reaches at 10 s and ends at 15 s."""
    shift = limits.pop("available_until_s", None)
    robot = Robot(id="r", position=(0, 0), available_until_s=shift)
    task = Task(id="a", position=(10, 0), duration_s=5, **limits)
    return Mission(rules=Rules(timing="constant"), robots=(robot,), tasks=(task,))


@pytest.mark.parametrize(
    ("word", "kept", "broken"),
    [
        ("window", {"window_s": ((0, 11),)}, {"window_s": ((0, 9),)}),
        ("deadline", {"deadline_s": 16}, {"deadline_s": 14}),
        ("shift", {"available_until_s": 16}, {"available_until_s": 14}),
    ],
)
def test_a_limit_that_keeps_nobody_out(word, kept, broken):
    plan = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("a", (Reason("r", word, "..."),)),))
    (said,) = verify(late(**kept), plan).violations
    assert said.detail == f"the plan says {word}, but the robot could do it with the rest of the plan as it is"
    assert found(late(**broken), plan) == []
    chosen = with_reason(plan, "a", "r", "not-chosen")
    assert found(late(**kept), chosen) == []
    assert found(late(**broken), chosen) == [("reason", "r", "a")]


@pytest.mark.parametrize("limit", [15 * (1 + 1e-8), 15 * (1 - 1e-8)])
def test_a_limit_that_is_too_close_is_left_undecided_and_counted(limit):
    plan = Plan(routes=(Route("r", ()),), unassigned=(Unassigned("a", (Reason("r", "deadline", "..."),)),))
    for word in ("deadline", "not-chosen"):
        verdict = verify(late(deadline_s=limit), with_reason(plan, "a", "r", word))
        assert (verdict.valid, verdict.reasons_undecided) == (True, 1)


@pytest.mark.parametrize(("robots", "is_false"), [(2, True), (1, False)])
def test_a_team_that_is_there(robots, is_false):
    members = tuple(Robot(id=f"r_{k}", position=(k, 0)) for k in range(robots))
    mission = Mission(robots=members, tasks=(Task(id="a", position=(3, 0), robots_needed=2),))
    routes = tuple(Route(robot.id, ()) for robot in members)
    plan = Plan(routes=routes, unassigned=(Unassigned("a", (Reason("r_0", "team", "..."),)),))
    assert found(mission, plan) == ([("reason", "r_0", "a")] if is_false else [])


def test_what_a_mission_is_subject_to_is_looked_up_once_and_not_for_each_reason(monkeypatch):
    """Else the time to judge a plan that leaves tasks out grows with the square of their number."""
    looked = []
    is_in = Deadline.is_in
    monkeypatch.setattr(Deadline, "is_in", lambda self, mission: looked.append(mission) or is_in(self, mission))
    tasks = [Task(id=f"t{k}", position=(k, 0)) for k in range(30)]
    mission = Mission(robots=[Robot(id="r", position=(0, 0), work_capacity=0)], tasks=tasks)
    plan = muster.solve(mission, "greedy")
    assert len(plan.unassigned) == 29
    looked.clear()
    assert muster.verify(mission, plan).valid
    assert len(looked) <= 2
