"""Stations that serve no more robots at once than they have slots: in order of arrival, or as the plan says."""

from dataclasses import replace

import pytest
from tests.carry_charge import (
    battery,
    charger,
    depot,
    faults,
    judged,
    kinds,
    mission,
    plan,
    robot,
    stating,
    swapper,
    task,
    times,
)

from muster.mission.model import Lag
from muster.mission.plan import Route, RouteStop
from muster.verification import verify


def fleet(names, **keys):
    return [robot(name, battery=battery(100), **keys) for name in names]


def begins(verdict, station):
    """(robot, arrives, starts, ends) of all services of a station, in order of begin."""
    found = [
        (route.robot, stop.arrives_s, stop.starts_s, stop.ends_s)
        for route in verdict.routes
        for stop in route.stops
        if stop.name == station
    ]
    return sorted(found, key=lambda one: one[2])


def ordered(bare, **turns):
    """The plan with stops that say when services begin: by robot a number for each stop. Other times say nothing."""
    routes = [
        replace(
            route,
            stops=tuple(
                RouteStop(name, 0, begin, 0, name in ("rack", "dock", "depot"))
                for name, begin in zip(route.tasks, turns[route.robot], strict=True)
            ),
        )
        for route in bare.routes
    ]
    return replace(bare, routes=tuple(routes))


THREE = [robot(name, x, battery=battery(100)) for name, x in (("r", 3), ("s", 1), ("t", 2))]


@pytest.mark.parametrize(
    ("slots", "served"),
    [
        (1, [("s", 1, 1, 11), ("t", 2, 11, 21), ("r", 3, 21, 31)]),
        (2, [("s", 1, 1, 11), ("t", 2, 2, 12), ("r", 3, 11, 21)]),
        (3, [("s", 1, 1, 11), ("t", 2, 2, 12), ("r", 3, 3, 13)]),
    ],
)
def test_robots_are_served_in_order_of_arrival(slots, served):
    verdict = judged(mission(THREE, [], [swapper(swap_s=10, slots=slots)]), r="rack", s="rack", t="rack")
    assert verdict.valid
    assert begins(verdict, "rack") == served
    assert verdict.waiting_s == sum(starts - arrives for _, arrives, starts, _ in served)


def test_ties_go_by_ids_of_robots():
    names = ("r10", "10", "9", "r2")
    given = mission(fleet(names, x=0), [], [swapper(x=5, swap_s=10)])
    verdict = judged(given, **dict.fromkeys(names, "rack"))
    assert [name for name, *_ in begins(verdict, "rack")] == ["9", "10", "r10", "r2"]


@pytest.mark.parametrize(
    ("slots", "served"),
    [
        (1, [("r", 3, 3, 13), ("t", 2, 13, 23), ("s", 1, 23, 33)]),
        (2, [("r", 3, 3, 13), ("t", 2, 3, 13), ("s", 1, 13, 23)]),
    ],
)
def test_a_plan_may_say_the_order(slots, served):
    given = mission(THREE, [], [swapper(swap_s=10, slots=slots)])
    verdict = verify(given, ordered(plan(r="rack", s="rack", t="rack"), r=[1], t=[2], s=[3]))
    assert begins(verdict, "rack") == served
    assert {fault.kind for fault in verdict.violations} == {"stop"}


def test_a_plan_that_states_another_order_than_that_of_arrival_and_its_times_is_valid():
    given = mission(THREE, [], [swapper(swap_s=10)])
    seconds = {"r": (3, 3, 13), "t": (2, 13, 23), "s": (1, 23, 33)}
    routes = tuple(Route(name, ("rack",), stops=(RouteStop("rack", *seconds[name], True),)) for name in "rst")
    assert verify(given, replace(plan(r=""), routes=routes)).valid


def test_of_services_that_are_said_to_begin_at_once_who_arrives_first_is_first():
    """With two slots t, which arrives at 2 s, need not wait for r."""
    given = mission(THREE, [], [swapper(swap_s=10, slots=2)])
    seconds = {"r": (3, 3, 13), "t": (2, 3, 13), "s": (1, 13, 23)}
    routes = tuple(Route(name, ("rack",), stops=(RouteStop("rack", *seconds[name], True),)) for name in "rst")
    verdict = verify(given, replace(plan(r=""), routes=routes))
    assert begins(verdict, "rack") == [("t", 2, 2, 12), ("r", 3, 3, 13), ("s", 1, 12, 22)]


