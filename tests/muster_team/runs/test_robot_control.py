"""Robots that decide for themselves do all that can be done, once, whatever happens to them and to their network."""

from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.runs.simulated_team import SimulatedTeam

from muster import Event, Mission, Robot, Task
from muster.mission.model import Lag, MovedTask
from muster.state import OtherEvent
from muster_team.knowledge.messages import Fact, Message, Stage
from muster_team.knowledge.new_tasks import content_of
from muster_team.negotiators.participation import plan_of

LONG_S = 600.0


def square(seed=0, robots=4, tasks=10, **of_robots):
    random = Random(seed)

    def place():
        return random.uniform(0, 40), random.uniform(0, 40)

    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=place(), speed_mps=2.0, **of_robots) for k in range(robots)),
        tasks=tuple(
            Task(
                id=str(k),
                position=place(),
                duration_s=random.choice((0.0, 3.0)),
                prerequisites=(str(random.randrange(k)),) if k > 4 and random.random() < 0.4 else (),
                across_partition=random.choice(("at-most-once", "at-least-once")),
            )
            for k in range(tasks)
        ),
    )


def ends(team):
    """All rest in time; how often each task was done."""
    assert team.run(team.world.time_s + LONG_S, lambda: team.rests)
    return team.times("ends")


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", range(4))
def test_without_faults_every_task_is_done_once_after_what_it_waits_for(seed):
    mission = square(seed)
    team = SimulatedTeam(mission, seed=seed, delay_s=0.02)
    assert ends(team) == {task.id: 1 for task in mission.tasks}
    ended = {data["task"]: at_s for at_s, _, kind, data in team.told if kind == "ends"}
    began = {data["task"]: at_s for at_s, _, kind, data in team.told if kind == "starts"}
    assert all(ended[before] <= began[task.id] for task in mission.tasks for before in task.prerequisites)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(12))
def test_while_robots_hear_each_other_nothing_is_done_twice_whoever_crashes(seed):
    mission, random = square(seed), Random(seed)
    team = SimulatedTeam(mission, seed=seed, loss=0.3, delay_s=0.05, jitter_s=0.05, duplication=0.1)
    victims = random.sample(team.robots, 2)
    team.run(random.uniform(1, 20))
    team.crash(victims[0])
    team.run(team.world.time_s + random.uniform(0, 10))
    team.crash(victims[1])
    team.run(team.world.time_s + random.uniform(0, 10))
    team.restart(victims[0])
    done = ends(team)
    lately = {data["task"] for _, _, kind, data in team.last_words if kind == "ends"}  # nobody else may know
    assert {task for task, times in done.items() if times > 1} <= lately
    facts = next(iter(team.net.nodes.values())).facts
    held = {fact.task for fact in facts if fact.kind == "begun" and fact.robot == victims[1]} - set(done)
    waiting = held.copy()  # what the one that stays away said it begins, nobody may; nor what waits for it
    while more := {t.id for t in mission.tasks if waiting.intersection(t.prerequisites)} - waiting:
        waiting |= more
    assert set(done) >= {task.id for task in mission.tasks} - waiting


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(8))
def test_across_a_cut_only_tasks_that_allow_it_are_done_twice(seed):
    mission, random = square(seed, robots=5), Random(seed)
    team = SimulatedTeam(mission, seed=seed, delay_s=0.02)
    team.run(random.uniform(1, 10))
    side = random.sample(team.robots, 2)
    team.net.cut(side, [robot for robot in team.robots if robot not in side])
    team.run(team.world.time_s + 15.0)
    team.net.heal()
    done = ends(team)
    assert set(done) == {task.id for task in mission.tasks}
    for task in mission.tasks:
        begun = {robot for _, robot, kind, data in team.told if kind == "starts" and data["task"] == task.id}
        assert len(begun) == 1 or task.across_partition == "at-least-once"
    twice = {task for task, times in done.items() if times > 1}
    assert all(twice <= set(node.twice) for node in team.net.nodes.values())


