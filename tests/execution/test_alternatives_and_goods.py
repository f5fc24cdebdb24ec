"""Runs keep rules on alternatives, on goods that may be on board only so long, and on who calls at a station."""

from dataclasses import replace

import pytest
from tests.execution.test_executor import carried_out, plan_of

import muster
from muster import Mission, Robot, Rules, Task
from muster.execution.reports.report import report_of
from muster.mission.model import Battery, DelayedTask, Event, Station
from muster.running.simulation import Simulation
from muster.verification import verify

IN_PLACE = "either-or: near is done in its place"


def alternatives(*events, near=(3, 0), **keys):
    """One robot, or two, with a task of its own, and a gate of two to which one goes."""
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(1, 0)))
    tasks = (
        Task(id="far", position=(9, 0), either_or=("near",), duration_s=5),
        Task(id="near", position=near, duration_s=5, **keys),
        Task(id="own", position=(0, 3)),
    )
    return Mission(rules=Rules(objective="total"), robots=robots, tasks=tasks, events=events)


def run(mission, *routes, **given):
    plan = plan_of(**given) if given else muster.solve(mission, "search", iterations=50)
    return carried_out(mission, plan)


@pytest.mark.parametrize(
    ("events", "done", "reason"),
    [
        ((), {"near", "own"}, IN_PLACE),
        ((Event(at_s=1, cancel_task="near"),), {"far", "own"}, "cancelled at 1"),
        ((Event(at_s=4, cancel_task="near"),), {"far", "own"}, "cancelled at 4"),
        ((Event(at_s=4, robot_fails="s"),), {"near", "own"}, IN_PLACE),
        ((Event(at_s=4, cancel_task="far"),), {"near", "own"}, "cancelled at 4"),
    ],
)
def test_one_of_two_alternatives_is_done_whatever_happens(events, done, reason):
    executor = run(alternatives(*events))
    report = report_of(executor.account)
    assert set(report.tasks_done) == done
    ((_, why),) = report.tasks_lost
    assert why.startswith(reason)


def test_the_other_alternative_is_planned_where_the_chosen_one_cannot_be_done_any_more():
    """Its only robot is out."""
    executor = run(alternatives(Event(at_s=1, robot_fails="s"), only_robots=("s",)))
    report = report_of(executor.account)
    assert set(report.tasks_done) == {"far", "own"}
    ((lost, reason),) = report.tasks_lost
    assert (lost, reason) == ("near", "either-or: far is done in its place")


def test_a_plan_that_has_both_does_the_first_and_drops_the_other():
    executor = run(alternatives(), r=["own", "far"], s=["near"])
    report = report_of(executor.account)
    assert set(report.tasks_done) == {"near", "own"}
    assert dict(report.tasks_lost) == {"far": IN_PLACE}
    (again,) = [event for event in executor.events if event.kind == "replanned"]
    assert [cause["kind"] for cause in again.data["causes"]] == ["starts"]
    assert again.data["dropped"] == {"far": IN_PLACE}


def test_a_new_task_may_tie_those_that_there_are():
    new = Task(id="new", position=(2, 0), either_or=("near", "own"))
    executor = run(alternatives(Event(at_s=6, new_task=new)))
    lost = dict(report_of(executor.account).tasks_lost)
    assert lost["new"].startswith("either-or: ")
    assert lost["new"].endswith("is done in its place")


def test_what_is_on_board_is_delivered_and_no_alternative_to_its_delivery_fetched():
    """To fetch and bring the other one would be more tasks done, but leave the first on board."""
    tasks = (
        Task(id="take", position=(1, 0), load=1),
        Task(id="bring", position=(9, 0), delivers="take", either_or=("other",)),
        Task(id="fetch", position=(2, 0), load=1),
        Task(id="other", position=(3, 0), delivers="fetch"),
    )
    events = (Event(at_s=4, new_task=Task(id="new", position=(5, 5))),)
    mission = Mission(robots=(Robot(id="r", position=(0, 0), load_capacity=2),), tasks=tasks, events=events)
    report = report_of(run(mission, r=["take", "bring"]).account)
    assert set(report.tasks_done) == {"take", "bring", "new"}
    assert dict(report.tasks_lost)["other"] == "either-or: bring is done in its place"


