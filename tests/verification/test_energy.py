"""Energy: what batteries hold along routes, and what stations add to them."""

from dataclasses import replace

import pytest
from tests.carry_charge import (
    battery,
    charger,
    charging,
    depot,
    faults,
    judged,
    kinds,
    levels,
    mission,
    plan,
    robot,
    stating,
    stops,
    swapper,
    task,
    times,
)
from tests.verification.test_goods import judged_reason

from muster.mission.model import Map, Rules, TravelTable, Zone
from muster.mission.reading.plan_reader import read_plan
from muster.verification import verify


def test_travel_and_work_draw_and_waiting_does_not():
    given = mission(
        [robot(battery=battery(20))], [task("a", 5, actuation_cost=3, window_s=((100, None),)), task("b", 7)]
    )
    verdict = judged(given, r="a b")
    assert verdict.valid
    assert levels(verdict) == [("a", 15, 12), ("b", 10, 10)]


def test_a_level_is_never_below_the_reserve():
    given = mission([robot(battery=battery(10, reserve=0.2))], [task("a", 8), task("b", 9), task("c", 10)])
    assert judged(given, r="a").valid
    assert faults(judged(given, r="a b c")) == [
        ("battery", "r", "b", "its battery holds 1 m when it arrives at b, at least 2 m must stay")
    ]
    assert judged(given, "battery", r="a b c").valid


def test_after_work_too():
    given = mission([robot(battery=battery(10, at_start=0.9))], [task("a", 5, actuation_cost=6)])
    assert faults(judged(given, r="a")) == [
        ("battery", "r", "a", "its battery holds -2 m when it has worked at a, at least 0 m must stay")
    ]


def test_the_way_to_the_end_counts():
    given = mission([robot(battery=battery(10), return_to_start=True)], [task("a", 6)])
    assert faults(judged(given, r="a")) == [
        ("battery", "r", None, "its battery holds -2 m when it arrives at its end, at least 0 m must stay")
    ]


def test_a_robot_must_reach_the_station():
    given = mission([robot(battery=battery(10))], [task("a", 9)], [charger(x=11)])
    assert faults(judged(given, r="a dock")) == [
        ("battery", "r", None, "its battery holds -1 m when it arrives at dock, at least 0 m must stay")
    ]


def test_a_full_charge_takes_what_is_missing_by_the_rate():
    given = mission(
        [robot(battery=battery(20), return_to_start=True)], [task("a", 8), task("b", 14)], [charger(x=12, rate=0.5)]
    )
    assert kinds(judged(given, r="a b")) == ["battery"]
    verdict = judged(given, r="a dock b")
    assert verdict.valid
    assert levels(verdict) == [("a", 12, 12), ("dock", 8, 20), ("b", 18, 18)]
    assert times(verdict) == [("a", 8, 8, 8), ("dock", 12, 12, 36), ("b", 38, 38, 38)]
    assert [stop.charged for stop in stops(verdict)] == [None, 12, None]
    assert (verdict.total_cost, verdict.makespan_s, verdict.routes[0].back_s) == (28, 38, 52)
    assert [visit.task for visit in verdict.routes[0].visits] == ["a", "b"]
    assert verdict.routes[0].tasks == ("a", "b")


def test_a_swap_fills_in_its_own_time():
    given = mission([robot(battery=battery(20, reserve=0.5))], [task("a", 10), task("b", 20)], [swapper(x=10)])
    verdict = judged(given, r="a rack b")
    assert verdict.valid
    assert levels(verdict) == [("a", 10, 10), ("rack", 10, 20), ("b", 10, 10)]
    assert times(verdict)[1:] == [("rack", 10, 10, 70), ("b", 80, 80, 80)]


def test_work_capacity_bounds_the_whole_route_whatever_is_swapped():
    given = mission([robot(battery=battery(20), work_capacity=19)], [task("a", 10), task("b", 20)], [swapper(x=10)])
    assert kinds(judged(given, r="a rack b")) == ["capacity"]


PARTIAL = mission([robot(battery=battery(20, at_start=0.5))], [task("a", 8), task("b", 15)], [charger(x=8, rate=0.5)])


@pytest.mark.parametrize(
    ("amount", "detail"),
    [
        (18, None),
        (5, None),
        (4.999, "its battery holds -0.001 m when it arrives at b, at least 0 m must stay"),
        (0, "its battery holds -5 m when it arrives at b, at least 0 m must stay"),
        (18.1, "charges 18.1 at dock, where its battery takes 18"),
        (-1, "charges -1 at dock; expected a finite amount of at least 0"),
        (float("nan"), "charges nan at dock; expected a finite amount of at least 0"),
    ],
)
def test_an_amount_that_the_plan_says(amount, detail):
    found = [
        f.detail
        for f in verify(PARTIAL, charging(plan(r="a dock b"), None, amount, None)).violations
        if f.kind == "battery"
    ]
    assert found[:1] == ([] if detail is None else [detail])