def test_a_station_of_which_a_plan_says_not_all_serves_in_order_of_arrival():
    given = mission(THREE, [], [swapper(swap_s=10)])
    stated = ordered(plan(r="rack", s="rack", t="rack"), r=[1], t=[2], s=[3])
    less = replace(stated, routes=(stated.routes[0], Route("s", ("rack",)), stated.routes[2]))
    assert [name for name, *_ in begins(verify(given, less), "rack")] == ["s", "t", "r"]


def test_charges_last_as_long_as_they_are_large():
    robots = [robot("r", battery=battery(100)), robot("s", battery=battery(100, at_start=0.5))]
    given = mission(robots, [], [charger(x=10, rate=2)])
    assert begins(judged(given, r="dock", s="dock"), "dock") == [("r", 10, 10, 15), ("s", 10, 15, 45)]


def test_a_service_without_length_waits_for_its_turn_but_keeps_nobody_waiting():
    given = mission(
        [robot("r"), robot("s", x=1, battery=battery(9)), robot("t", x=2, battery=battery(9)), robot("u", x=-3)],
        [],
        [swapper(x=0, swap_s=10)],
    )
    verdict = judged(given, u="rack", t="rack", s="rack", r="rack")
    assert begins(verdict, "rack") == [("r", 0, 0, 0), ("s", 1, 1, 11), ("t", 2, 11, 21), ("u", 3, 21, 21)]


def test_a_route_is_late_by_what_its_robot_waits_for_a_slot():
    given = mission(fleet("rs"), [task("a", 5, deadline_s=30), task("b", 5, deadline_s=20)], [swapper(swap_s=10)])
    verdict = judged(given, r="rack a", s="rack b")
    assert times(verdict, "s") == [("rack", 0, 10, 20), ("b", 25, 25, 25)]
    assert faults(verdict) == [("deadline", None, "b", "ends at 25 s at the earliest, its deadline is 20 s")]


def test_a_shift_ends_after_the_last_service():
    given = mission(fleet("r", available_until_s=19), [task("a", 5)], [swapper(x=5, swap_s=15)])
    assert kinds(judged(given, r="a")) == []
    assert faults(judged(given, r="a rack")) == [
        ("shift", "r", None, "its route ends at 20 s at the earliest, it is available until 19 s")
    ]


def test_arrivals_that_wait_for_tasks_of_robots_that_wait_for_the_station():
    """s comes to the station only when r, served first, has done a; t arrives before it."""
    tasks = [task("a", 4), task("b", 0, prerequisites=("a",))]
    robots = [*fleet("rs"), robot("t", x=-20, battery=battery(100))]
    given = mission(robots, tasks, [swapper(swap_s=10)])
    verdict = judged(given, r="rack a", s="b rack", t="rack")
    assert begins(verdict, "rack") == [("r", 0, 0, 10), ("s", 14, 14, 24), ("t", 20, 24, 34)]
    later = replace(given, robots=(*robots[:2], robot("t", x=-13, battery=battery(100))))
    assert begins(judged(later, r="rack a", s="b rack", t="rack"), "rack")[1:] == [("t", 13, 13, 23), ("s", 14, 23, 33)]


def test_a_greatest_lag_delays_an_arrival_and_with_it_the_order():
    """a must not end more than 2 s before b begins, which is at 30 s: then r comes to the station after s."""
    tasks = [task("a", 1), task("b", 30, prerequisites=("a",), lags={"a": Lag(within_s=2)})]
    robots = [*fleet("rq"), robot("s", x=-12, battery=battery(100))]
    given = mission(robots, tasks, [swapper(x=1, swap_s=10)])
    verdict = judged(given, r="a rack", q="b", s="rack")
    assert verdict.valid
    assert times(verdict) == [("a", 1, 28, 28), ("rack", 28, 28, 38)]
    assert begins(verdict, "rack") == [("s", 13, 13, 23), ("r", 28, 28, 38)]


@pytest.mark.parametrize("way", [0, 30])
def test_a_greatest_lag_changes_the_order_that_makes_it(way):
    """r comes from a, and s goes to b, 12 s after a at most. Served after r, s is so late that r has to come after s.

    If s is served first and b is far, r comes later than s: that is a schedule. If b is near r comes first again. Then
    there is none in order of arrival, and a plan has to say who is first.
    """
    tasks = [task("a", 0), task("b", 1 + way, prerequisites=("a",), lags={"a": Lag(within_s=12)})]
    given = mission(
        [robot("r", battery=battery(100)), robot("s", x=1, battery=battery(100))], tasks, [swapper(swap_s=10)]
    )
    verdict = judged(given, r="a rack", s="rack b")
    if way:
        assert verdict.valid
        assert begins(verdict, "rack") == [("s", 1, 1, 11), ("r", 30, 30, 40)]
        return
    assert faults(verdict) == [("deadlock", None, None, "lags leave no order of arrival at rack")]
    verdict = verify(given, ordered(plan(r="a rack", s="rack b"), r=[0, 2], s=[1, 2]))
    assert begins(verdict, "rack") == [("s", 1, 1, 11), ("r", 0, 11, 21)]
    assert {fault.kind for fault in verdict.violations} == {"stop"}


