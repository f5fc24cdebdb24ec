"""Robots that decide for themselves do all that can be done, once, whatever happens to them and to their network."""

from random import Random

import pytest
from tests.running.negotiated.company import Company

from muster import Event, Mission, Robot, Task
from muster.mission.model import MovedTask
from muster.negotiation.messages import Fact, Message, Stage
from muster.negotiation.new_tasks import content_of

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


def ends(company):
    """All rest in time; how often each task was done."""
    assert company.run(company.world.time_s + LONG_S, lambda: company.rests)
    return company.times("ends")


@pytest.mark.parametrize("seed", range(4))
def test_without_faults_every_task_is_done_once_after_what_it_waits_for(seed):
    mission = square(seed)
    company = Company(mission, seed=seed, delay_s=0.02)
    assert ends(company) == {task.id: 1 for task in mission.tasks}
    ended = {data["task"]: at_s for at_s, _, kind, data in company.told if kind == "ends"}
    began = {data["task"]: at_s for at_s, _, kind, data in company.told if kind == "starts"}
    assert all(ended[before] <= began[task.id] for task in mission.tasks for before in task.prerequisites)


@pytest.mark.parametrize("seed", range(12))
def test_while_robots_hear_each_other_nothing_is_done_twice_whoever_crashes(seed):
    mission, random = square(seed), Random(seed)
    company = Company(mission, seed=seed, loss=0.3, delay_s=0.05, jitter_s=0.05, duplication=0.1)
    victims = random.sample(company.robots, 2)
    company.run(random.uniform(1, 20))
    company.crash(victims[0])
    company.run(company.world.time_s + random.uniform(0, 10))
    company.crash(victims[1])
    company.run(company.world.time_s + random.uniform(0, 10))
    company.restart(victims[0])
    done = ends(company)
    lately = {data["task"] for _, _, kind, data in company.last_words if kind == "ends"}  # nobody else may know
    assert {task for task, times in done.items() if times > 1} <= lately
    facts = next(iter(company.net.nodes.values())).facts
    held = {fact.task for fact in facts if fact.kind == "begun" and fact.robot == victims[1]} - set(done)
    waiting = held.copy()  # what the one that stays away said it begins, nobody may; nor what waits for it
    while more := {t.id for t in mission.tasks if waiting.intersection(t.prerequisites)} - waiting:
        waiting |= more
    assert set(done) >= {task.id for task in mission.tasks} - waiting


@pytest.mark.parametrize("seed", range(8))
def test_across_a_cut_only_tasks_that_allow_it_are_done_twice(seed):
    mission, random = square(seed, robots=5), Random(seed)
    company = Company(mission, seed=seed, delay_s=0.02)
    company.run(random.uniform(1, 10))
    side = random.sample(company.robots, 2)
    company.net.cut(side, [robot for robot in company.robots if robot not in side])
    company.run(company.world.time_s + 15.0)
    company.net.heal()
    done = ends(company)
    assert set(done) == {task.id for task in mission.tasks}
    for task in mission.tasks:
        begun = {robot for _, robot, kind, data in company.told if kind == "starts" and data["task"] == task.id}
        assert len(begun) == 1 or task.across_partition == "at-least-once"
    twice = {task for task, times in done.items() if times > 1}
    assert all(twice <= set(node.twice) for node in company.net.nodes.values())


def test_a_new_task_goes_to_whom_it_suits_best_and_is_done():
    mission = square()
    company = Company(mission)
    company.run(5.0)
    where = company.world.ports["r_2"].telemetry().position
    company.pilots["r_0"].befalls(Event(at_s=0, new_task=Task(id="new", position=where[:2])))
    assert ends(company)["new"] == 1


def test_a_task_that_moves_is_done_where_it_is_then():
    mission = Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(Task(id="t", position=(20, 0)),))
    company = Company(mission)
    company.run(5.0)
    company.pilots["a"].befalls(Event(at_s=0, move_task=MovedTask(task="t", position=(0, 20))))
    assert ends(company) == {"t": 1}
    assert company.world.ports["a"].telemetry().position == pytest.approx((0, 20, 0), abs=0.05)