def test_a_partial_charge_takes_less_time():
    verdict = verify(PARTIAL, charging(plan(r="a dock b"), None, 6, None))
    assert levels(verdict) == [("a", 2, 2), ("dock", 2, 8), ("b", 1, 1)]
    assert times(verdict)[1:] == [("dock", 8, 8, 20), ("b", 27, 27, 27)]


@pytest.mark.parametrize(("amount", "is_wrong"), [(18, False), (None, False), (6, True), (0, True), (18.00001, False)])
@pytest.mark.parametrize("station", [charger(name="dock", x=8, rate=0.5, partial=False), swapper(name="dock", x=8)])
def test_where_a_visit_always_fills(station, amount, is_wrong):
    given = replace(PARTIAL, stations=(station,))
    found = verify(given, charging(plan(r="a dock b"), None, amount, None))
    details = [fault.detail for fault in found.violations if fault.kind == "battery"]
    way = "swap" if station.swaps else "charge"
    assert details[:1] == ([f"charges {amount} at dock, where a {way} always fills: 18"] if is_wrong else [])


def test_a_robot_may_charge_again_and_again():
    given = mission([robot(battery=battery(10))], [task("a", 5), task("b", 14)], [charger(), charger("far", 9)])
    verdict = judged(given, r="a dock dock far b")
    assert verdict.valid
    assert [(name, after - before) for name, before, after in levels(verdict)] == [
        ("a", 0),
        ("dock", 10),
        ("dock", 0),
        ("far", 9),
        ("b", 0),
    ]


def test_a_battery_that_was_too_low_is_said_once_from_one_charge_to_the_next():
    given = mission([robot(battery=battery(4))], [task("a", 5), task("b", 6), task("c", 11)], [charger(x=6)])
    assert [(kind, name) for kind, _, name, _ in faults(judged(given, r="a b dock c"))] == [
        ("battery", "a"),
        ("battery", "c"),
    ]


@pytest.mark.parametrize("usage", ["distance", "time"])
def test_with_usage_in_time_a_battery_holds_seconds_of_travel_and_work(usage):
    keys = {"speed_mps": 2.0, "efficiency": 0.5, "battery": battery(30)}
    given = mission(
        [robot(**keys)], [task("a", 10, duration_s=8, window_s=((50, None),))], [charger(x=12)], usage=usage
    )
    verdict = judged(given, r="a dock")
    assert verdict.valid
    if usage == "time":  # 5 s there, 16 s of work, 1 s on
        assert levels(verdict) == [("a", 25, 9), ("dock", 8, 30)]
        assert times(verdict) == [("a", 5, 50, 66), ("dock", 67, 67, 89)]
    else:
        assert levels(verdict) == [("a", 20, 20), ("dock", 18, 30)]
        assert times(verdict) == [("a", 5, 50, 66), ("dock", 67, 67, 79)]


def test_with_usage_in_time_a_team_draws_what_its_slowest_takes():
    robots = [robot("r", battery=battery(20)), robot("s", efficiency=0.5)]
    given = mission(robots, [task("a", 1, duration_s=5, robots_needed=2)], usage="time")
    assert levels(judged(given, r="a", s="a")) == [("a", 19, 9)]


def test_a_robot_without_a_battery_is_not_charged_and_one_that_unloads_needs_none():
    given = mission([robot()], [task("a", 5)], [charger(x=2), depot(x=3), swapper(x=4)])
    verdict = judged(given, r="dock depot rack a")
    assert verdict.valid
    assert times(verdict)[:3] == [("dock", 2, 2, 2), ("depot", 3, 3, 3), ("rack", 4, 4, 4)]
    assert [(s.arrival_level, s.level_after, s.charged) for s in stops(verdict)] == [(None, None, None)] * 4
    (found,) = verify(given, charging(plan(r="dock a"), 2, None)).violations[:1]
    assert (found.kind, found.task, found.detail) == (
        "stop",
        "dock",
        "charged: the plan says 2, where no battery is charged",
    )


def test_where_batteries_are_ignored_stations_take_their_time_all_the_same():
    given = mission([robot(battery=battery(10))], [task("a", 15), task("b", 30)], [charger(x=15, rate=0.5)])
    verdict = judged(given, "battery", r="a dock b")
    assert verdict.valid
    assert times(verdict)[1:] == [("dock", 15, 15, 35), ("b", 50, 50, 50)]  # full from 0
    verdict = verify(given, charging(plan(r="a dock b"), None, 4, None), "battery")
    assert {fault.kind for fault in verdict.violations} == {"stop"}
    assert times(verdict)[1:] == [("dock", 15, 15, 23), ("b", 38, 38, 38)]


def test_a_route_of_stations_alone():
    given = mission([robot(battery=battery(10), end_position=(1, 0))], [task("a", 5)], [charger(x=4)])
    verdict = judged(given, r="dock")
    assert verdict.valid
    assert (verdict.total_cost, verdict.tasks_completed, verdict.makespan_s) == (7, 0, 0)
    assert (verdict.routes[0].back_s, verdict.routes[0].visits) == (4 + 4 + 3, ())