def ride(longest_s, *events, robots=1):
    """A parcel, and a task between its ends that would make its way longer."""
    return Mission(
        rules=Rules(objective="total"),
        robots=tuple(Robot(id=f"r_{k}", position=(-5.0 * k, 0)) for k in range(robots)),
        tasks=(
            Task(id="take", position=(1, 0), load=1, duration_s=2),
            Task(id="bring", position=(11, 0), delivers="take", longest_aboard_s=longest_s),
            Task(id="between", position=(6, 0), duration_s=10),
        ),
        events=events,
    )


def test_what_a_pick_up_cannot_be_followed_by_in_time_does_not_begin():
    """A plan from elsewhere has a task between the two that takes too long; a new plan has it elsewhere."""
    executor = run(ride(12.0), r_0=["take", "between", "bring"])
    report = report_of(executor.account)
    refused = [event.data["reason"] for event in executor.events if event.kind == "task_refused"]
    way = "the way on board from the end of take to the begin of bring"
    assert refused == [f"aboard: {way} takes at least 20.0 s; expected at most 12 s"]
    assert set(report.tasks_done) == {"take", "between", "bring"}
    assert report.starts_s["bring"] <= report.ends_s["take"] + 12


def test_a_new_plan_respects_since_when_goods_are_on_board():
    """A task that appears on the way is done after the delivery, though that is a detour; without the limit before."""
    new = Event(at_s=5, new_task=Task(id="new", position=(5, 1), duration_s=8))
    for longest_s, first in ((14, "bring"), (60, "new")):
        mission = replace(ride(longest_s, new), tasks=ride(longest_s).tasks[:2])
        starts = report_of(run(mission).account).starts_s
        assert min(("bring", "new"), key=starts.get) == first


def test_a_new_plan_respects_what_is_just_being_taken_on_board():
    new = Event(at_s=2, new_task=Task(id="new", position=(5, 1), duration_s=8))
    mission = replace(ride(14, new), tasks=ride(14).tasks[:2])
    starts = report_of(run(mission).account).starts_s
    assert starts["bring"] < starts["new"]


def test_goods_that_were_on_board_for_too_long_are_told_in_the_words_of_the_rule():
    """The task between its ends is delayed while the robot is at it."""
    delay = Event(at_s=10, delay_task=DelayedTask(task="between", by_s=30))
    executor = run(ride(25.0, delay), r_0=["take", "between", "bring"])
    report = report_of(executor.account)
    reason = f"aboard: not begun within 25 s after take, ended at {round(report.ends_s['take'], 1):g} s"
    assert [event.data["reason"] for event in executor.events if event.kind == "within_missed"] == [reason]
    assert dict(report.tasks_lost) == {"bring": reason}


def yard(*events):
    """A robot that needs energy between its tasks, and may not call at the nearer station."""
    robots = (
        Robot(id="r", position=(0, 0), battery=Battery(capacity=14)),
        Robot(id="s", position=(99, 0)),
    )
    return Mission(
        rules=Rules(objective="total", return_to_start=True),
        robots=robots,
        tasks=tuple(Task(id=t, position=at, only_robots=("r",)) for t, at in (("a", (6, 0)), ("b", (0, 5)))),
        stations=(
            Station(id="off", position=(1, 0), services=("swap",)),
            Station(id="near", position=(1.5, 0), services=("swap",), only_robots=("s",)),
        ),
        events=events,
    )


def stations(*events, ignore=(), **keys):
    mission = yard(*events)
    simulation = Simulation(
        mission, muster.solve(mission, "search", iterations=50, ignore=ignore), ignore=ignore, **keys
    )
    while not simulation.done:
        simulation.advance(simulation.time_s + 10.0)
    return simulation


def called_at(simulation):
    return {event.data["station"] for event in simulation.events if event.kind == "service_begins"}


def test_a_robot_calls_at_no_station_that_is_for_others():
    assert called_at(stations()) == {"off"}
    assert called_at(stations(ignore=("lock",))) == {"near"}


def test_nor_does_it_when_it_is_planned_again_or_goes_of_itself():
    new = Event(at_s=3, new_task=Task(id="new", position=(5, 0)))
    assert called_at(stations(new, drain={"r": 1.3})) == {"off"}


def test_a_plan_from_elsewhere_that_calls_there_is_not_followed():
    mission = yard()
    plan = muster.solve(mission, "search", iterations=50, ignore=("lock",))
    assert not verify(mission, plan).valid
    simulation = Simulation(mission, plan)
    while not simulation.done:
        simulation.advance(simulation.time_s + 10.0)
    assert called_at(simulation) <= {"off"}