def test_a_new_task_goes_to_whom_it_suits_best_and_is_done():
    mission = square()
    team = SimulatedTeam(mission)
    team.run(5.0)
    where = team.world.ports["r_2"].telemetry().position
    team.controls["r_0"].take_event(Event(at_s=0, new_task=Task(id="new", position=where[:2])))
    assert ends(team)["new"] == 1


def test_a_task_that_moves_is_done_where_it_is_then():
    mission = Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(Task(id="t", position=(20, 0)),))
    team = SimulatedTeam(mission)
    team.run(5.0)
    team.controls["a"].take_event(Event(at_s=0, move_task=MovedTask(task="t", position=(0, 20))))
    assert ends(team) == {"t": 1}
    assert team.world.ports["a"].telemetry().position == pytest.approx((0, 20, 0), abs=0.05)


def test_a_new_task_that_is_said_once_more_is_not_refused_though_it_has_moved():
    team = SimulatedTeam(square())
    team.run(2.0)
    new = Event(at_s=0, new_task=Task(id="new", position=(5.0, 5.0)))
    move = Event(at_s=0, move_task=MovedTask(task="new", position=(30.0, 5.0)))
    for event in (new, move, new):
        assert team.controls["r_0"].take_event(event) is None
        team.run(team.world.time_s + 1.0)
    assert ends(team)["new"] == 1


def refusals(team):
    return [(robot, d["task"], d["reason"]) for _, robot, kind, d in team.told if kind == "task_refused"]


def hear(team, robot, *facts):
    """One robot hears facts of another; only they got through."""
    node, stage = team.net.nodes[robot], team.net.nodes[robot].stage
    message = Message("r_1", 1, 0, Stage(stage.epoch), facts=facts)
    node.handle(message, team.net.now)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(("kind", "done"), [("cancelled", 0), ("moved", 1)])
def test_what_is_heard_of_a_task_before_it_is_heard_that_there_is_one_holds(kind, done):
    team = SimulatedTeam(square())
    team.run(2.0)
    new, elsewhere = (Task(id="new", position=(x, 5.0)) for x in (5.0, 30.0))
    hear(team, "r_0", Fact("new", "r_1", kind, 2, content_of(elsewhere) if kind == "moved" else b""))
    team.run(4.0)
    hear(team, "r_0", Fact("new", "r_1", "added", 1, content_of(new)))
    assert ends(team)["new"] == done
    if done:
        (robot,) = {robot for _, robot, said, data in team.told if said == "ends" and data["task"] == "new"}
        assert team.controls[robot]._executor.ledger.tasks["new"] == elsewhere


def test_a_new_task_that_is_heard_before_what_it_waits_for_is_done_after_that():
    team = SimulatedTeam(square())
    team.run(2.0)
    first, second = (
        Task(id="first", position=(5.0, 5.0)),
        Task(id="second", position=(6.0, 5.0), prerequisites=("first",)),
    )
    hear(team, "r_0", Fact("second", "r_1", "added", 2, content_of(second)))
    team.run(4.0)
    hear(team, "r_0", Fact("first", "r_1", "added", 1, content_of(first)))
    done = ends(team)
    assert done["first"] == done["second"] == 1
    order = [data["task"] for _, _, said, data in team.told if said == "ends"]
    assert order.index("first") < order.index("second")


def test_of_two_places_of_a_task_the_last_holds_though_it_is_heard_first():
    team = SimulatedTeam(square())
    team.run(2.0)
    task = next(task for task in square().tasks if task.id == "0")
    first, last = (replace(task, position=(x, 5.0)) for x in (5.0, 30.0))
    hear(team, "r_0", Fact("0", "r_1", "moved", 2, content_of(last)))
    team.run(2.2)
    hear(team, "r_0", Fact("0", "r_1", "moved", 1, content_of(first)))
    team.run(4.0)
    assert {control._executor.ledger.tasks["0"].position for control in team.controls.values()} == {last.position}


