"""Fleets on duty: orders are put in at once, better routes taken over, commitments held, old tasks forgotten."""

import itertools
import math
from dataclasses import replace

import pytest
from tests.execution.world import World, carry_out

from muster.execution import Executor, Standing, report_of, travel_of
from muster.execution.replanning.insertion import Insertion
from muster.execution.replanning.reallocation import Reallocation
from muster.execution.script import Script
from muster.execution.standing import EventLog
from muster.mission.errors import ParameterError
from muster.mission.events import DelayedTask, MovedTask
from muster.mission.model import Event, Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route
from muster.state.orders import Orders
from muster.state.quantiles import Quantiles


class AtOnce:
    """Searches when it is told to, and has found the same when a second is over."""

    def __init__(self, mission, iterations=500):
        self._replan = Reallocation(travel=travel_of(mission), iterations=iterations)
        self.due_s, self.rests, self._found = math.inf, [], None

    def begin(self, rest):
        self.rests.append(rest)
        self._found, self.due_s = self._replan(rest).routes, rest.now_s + 1.0

    def found(self, now):
        if now < self.due_s:
            return None
        self.due_s = math.inf
        return self._found

    def close(self):
        self._found = None


def fleet(robots=2, **rules):
    crew = tuple(Robot(id=f"r_{k}", position=(20.0 * k, 0.0)) for k in range(robots))
    return Mission(robots=crew, tasks=(), rules=Rules(**({"objective": "makespan"} | rules)))


def order(at_s, name, *place, **more):
    return Event(at_s=at_s, new_task=Task(id=name, position=place, **more))


def stream(count=30, every_s=1.5):
    return [order(k * every_s, f"o{k}", 7 * k % 20, 5 * k % 11, duration_s=1) for k in range(count)]


def on_duty(mission, orders, *, searches=True, until_s=None, keep_s=300.0, step=0.1):
    world = World(mission)
    improver = AtOnce(mission) if searches else None
    standing = Standing(until_s=until_s, orders=orders, improver=improver, keep_s=keep_s)
    replan = Insertion(travel_of(mission))
    executor = Executor(mission, Plan(routes=()), world.ports, replan=replan, standing=standing)
    return carry_out(executor, world, step=step)


def data(executor, kind):
    return [event.data for event in executor.events if event.kind == kind]


@pytest.mark.parametrize("searches", [False, True])
def test_every_order_is_in_a_route_when_its_batch_is_over_and_done_once(searches):
    executor = on_duty(fleet(), stream(), searches=searches)
    seen = executor.orders.report(executor.now_s)
    assert (seen.taken, seen.done, seen.open, seen.lost, seen.refused) == (30, 30, 0, 0, 0)
    assert seen.until_in_route.most_s <= 0.2 + 0.1 + 1e-9
    assert sorted(one["task"] for one in data(executor, "starts")) == sorted(f"o{k}" for k in range(30))
    assert bool(seen.improved) is searches


def test_a_search_makes_it_shorter_and_moves_no_work_under_way():
    plain, searched = (on_duty(fleet(), stream(every_s=0.2), searches=searches) for searches in (False, True))
    assert searched.state.ended_s < plain.state.ended_s
    begun = {}
    for event in searched.events:
        if event.kind == "starts":
            begun[event.data["task"]] = event.data["robot"]
        elif event.kind == "replanned":
            assert not begun.keys() & event.data["moved"].keys()
        elif event.kind == "ends":
            assert event.data["robot"] == begun[event.data["task"]]


@pytest.mark.parametrize("stability", [0, 1])
def test_no_more_orders_than_stability_allows_change_robot(stability):
    executor = on_duty(fleet(3, stability=stability), stream(every_s=0.2))
    moved = [len(one["moved"]) for one in data(executor, "replanned")]
    assert max(moved) <= stability


def test_it_stays_on_duty_until_the_time_and_ends_when_all_is_done_after_it():
    executor = on_duty(fleet(), [order(1, "a", 1, 1), order(39, "b", 9, 9)], until_s=40.0)
    assert executor.state.ended_s > 40.0
    assert executor.now_s < 60
    waits = on_duty(fleet(), [], until_s=40.0)
    assert waits.now_s == pytest.approx(40.0, abs=0.2)


@pytest.mark.parametrize(
    "first",
    [
        Event(at_s=1, cancel_task="nobody"),
        Event(at_s=1, move_task=MovedTask(task="nobody", position=(1, 1))),
        Event(at_s=1, delay_task=DelayedTask(task="nobody", by_s=1)),
    ],
)
def test_orders_are_done_to_the_last_whatever_comes_before_it(first):
    executor = on_duty(fleet(), [first, order(2, "a", 1, 1), replace(first, at_s=20), order(30, "b", 2, 2)])
    seen = executor.orders.report(executor.now_s)
    assert (seen.taken, seen.done, seen.refused, seen.not_taken_from_s) == (2, 2, 2, None)
    assert executor.state.ended_s > 30