def test_the_average_counts_the_detour_to_a_station():
    given = mission([robot(battery=battery(10))], [task("a", 5)], [charger(x=-1)], objective="average")
    assert judged(given, r="dock a").value() == 7


# --- travel -----------------------------------------------------------------------------------------------------------


def test_stations_are_rows_of_travel_tables():
    places = ("r", "a", "dock")
    metres = ((0, 9, 3), (9, 0, 4), (5, 6, 0))
    given = mission([robot(type="t", battery=battery(10), return_to_start=True)], [task("a", 1)], [charger(x=1)])
    tables = {"t": TravelTable(places=places, metres=metres)}
    given = replace(given, rules=Rules(travel="matrix"), travel={"t": "t.csv"}, travel_tables=tables)
    verdict = judged(given, r="dock a dock")
    assert verdict.valid
    assert levels(verdict) == [("dock", 7, 10), ("a", 4, 4), ("dock", 0, 10)]
    assert verdict.total_cost == 3 + 6 + 4 + 5
    gone = replace(tables["t"], metres=((0, 9, float("inf")), *metres[1:]))
    verdict = judged(replace(given, travel_tables={"t": gone}), r="dock a")
    assert faults(verdict)[0] == ("unreachable", "r", None, "no way from its start to station dock")


def test_over_a_map_the_way_around_walls_leads_to_stations():
    pytest.importorskip("shapely")
    zone = Zone(polygon=((4, 0), (5, 0), (5, 5), (4, 5)))
    ground = Map(boundary=((0, 0), (10, 0), (10, 10), (0, 10)), zones=(zone,))
    given = mission([robot(x=1, battery=battery(12))], [task("a", 8)], [charger(x=8)])
    moved = [replace(one, position=(one.position[0], 1.0)) for one in (*given.robots, *given.tasks, *given.stations)]
    given = replace(given, map=ground, robots=(moved[0],), tasks=(moved[1],), stations=(moved[2],))
    verdict = judged(given, r="dock a")  # by (4, 5) and (5, 5): 5 + 1 + 5
    assert verdict.valid
    assert levels(verdict)[0] == ("dock", pytest.approx(1), 12)


# --- files and reasons ------------------------------------------------------------------------------------------------


def test_a_plan_with_stations_survives_its_file(tmp_path):
    bare = plan(r="a dock b dock")
    stated = stating(PARTIAL, bare, charged=True)
    assert stated.routes[0].stops[1].charged == 18
    stated.save(tmp_path / "plan.json")
    read = read_plan(tmp_path / "plan.json")
    assert read.routes == stated.routes
    assert verify(PARTIAL, read) == verify(PARTIAL, stated)
    assert verify(PARTIAL, read).valid


def test_stops_are_the_entries_of_the_route_with_the_times_of_the_schedule():
    stated = stating(PARTIAL, plan(r="a dock b dock"))
    (route,) = stated.routes

    def found(change):
        return faults(verify(PARTIAL, replace(stated, routes=(replace(route, stops=change(route.stops)),))))

    assert found(lambda stops: stops) == []
    missing = found(lambda stops: stops[:3])
    assert missing == [("stop", "r", None, "the stops are those of a, dock, b, not of the route's tasks")]
    late = found(lambda stops: (*stops[:3], replace(stops[3], end_s=99)))
    assert late == [("stop", "r", "dock", "end_s: the plan says 99, it is 86.0")]
    mistaken = found(lambda stops: (stops[0], replace(stops[1], is_station=False), *stops[2:]))
    assert mistaken == [("stop", "r", "dock", "the plan says that it is a task, it is a station")]


def test_what_is_neither_task_nor_station_is_left_out():
    verdict = judged(PARTIAL, r="a bay dock b")
    assert faults(verdict) == [("unknown-task", "r", "bay", "no task or station of the mission")]
    no_stations = judged(replace(PARTIAL, stations=()), r="a dock")
    assert faults(no_stations) == [("unknown-task", "r", "dock", "no task of the mission")]


@pytest.mark.parametrize(
    ("x", "cost", "stations", "word", "is_false"),
    [
        (9, 0, (), "battery", False),
        (9, 0, (), "not-chosen", True),
        (2, 0, (), "battery", False),
        (2, 0, (), "not-chosen", False),
        (9, 0, (charger(),), "battery", False),
        (9, 0, (charger(),), "not-chosen", False),
        (9, 20, (charger(),), "not-chosen", True),
        (9, 20, (charger(),), "battery", False),
    ],
)
def test_reasons_of_a_task_that_a_battery_may_be_too_small_for(x, cost, stations, word, is_false):
    given = mission([robot(battery=battery(10, at_start=0.8))], [task("a", x, actuation_cost=cost)], stations)
    assert kinds(judged_reason(given, word, "a", r="")) == (["reason"] if is_false else [])


def test_a_robot_without_a_battery_lacks_no_energy():
    given = mission([robot("r"), robot("s", battery=battery(9))], [task("a", 20)])
    assert kinds(judged_reason(given, "battery", "a", r="", s="")) == ["reason"]