def test_a_new_task_that_is_said_once_more_is_not_refused_though_it_has_moved():
    company = Company(square())
    company.run(2.0)
    new = Event(at_s=0, new_task=Task(id="new", position=(5.0, 5.0)))
    move = Event(at_s=0, move_task=MovedTask(task="new", position=(30.0, 5.0)))
    for event in (new, move, new):
        assert company.pilots["r_0"].befalls(event) is None
        company.run(company.world.time_s + 1.0)
    assert ends(company)["new"] == 1


def hear(company, robot, *facts):
    """One robot hears facts of another; only they got through."""
    node, stage = company.net.nodes[robot], company.net.nodes[robot].stage
    message = Message("r_1", 1, 0, Stage(stage.epoch), facts=facts)
    node.handle(message, company.net.now)


@pytest.mark.parametrize(("kind", "done"), [("cancelled", 0), ("moved", 1)])
def test_what_is_heard_of_a_task_before_it_is_heard_that_there_is_one_holds(kind, done):
    company = Company(square())
    company.run(2.0)
    new, elsewhere = (Task(id="new", position=(x, 5.0)) for x in (5.0, 30.0))
    hear(company, "r_0", Fact("new", "r_1", kind, 2, content_of(elsewhere) if kind == "moved" else b""))
    company.run(4.0)
    hear(company, "r_0", Fact("new", "r_1", "added", 1, content_of(new)))
    assert ends(company)["new"] == done
    if done:
        (robot,) = {robot for _, robot, said, data in company.told if said == "ends" and data["task"] == "new"}
        assert company.pilots[robot]._executor.ledger.tasks["new"] == elsewhere


def test_a_new_task_that_is_heard_before_what_it_waits_for_is_done_after_that():
    company = Company(square())
    company.run(2.0)
    first, second = (
        Task(id="first", position=(5.0, 5.0)),
        Task(id="second", position=(6.0, 5.0), prerequisites=("first",)),
    )
    hear(company, "r_0", Fact("second", "r_1", "added", 2, content_of(second)))
    company.run(4.0)
    hear(company, "r_0", Fact("first", "r_1", "added", 1, content_of(first)))
    done = ends(company)
    assert done["first"] == done["second"] == 1
    order = [data["task"] for _, _, said, data in company.told if said == "ends"]
    assert order.index("first") < order.index("second")


def test_of_two_places_of_a_task_the_last_holds_though_it_is_heard_first():
    company = Company(square())
    company.run(2.0)
    first, last = (Task(id="0", position=(x, 5.0), duration_s=0.0) for x in (5.0, 30.0))
    hear(company, "r_0", Fact("0", "r_1", "moved", 2, content_of(last)))
    company.run(2.2)
    hear(company, "r_0", Fact("0", "r_1", "moved", 1, content_of(first)))
    company.run(4.0)
    assert {pilot._executor.ledger.tasks["0"].position for pilot in company.pilots.values()} == {last.position}


def test_a_task_that_is_cancelled_is_left():
    company = Company(Mission(robots=(Robot(id="a", position=(0, 0)),), tasks=(Task(id="t", position=(20, 0)),)))
    company.run(5.0)
    company.pilots["a"].befalls(Event(at_s=0, cancel_task="t"))
    assert ends(company) == {}
    assert company.world.ports["a"].telemetry().position[0] < 8


@pytest.mark.parametrize(
    ("event", "why"),
    [
        (Event(at_s=0, new_task=Task(id="0", position=(1, 1))), "expected an id that no task has"),
        (Event(at_s=0, move_task=MovedTask(task="x", position=(1, 1))), "expected the id of a task"),
    ],
)
def test_what_an_operator_may_not_say_is_refused(event, why):
    company = Company(square())
    company.run(2.0)
    assert why in company.pilots["r_0"].befalls(event)