def test_a_task_that_is_cancelled_is_left():
    team = SimulatedTeam(Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(Task(id="t", position=(20, 0)),)))
    team.run(5.0)
    team.controls["a"].take_event(Event(at_s=0, cancel_task="t"))
    assert ends(team) == {}
    assert team.world.ports["a"].telemetry().position[0] < 8


@pytest.mark.parametrize(
    ("event", "why"),
    [
        (Event(at_s=0, new_task=Task(id="0", position=(1, 1))), "expected an id that no task has"),
        (Event(at_s=0, move_task=MovedTask(task="x", position=(1, 1))), "expected the id of a task"),
    ],
)
def test_what_an_operator_may_not_say_is_refused(event, why):
    team = SimulatedTeam(square())
    team.run(2.0)
    assert why in team.controls["r_0"].take_event(event)


def test_a_robot_that_uses_more_than_planned_gives_back_what_it_cannot_do():
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0), work_capacity=41.0), Robot(id="b", position=(0, 60), work_capacity=200)),
        tasks=(Task(id="near", position=(20, 0)), Task(id="far", position=(40, 0))),
    )
    team = SimulatedTeam(mission)
    team.run(2.0, lambda: bool(team.net.nodes["a"].route))
    assert [claim.task for claim in team.net.nodes["a"].route] == ["near", "far"]
    team.crash("a")
    team._used["a"] += 10.0  # its gauge has it so
    team.restart("a")
    assert ends(team) == {"near": 1, "far": 1}
    assert ("b", "far") in {(robot, data["task"]) for _, robot, kind, data in team.told if kind == "ends"}
    assert refusals(team) == [("a", "far", "capacity: 50.00 used with it, of 41.00")]


def test_who_has_lost_the_majority_does_what_may_be_done_twice_and_rests():
    own, follows = Task(id="own", position=(5, 9), across_partition="at-most-once"), Task(id="free", position=(9, 9))
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(3)),
        tasks=(own, follows, Task(id="waits", position=(0, 9), prerequisites=("own",))),
    )
    team = SimulatedTeam(mission)
    team.run(2.0)
    team.crash("r_1")
    team.crash("r_2")
    assert ends(team) == {"free": 1}
    team.restart("r_1")
    team.run(team.world.time_s + 5.0)
    assert ends(team) == {"free": 1, "own": 1, "waits": 1}


def test_a_robot_that_is_stuck_leaves_its_tasks_to_others():
    mission = square(seed=1, robots=2, tasks=6)
    team = SimulatedTeam(mission)
    team.run(1.0)
    owned = {claim.task for claim in team.net.nodes["r_0"].route}
    team.world.fail("r_0", silent=False)  # it stands, and its process goes on
    assert set(ends(team)) == {task.id for task in mission.tasks}
    assert owned
    assert "robot_stuck" in {kind for _, robot, kind, _ in team.told if robot == "r_0"}
    assert team.controls["r_0"].take_event(Event(at_s=0, robot_returns="r_0")) is None
    team.world.recover("r_0")
    team.controls["r_1"].take_event(Event(at_s=0, new_task=Task(id="new", position=mission.robots[0].position)))
    assert ends(team)["new"] == 1


@pytest.mark.long
def test_a_robot_that_is_stuck_at_what_nobody_may_do_again_tells_so_and_nobody_waits_for_it():
    once = {"across_partition": "at-most-once"}
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(3)),
        tasks=(
            Task(id="a", position=(40.0, 2.0), duration_s=50.0, **once),
            Task(id="b", position=(0.0, 2.0), prerequisites=("a",)),
            Task(id="c", position=(-2.0, 6.0)),
        ),
    )
    team = SimulatedTeam(mission)
    assert team.run(20.0, lambda: team.times("starts")["a"] == 1)
    team.world.fail("r_2", silent=False)
    assert ends(team) == {"c": 1}
    assert team.times("starts") == {"a": 1, "c": 1}