def test_endless_orders_are_taken_until_the_time_and_one_after_it_is_read():
    read = []

    def endless():
        for k in itertools.count():
            read.append(5.0 * k)
            yield order(5.0 * k, f"o{k}", 7 * k % 20, 5 * k % 11)

    executor = on_duty(fleet(), endless(), until_s=60.0)
    assert [one["task"]["id"] for one in data(executor, "new_task")] == [f"o{k}" for k in range(13)]
    assert executor.orders.done == 13
    assert executor.state.ended_s > 60
    assert report_of(executor.account).orders.not_taken_from_s == read[-1] == 65.0


def test_orders_after_its_time_on_duty_are_known_though_none_was_taken():
    executor = on_duty(fleet(), [order(2, "a", 1, 1)], until_s=1.0)
    seen = report_of(executor.account).orders
    assert (seen.taken, seen.not_taken_from_s) == (0, 2.0)
    assert executor.now_s == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize(("priority", "second"), [(1, "near"), (5, "urgent")])
def test_the_urgent_comes_first_where_lateness_counts(priority, second):
    under_way = order(0, "under way", 0, 0, duration_s=5)
    orders = [under_way, order(1, "near", -8, 0), order(1, "urgent", 9, 0, priority=priority)]
    executor = on_duty(fleet(1, objective="lateness"), orders)
    assert [one["task"] for one in data(executor, "ends")][:2] == ["under way", second]


def test_a_cancelled_order_is_left_and_one_that_is_too_late_is_lost_with_a_reason():
    orders = [order(0, "a", 5, 0), order(0, "far", 90, 0, deadline_s=20), Event(at_s=2, cancel_task="a")]
    executor = on_duty(fleet(1), orders, until_s=100.0, keep_s=30.0)
    seen = executor.orders.report(executor.now_s)
    assert (seen.taken, seen.done, seen.cancelled, seen.lost, seen.open) == (2, 0, 1, 1, 0)
    assert {one["task"]: one["reason"] for one in data(executor, "lost")}["far"].startswith("deadline: 20 s is over")


def test_orders_that_were_lost_and_forgotten_are_listed_with_the_reason_the_last_twenty_of_them():
    lost = [order(k, f"o{k}", 900, 0, deadline_s=k + 1) for k in range(25)]
    executor = on_duty(fleet(1), [*lost, order(45, "a", 1, 0)], until_s=100.0)
    report = report_of(executor.account)
    assert report.tasks_done == ("a",)
    assert report.orders.lost == 25
    assert [task for task, _ in report.tasks_lost] == [f"o{k}" for k in range(5, 25)]
    assert all(reason.startswith("deadline: ") for _, reason in report.tasks_lost)
    assert report.tasks_forgotten == {"lost": 5}


def test_of_an_id_that_is_used_again_what_was_lost_before_is_only_counted():
    orders = [order(0, "a", 900, 0, deadline_s=1), order(50, "a", 1, 0)]
    report = report_of(on_duty(fleet(1), orders, until_s=60.0).account)
    assert (report.tasks_done, report.tasks_lost, report.tasks_forgotten) == (("a",), (), {"lost": 1})


def test_orders_of_a_robot_that_fails_go_to_others_at_once():
    mission = replace(fleet(), events=(Event(at_s=3, robot_fails="r_1"),))
    executor = on_duty(mission, stream(10, every_s=0.1))
    assert executor.orders.done == 10
    moved = next(one["moved"] for one in data(executor, "replanned") if one["causes"][0]["kind"] == "robot_fails")
    assert set(map(tuple, moved.values())) == {("r_1", "r_0")}


def test_routes_found_are_taken_over_only_if_they_are_better_now():
    mission = fleet(1)
    executor = Executor(
        replace(mission, tasks=tuple(Task(id=name, position=(x, 0)) for name, x in (("a", 5), ("b", 9), ("c", 7)))),
        Plan(routes=(Route("r_0", ("a", "b", "c")),)),
        World(mission).ports,
    )
    rest, insertion = executor._rest(), Insertion(travel_of(mission))
    better = insertion.merged(rest, {"r_0": ("a", "c", "b"), "gone": ("d",)})
    assert better.routes == {"r_0": ("a", "c", "b")}
    assert insertion.merged(rest, {"r_0": ("c", "a", "b")}) is None
    assert insertion.merged(rest, {"r_0": ("a", "b", "c")}) is None
    newer = replace(rest, tasks=[task for task in rest.tasks if task.id != "a"], routes={"r_0": ("b", "c")})
    assert insertion.merged(newer, {"r_0": ("a", "c", "b")}).routes == {"r_0": ("c", "b")}


@pytest.mark.long
def test_what_is_forgotten_lives_on_in_sums():
    orders = [replace(one, new_task=replace(one.new_task, due_s=one.at_s + 3)) for one in stream(60)]
    mission = fleet(objective="lateness")
    all_kept, short = (on_duty(mission, orders, keep_s=keep_s) for keep_s in (1e9, 5.0))
    whole, rest = report_of(all_kept.account), report_of(short.account)
    assert len(whole.tasks_done) == 60
    assert len(rest.tasks_done) + rest.tasks_forgotten["done"] == 60
    assert rest.tasks_forgotten["done"] > 20
    assert len(short.ledger.tasks) == len(rest.tasks_done)
    for figure in ("mission_time_s", "waiting_s", "lateness_s", "waiting_by_cause_s"):
        assert getattr(rest, figure) == pytest.approx(getattr(whole, figure))
    assert rest.objective.flown == pytest.approx(whole.objective.flown)
    assert rest.orders == whole.orders