def test_a_robot_that_uses_more_than_planned_gives_back_what_it_cannot_do():
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0), work_capacity=41.0), Robot(id="b", position=(0, 60), work_capacity=200)),
        tasks=(Task(id="near", position=(20, 0)), Task(id="far", position=(40, 0))),
    )
    company = Company(mission)
    company.run(2.0, lambda: bool(company.net.nodes["a"].route))
    assert [claim.task for claim in company.net.nodes["a"].route] == ["near", "far"]
    company.crash("a")
    company._used["a"] += 10.0  # its gauge has it so
    company.restart("a")
    assert ends(company) == {"near": 1, "far": 1}
    assert ("b", "far") in {(robot, data["task"]) for _, robot, kind, data in company.told if kind == "ends"}


def test_who_has_lost_the_majority_does_what_may_be_done_twice_and_rests():
    own, follows = Task(id="own", position=(5, 9), across_partition="at-most-once"), Task(id="free", position=(9, 9))
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(3)),
        tasks=(own, follows, Task(id="waits", position=(0, 9), prerequisites=("own",))),
    )
    company = Company(mission)
    company.run(2.0)
    company.crash("r_1")
    company.crash("r_2")
    assert ends(company) == {"free": 1}
    company.restart("r_1")
    company.run(company.world.time_s + 5.0)
    assert ends(company) == {"free": 1, "own": 1, "waits": 1}


def test_a_robot_that_is_stuck_leaves_its_tasks_to_others():
    mission = square(seed=1, robots=2, tasks=6)
    company = Company(mission)
    company.run(1.0)
    owned = {claim.task for claim in company.net.nodes["r_0"].route}
    company.world.fail("r_0", silent=False)  # it stands, and its process goes on
    assert set(ends(company)) == {task.id for task in mission.tasks}
    assert owned
    assert "robot_stuck" in {kind for _, robot, kind, _ in company.told if robot == "r_0"}
    assert company.pilots["r_0"].befalls(Event(at_s=0, robot_returns="r_0")) is None
    company.world.recover("r_0")
    company.pilots["r_1"].befalls(Event(at_s=0, new_task=Task(id="new", position=mission.robots[0].position)))
    assert ends(company)["new"] == 1


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
    company = Company(mission)
    assert company.run(20.0, lambda: company.times("starts")["a"] == 1)
    company.world.fail("r_2", silent=False)
    assert ends(company) == {"c": 1}
    assert company.times("starts") == {"a": 1, "c": 1}


def test_nobody_waits_for_a_task_that_was_begun_and_is_cancelled():
    mission = Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(2)),
        tasks=(
            Task(id="a", position=(20.0, 2.0), duration_s=50.0),
            Task(id="b", position=(0.0, 2.0), prerequisites=("a",)),
        ),
    )
    company = Company(mission)
    assert company.run(20.0, lambda: company.times("starts")["a"] == 1)
    company.pilots["r_0"].befalls(Event(at_s=0, cancel_task="a"))
    assert ends(company) == {}
    assert company.world.time_s < 40.0


def test_a_robot_that_is_out_asks_for_no_new_epoch_whenever_it_hears_of_something():
    company = Company(square(seed=1, robots=2, tasks=6))
    company.run(1.0)
    company.world.fail("r_0", silent=False)
    ends(company)
    assert "robot_stuck" in {kind for _, _, kind, _ in company.told}
    before = company.net.nodes["r_1"].stage.epoch
    company.pilots["r_0"]._executor.plan_again("heard", {})
    company.run(company.world.time_s + 2.0)
    assert company.net.nodes["r_1"].stage.epoch == before


def test_a_robot_that_comes_late_takes_tasks():
    mission = square(tasks=20)
    company = Company(mission, later=["r_3"])
    company.run(5.0)
    company.start("r_3")
    company.run(company.world.time_s + 2.0)
    company.pilots["r_0"].befalls(Event(at_s=0, new_task=Task(id="new", position=mission.robots[3].position)))
    assert ends(company)["new"] == 1
    assert ("r_3", "new") in {(robot, data["task"]) for _, robot, kind, data in company.told if kind == "ends"}