def test_nobody_waits_for_a_task_that_was_begun_and_is_cancelled():
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(2)),
        tasks=(
            Task(id="a", position=(20.0, 2.0), duration_s=50.0),
            Task(id="b", position=(0.0, 2.0), prerequisites=("a",)),
        ),
    )
    team = SimulatedTeam(mission)
    assert team.run(20.0, lambda: team.times("starts")["a"] == 1)
    team.controls["r_0"].take_event(Event(at_s=0, cancel_task="a"))
    assert ends(team) == {}
    assert team.world.time_s < 40.0


def test_a_robot_that_is_out_asks_for_no_new_epoch_whenever_it_hears_of_something():
    team = SimulatedTeam(square(seed=1, robots=2, tasks=6))
    team.run(1.0)
    team.world.fail("r_0", silent=False)
    ends(team)
    assert "robot_stuck" in {kind for _, _, kind, _ in team.told}
    before = team.net.nodes["r_1"].stage.epoch
    team.controls["r_0"]._executor.plan_again(OtherEvent(kind="heard"))
    team.run(team.world.time_s + 2.0)
    assert team.net.nodes["r_1"].stage.epoch == before


def test_they_wait_for_windows_and_lags_and_end_by_deadlines():
    tasks = (
        Task(id="early", position=(10, 0), duration_s=2.0, deadline_s=30.0),
        Task(id="late", position=(20, 0), duration_s=2.0, window_s=((40.0, 60.0),)),
        Task(
            id="after",
            position=(15, 5),
            prerequisites=("early",),
            lags={"early": Lag(after_s=15.0, within_s=40.0)},
        ),
    )
    robots = tuple(Robot(id=name, position=(0, y), available_until_s=100.0) for name, y in (("a", 0), ("b", 8)))
    team = SimulatedTeam(Mission(robots=robots, tasks=tasks), delay_s=0.02)
    assert ends(team) == {"early": 1, "late": 1, "after": 1}
    began = {data["task"]: at_s for at_s, _, kind, data in team.told if kind == "starts"}
    ended = {data["task"]: at_s for at_s, _, kind, data in team.told if kind == "ends"}
    assert 40.0 <= began["late"] <= 60.0
    assert ended["early"] <= 30.0
    assert 15.0 - 1e-6 <= began["after"] - ended["early"] <= 40.0
    assert {data["cause"] for _, _, kind, data in team.told if kind == "waits"} >= {"window"}


def test_what_can_never_begin_any_more_is_cancelled_with_its_reason():
    far = Task(id="far", position=(30, 0), window_s=((0.0, 40.0),))
    team = SimulatedTeam(Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(far,)), delay_s=0.02)
    team.run(10.0)
    team.controls["a"].take_event(Event(at_s=0, new_task=Task(id="near", position=(0, 0), window_s=((0.0, 12.0),))))
    assert ends(team) == {"far": 1}
    assert team.times("window_missed") + team.times("task_refused") == {"near": 1}


def test_an_order_that_comes_too_late_to_begin_with_another_task_is_given_up_with_the_reason():
    """It is sold after the team's task, which the robot at the other one has yet to do: no schedule has all of them."""
    robots = tuple(Robot(id=name, position=(x, 0)) for name, x in (("a", 0), ("b", 20)))
    under_way = Task(id="c", position=(18, 0), duration_s=30.0, only_robots=("b",))
    lift = Task(id="lift", position=(0, 20), robots_needed=2, duration_s=10.0)
    team = SimulatedTeam(Mission(robots=robots, tasks=(under_way, lift)))
    assert team.run(20.0, lambda: team.times("starts")["c"] == 1)
    order = Task(id="order", position=(1, 2), starts_with=("c",), duration_s=5.0)
    team.controls["a"].take_event(Event(at_s=0, new_task=order))
    assert team.run(30.0, lambda: team.net.nodes["a"].owns("order"))
    assert not plan_of(team.problem, team.net.nodes["a"]).unassigned
    assert ends(team) == {"c": 1, "lift": 2}  # told by both
    assert refusals(team) == [("a", "order", "relation: begins with c, which is done")]