ORDER = [task("a", 5, prerequisites=("b",)), task("b", 5)]


def test_an_order_that_contradicts_the_routes_deadlocks():
    """s is to be served after r, which waits at a for what s does then."""
    given = mission(fleet("rs"), ORDER, [swapper(swap_s=10)])
    bare = plan(r="a rack", s="rack b")
    assert judged(given, r="a rack", s="rack b").valid
    verdict = verify(given, ordered(bare, r=[0, 1], s=[2, 3]))
    assert faults(verdict) == [
        ("deadlock", None, None, "r: a -> rack; served at rack: r -> s; s: rack -> b; prerequisite: b -> a")
    ]
    assert verdict.makespan_s is None
    assert all(route.stops == () for route in verdict.routes)


def test_robots_that_wait_for_each_other_deadlock_without_any_station_too():
    given = mission(fleet("rs"), ORDER, [swapper()])
    assert kinds(judged(given, r="a rack b", s="rack")) == ["deadlock"]


def test_lags_that_an_order_at_a_station_breaks_for_ever_are_named():
    tasks = [task("a", 0), task("b", 0, prerequisites=("a",), lags={"a": Lag(within_s=5)})]
    given = mission(fleet("rs"), tasks, [swapper(swap_s=10)])
    verdict = verify(given, ordered(plan(r="a rack", s="rack b"), r=[0, 1], s=[2, 3]))
    (said,) = verdict.violations
    assert (said.kind, said.task) == ("prerequisite", "b")
    assert "s is served at rack after r" in said.detail
    assert "b begins at most 5 s after a ends" in said.detail


def test_two_robots_at_once_at_an_unloading_station_cost_no_time():
    given = mission([robot("r"), robot("s")], [task("a", 3, load=1)], [depot(x=4)])
    verdict = judged(given, r="a depot", s="depot depot")
    assert verdict.valid
    assert begins(verdict, "depot") == [("r", 4, 4, 4), ("s", 4, 4, 4), ("s", 4, 4, 4)]


def test_a_team_waits_for_its_member_that_charges():
    given = mission(fleet("rs"), [task("a", 5, robots_needed=2, duration_s=3)], [swapper(swap_s=10)])
    verdict = judged(given, r="a", s="rack a")
    assert verdict.valid
    assert times(verdict) == [("a", 5, 15, 18)]
    assert (verdict.tasks_completed, verdict.weight_completed, verdict.makespan_s) == (1, 1, 18)


def test_a_plan_that_states_what_the_judge_found_is_valid_with_every_number_of_slots():
    tasks = [task(name, x) for name, x in (("a", 3), ("b", 6), ("c", 9), ("d", 2))]
    for slots in (1, 2):
        stations = [charger(x=4, rate=0.5, slots=slots), swapper(x=-1, swap_s=7, slots=slots)]
        given = mission(fleet("rst"), tasks, stations)
        bare = plan(r="a dock b rack", s="dock rack c dock", t="rack d dock dock")
        for charged in (False, True):
            stated = stating(given, bare, charged=charged)
            assert verify(given, stated).valid
            assert verify(given, stated).routes == verify(given, bare).routes


@pytest.mark.long
def test_many_visits():
    """Deeper than Python recurses, and in time that grows with their number."""
    given = mission(fleet([f"r{k}" for k in range(40)]), [], [swapper(swap_s=10, slots=3), charger("dock", 5)])
    bare = plan(**{robot.id: "rack dock " * 60 for robot in given.robots})
    verdict = verify(given, stating(given, bare, charged=True))
    assert verdict.valid
    assert verdict.routes == verify(given, bare).routes


def test_services_without_length_that_are_said_to_begin_at_once_keep_the_order_of_routes():
    """All is at one place and takes no time: q, first by its id, comes to the station after r has been there."""
    tasks = [task("a", 5), task("b", 5, prerequisites=("a",))]
    given = mission([robot("r"), robot("q")], tasks, [depot(x=5)])
    bare = plan(r="depot a", q="b depot")
    stated = stating(given, bare)
    assert times(verify(given, stated), "q") == [("b", 5, 5, 5), ("depot", 5, 5, 5)]
    assert verify(given, stated).valid