def test_what_others_wait_for_is_not_forgotten():
    orders = [order(0, "a", 1, 0), order(1, "b", 2, 0, prerequisites=("a",), window_s=((100, 200),))]
    executor = on_duty(fleet(1), orders, until_s=150.0, keep_s=1.0)
    assert executor.orders.done == 2


def test_orders_that_do_not_fit_are_refused_and_counted():
    orders = [order(0, "a", 1, 0), order(1, "a", 2, 0), order(1, "b", 2, 0, prerequisites=("nobody",))]
    executor = on_duty(fleet(1), [*orders, Event(at_s=2, cancel_task="c")], until_s=5.0)
    assert (executor.orders.taken, executor.orders.refused) == (1, 3)
    assert [one["event"] for one in data(executor, "event_refused")][1:] == [
        {"at_s": 1, "new_task": {"id": "b", "position": [2, 0], "prerequisites": ["nobody"]}},
        {"at_s": 2, "cancel_task": "c"},
    ]
    listed = executor.orders.report(executor.now_s).last_refused
    assert [(one.kind, one.id) for one in listed] == [("new_task", "a"), ("new_task", "b"), ("cancel_task", "c")]
    assert [one.at_s for one in listed] == pytest.approx([1, 1, 2], abs=0.2)
    assert all("expected" in one.reason for one in listed)


def test_the_last_twenty_refused_orders_are_listed():
    moves = [Event(at_s=k, delay_task=DelayedTask(task=f"o{k}", by_s=1)) for k in range(25)]
    seen = on_duty(fleet(1), moves).orders.report(30.0)
    assert seen.refused == 25
    assert [one.id for one in seen.last_refused] == [f"o{k}" for k in range(5, 25)]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"until_s": -1.0}, "until_s: -1.0; expected a number of at least 0, or None"),
        ({"until_s": "x"}, 'until_s: "x"; expected a number of at least 0, or None'),
        ({"keep_s": math.nan}, "keep_s: nan; expected a number of at least 0"),
        ({"keep_s": "x"}, 'keep_s: "x"; expected a number of at least 0'),
        ({"keep_s": None}, "keep_s: null; expected a number of at least 0"),
        ({"keep_s": True}, "keep_s: true; expected a number of at least 0"),
        ({"batch_s": -0.1}, "batch_s: -0.1; expected a finite number of at least 0"),
        ({"batch_s": math.inf}, "batch_s: inf; expected a finite number of at least 0"),
        ({"orders": 5}, "orders: 5; expected an iterable of events"),
        ({"orders": [order(1, "a", 1, 1), "x"]}, 'orders: number 2: "x"; expected an Event'),
    ],
)
def test_what_a_fleet_on_duty_is_given_is_checked(wrong, message):
    with pytest.raises(ParameterError) as refused:
        Standing(**wrong)
    assert str(refused.value) == message


def test_orders_that_are_no_events_are_refused_when_they_are_read():
    with pytest.raises(ParameterError, match=r'^orders: number 2: "x"; expected an Event$'):
        on_duty(fleet(), iter([order(1, "a", 1, 1), "x"]))


def test_a_script_reads_orders_one_ahead_and_gives_them_in_batches():
    def endless():
        at_s = 0.0
        while True:
            at_s += 0.3
            yield Event(at_s=at_s, cancel_task=f"{at_s:.1f}")

    script = Script([Event(at_s=0.5, robot_fails="r")], endless(), batch_s=1.0)
    assert script.next_s == 0.5
    assert [event.robot_fails for event in script.due(0.9)] == ["r"]
    assert script.next_s == 1.0
    assert [event.cancel_task for event in script.due(1.0)] == ["0.3", "0.6", "0.9"]
    assert script.next_s == 2.0
    assert Script([], [Event(at_s=1, cancel_task="a")], since_s=1.0).next_s == math.inf


def test_a_log_keeps_the_last_events_under_their_numbers():
    log = EventLog(most=3)
    for number in range(20):
        log.append(number)
    assert log.total == 20
    assert 3 <= len(log) < 6
    assert log.since(18) == [18, 19]
    assert log.since(0) == log[:]
    assert log.since(20) == []
    assert log[-1] == 19


def test_quantiles_are_right_by_one_per_cent_and_the_most_exactly():
    seconds = Quantiles()
    values = [0.0, *(1.01**k for k in range(1, 1000))]
    for value in values:
        seconds.add(value)
    assert seconds.most == values[-1]
    for share in (0.0005, 0.25, 0.5, 0.95, 1.0):
        exact = values[max(0, math.ceil(share * 1000) - 1)]
        assert exact <= seconds.at(share) + 1e-9
        assert seconds.at(share) <= exact * 1.021
    assert Quantiles().at(0.5) == 0.0


def test_without_orders_there_are_no_figures_of_them():
    assert Orders().report(10.0) is None