def test_a_plan_says_of_what_is_left_out_why_it_does_not_fit_after_what_was_done():
    robots = tuple(Robot(id=name, position=(x, 0)) for name, x in (("a", 0), ("b", 36)))
    long = Task(id="long", position=(0, 8), duration_s=20.0, deadline_s=50.0)
    soon = Task(id="soon", position=(20, 8), duration_s=5.0, window_s=((0.0, 30.0),))
    team = SimulatedTeam(Mission(robots=robots, tasks=(long, soon)))
    assert team.run(20.0, lambda: team.times("starts")["long"] == 1)
    team.crash("b")
    assert ends(team) == {"long": 1}
    (left_out,) = plan_of(team.problem, team.net.nodes["a"]).unassigned
    assert {reason.robot: reason.reason for reason in left_out.reasons}["a"] == "window"


def test_a_robot_plans_again_after_another_has_done_what_only_the_same_may_go_on_with():
    dig, fill = Task(id="dig", position=(5, 0)), Task(id="fill", position=(10, 0), same_robot_as=("dig",), duration_s=9)
    scan = Task(id="scan", position=(30, 0), duration_s=20.0)
    robots = tuple(Robot(id=name, position=(x, 0)) for name, x in (("a", 0), ("b", 40)))
    team = SimulatedTeam(Mission(robots=robots, tasks=(dig, fill, scan)))
    assert team.run(20.0, lambda: team.times("ends")["dig"] == 1)
    team.controls["b"].take_event(Event(at_s=0, new_task=Task(id="new", position=(39, 0))))
    assert ends(team) == {"dig": 1, "fill": 1, "scan": 1, "new": 1}


@pytest.mark.long
def test_a_robot_that_comes_late_takes_tasks():
    mission = square(tasks=20)
    team = SimulatedTeam(mission, later=["r_3"])
    team.run(5.0)
    team.start("r_3")
    team.run(team.world.time_s + 2.0)
    team.controls["r_0"].take_event(Event(at_s=0, new_task=Task(id="new", position=mission.robots[3].position)))
    assert ends(team)["new"] == 1
    assert ("r_3", "new") in {(robot, data["task"]) for _, robot, kind, data in team.told if kind == "ends"}


def test_an_order_that_contradicts_one_given_elsewhere_is_answered_by_whom_it_was_given_to_and_left():
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(40.0 * k, 0.0)) for k in range(2)),
        tasks=tuple(Task(id=str(k), position=(10.0 * k, 30.0), duration_s=0.0) for k in range(4)),
    )
    team = SimulatedTeam(mission, delay_s=0.02)
    team.run(2.0)
    team.net.cut(["r_0"], ["r_1"])
    team.run(7.0)
    one = Task(id="x", position=(0.0, 60.0), prerequisites=("3",), same_robot_as=("2",), duration_s=0.0)
    other = Task(id="x", position=(40.0, 60.0), duration_s=0.0)
    assert team.controls["r_0"].take_event(Event(at_s=0, new_task=one)) is None
    assert team.controls["r_1"].take_event(Event(at_s=0, new_task=other)) is None
    team.run(9.0)
    team.net.heal()
    ends(team)
    told = [(robot, data["task"], data["reason"]) for _, robot, kind, data in team.told if kind == "task_refused"]
    orders = [node.orders for node in team.net.nodes.values()]
    (refused,) = orders[0].refused
    assert all(list(found.refused) == [refused] for found in orders)
    assert (refused.robot, "x", 'order: there is a task "x"') in told
    assert {robot for robot, task, _ in told if task == "x"} == {refused.robot}
