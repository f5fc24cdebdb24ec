"""Calls at stations, levels of batteries and goods on board, while plans are carried out in the simulated world."""

import math
from dataclasses import replace

import pytest
from tests.carry_charge import battery, charger, depot, mission, plan, robot, swapper, task
from tests.running.test_live import WorldAsFleet

from muster.execution import status_of
from muster.execution.robots.robot_state import Activity
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.mission.plan import RouteStop
from muster.running.live import Live
from muster.running.simulation import Simulation
from muster.state.recovery import recovered_from


def carried_out(given, ignore=(), each=None, charged=None, **routes):
    """The simulation at its end; `each` is called with it all along; `charged`: by station what each call adds."""
    how = routes.pop("how", {})
    simulation = Simulation(given, with_charges(plan(**routes), charged or {}), ignore=ignore, **how)
    while not simulation.done and simulation.time_s < 1_000:
        simulation.advance(simulation.time_s + 0.5)
        if each is not None:
            each(simulation)
    assert simulation.done
    return simulation


def with_charges(what, charged):
    def stops(route):
        return tuple(RouteStop(n, 0.0, 0.0, 0.0, n in charged, charged.get(n)) for n in route.tasks)

    return replace(what, routes=tuple(replace(one, stops=stops(one)) for one in what.routes)) if charged else what


def happened(simulation, *kinds):
    return [(round(e.time_s, 1), e.data.get("robot")) for e in simulation.events if e.kind in kinds]


def test_a_robot_charges_between_its_tasks():
    given = mission([robot(battery=battery(30))], [task("a", 20), task("b", 2)], [charger(x=12, rate=2)])
    report = carried_out(given, r="a dock b").result()
    assert report.tasks_done == ("a", "b")
    assert report.robots[0].station_visits == 1
    assert report.robots[0].charged == pytest.approx(28, abs=0.1)
    assert report.robots[0].least_charge == pytest.approx(2 / 30, abs=0.01)
    assert report.robots[0].charge == pytest.approx(20 / 30, abs=0.01)


def test_robots_are_served_in_the_order_of_their_arrival_and_wait_for_slots():
    robots = [robot(name, x, battery=battery(60, 0.5)) for name, x in (("b", 2), ("a", -2), ("c", 1))]
    given = mission(robots, [task(f"t{k}", 20 + k) for k in range(3)], [charger(rate=3)])
    words = set()

    def look(simulation):
        for one in simulation.status.robots.values():
            words.add(one.activity)
            words.add(one.waits)

    done = carried_out(given, each=look, a="dock t0", b="dock t1", c="dock t2")
    assert [name for _, name in happened(done, "service_begins")] == ["c", "a", "b"]
    ends = [at for at, _ in happened(done, "service_ends")]
    begins = [at for at, _ in happened(done, "service_begins")]
    assert begins[1:] == ends[:-1]
    assert {"driving to dock", "queueing at dock", "charging at dock", "waits for a slot at dock: c"} <= words
    told = done.result()
    assert told.waiting_by_cause_s["slot"] == pytest.approx(sum(row.slot_wait_s for row in told.robots))
    assert told.waiting_by_cause_s["slot"] > 10


def test_bodies_wait_where_they_are_until_a_slot_will_be_free():
    places = {"a": (2, 0), "b": (8, 2), "c": (8, -2)}
    robots = [robot(name, battery=battery(60, 0.5), radius_m=0.3) for name in places]
    robots = [replace(one, position=places[one.id]) for one in robots]
    given = mission(robots, [task(f"t{k}", 20 + k) for k in range(3)], [charger(rate=2)])
    queue = {"b": [], "c": []}

    def look(simulation):
        for name, seen in queue.items():
            if simulation.status.robots[name].activity == "queueing at dock":
                seen.append(simulation._executor.crew[name].position[:2])

    done = carried_out(given, each=look, a="dock t0", b="dock t1", c="dock t2")
    assert all(seen[0] == places[name] and math.hypot(*seen[-1]) < 1 for name, seen in queue.items())
    begins, ends = happened(done, "service_begins"), happened(done, "service_ends")
    assert [name for _, name in begins] == ["a", "b", "c"]
    assert all(begin - end < 0.5 for (begin, _), (end, _) in zip(begins[1:], ends, strict=False))  # no slot is idle
    assert done.result().contacts == 0


def test_a_fleet_that_uses_more_than_planned_charges_for_that():
    tasks = [*(task(f"t{k}", k + 1) for k in range(6)), task("far", 40)]
    given = mission([robot(battery=battery(60, 0.5, reserve=0.1))], tasks, [charger(x=6, rate=5)])
    learnt = []

    def use_more(simulation):
        usage, state = simulation._executor.ledger.usage, simulation._executor.crew["r"]
        usage |= {name: (planned, 1.3 * planned) for name, (planned, _) in usage.items()}
        if state.activity is Activity.SERVED:
            learnt.append(state.energy.detours)

    done = carried_out(given, each=use_more, charged={"dock": 16.0}, r="t0 t1 t2 t3 t4 t5 dock far")
    assert learnt[0] == pytest.approx(1.25, abs=0.01)  # when the sixth task was done 1.3 was known of five
    charged = done._executor.crew["r"].energy.added
    assert charged == pytest.approx(1.25 * 34 + 6 + 1.2 - 24, abs=0.5)  # 24 are left, 6 stay; 2 % more than needed


def test_a_swap_takes_its_time_and_fills_the_battery():
    given = mission([robot(battery=battery(20))], [task("a", 10), task("b", 25)], [swapper(x=10, swap_s=6)])
    done = carried_out(given, r="a rack b")
    begin, end = (happened(done, kind)[0][0] for kind in ("service_begins", "service_ends"))
    assert end - begin == pytest.approx(6, abs=0.2)
    assert done.result().robots[0].charge == pytest.approx(5 / 20, abs=0.01)


def test_unloading_puts_down_what_no_task_delivers():
    tasks = [task("a", 1, load=1), task("b", 2, load=1), task("c", 9, delivers="b")]
    given = mission([robot(load_capacity=2)], tasks, [depot(x=4)])
    loads = set()
    done = carried_out(given, each=lambda s: loads.add(s.status.robots["r"].on_board.get("", 0)), r="a b depot c")
    goods = done._executor.goods
    assert (goods.unloaded, goods.delivered, goods.on_board["r"]) == ({"": 1}, {"": 1}, [])
    assert loads == {0, 1, 2}


@pytest.mark.parametrize(("route", "why"), [("b a", "does not have on board"), ("a c b", "on board with it, of 1")])
def test_a_task_that_does_not_fit_what_is_on_board_is_refused(route, why):
    tasks = [task("a", 1, load=1), task("b", 2, delivers="a"), task("c", 3, load=1)]
    done = carried_out(mission([robot(load_capacity=1)], tasks), r=route)
    refused = [event.data["reason"] for event in done.events if event.kind == "task_refused"]
    assert why in refused[0]
    assert done._executor.goods.delivered == {"": 1}


def test_a_battery_that_drains_faster_is_charged_earlier():
    given = mission([robot(battery=battery(50, reserve=0.1))], [task("a", 20), task("b", 22)], [charger(x=18, rate=5)])
    usual = carried_out(given, r="a b")
    assert usual.result().robots[0].station_visits == 0
    hungry = carried_out(given, r="a b", how={"drain": {"all": 2.2}})
    assert hungry.result().robots[0].station_visits == 1
    assert hungry.result().tasks_done == ("a", "b")
    drains = [event.data["drain"] for event in hungry.events if event.kind == "energy_low"]
    assert drains[0] == pytest.approx(2.2, abs=0.05)


def test_robots_are_planned_again_when_their_station_fails_and_when_it_returns():
    stations = [charger("near", 10, rate=5), charger("far", -10, rate=5)]
    given = mission([robot(battery=battery(24))], [task("a", 8), task("b", 30)], stations)
    events = (Event(at_s=11, station_fails="near"), Event(at_s=40, station_returns="near"))
    done = carried_out(replace(given, events=events), r="a near b")
    kinds = [event.kind for event in done.events]
    assert kinds.index("station_fails") < kinds.index("replanned") < kinds.index("station_returns")
    served = [event.data["station"] for event in done.events if event.kind == "service_begins"]
    assert served == ["near", "near"]  # until it fails, and again: the other one is too far
    assert done.result().tasks_done == ("a", "b")


def test_the_load_of_a_robot_that_dies_is_fetched_where_it_lies():
    tasks = [task("a", 5, load=1, duration_s=1), task("b", 30, delivers="a")]
    given = mission([robot("r", 0, load_capacity=1), robot("s", -5, load_capacity=1)], tasks)
    done = carried_out(replace(given, events=(Event(at_s=16, robot_fails="r"),)), r="a b", s="")
    ledger, goods = done._executor.ledger, done._executor.goods
    lies = next(event for event in done.events if event.kind == "load_lies")
    assert lies.data["task"] == "a"
    assert lies.data["position"][0] == pytest.approx(15, abs=0.2)
    assert ledger.done_by == {"a": "s", "b": "s"}
    assert (goods.taken, goods.delivered, goods.lying) == ({"": 1}, {"": 1}, {})


def test_only_who_carries_a_load_delivers_it():
    tasks = [task("a", 5, load=1), task("b", 30, delivers="a")]
    given = mission([robot("r", 0, load_capacity=1), robot("s", 28, load_capacity=1)], tasks)
    done = carried_out(replace(given, events=(Event(at_s=10, new_task=task("c", 40)),)), r="a b", s="")
    assert done._executor.ledger.done_by == {"a": "r", "b": "r", "c": "s"}


def test_a_robot_that_is_served_is_free_when_that_is_over_and_has_the_level_of_then():
    given = mission([robot(battery=battery(40, 0.5))], [task("a", 30)], [charger(rate=1)])
    simulation = Simulation(given, plan(r="dock a"))
    while status_of(simulation._executor).robots["r"].activity != "charging at dock":
        simulation.advance(simulation.time_s + 0.5)
    simulation.advance(simulation.time_s + 5)
    (snapshot,) = simulation._executor._rest().crew
    assert snapshot.energy.level == pytest.approx(40)
    assert snapshot.free_s == pytest.approx(20, abs=0.5)


@pytest.mark.parametrize("more", [(), (Event(at_s=20.5, cancel_task="n"),)])
def test_a_robot_that_is_served_stays_for_all_that_a_new_plan_asks(more):
    robots = [robot(name, x, battery=battery(60, 0.3, reserve=0.1)) for name, x in (("a", -4), ("b", 6))]
    given = mission(robots, [task("t0", 20), task("t1", 24)], [charger(rate=1)])
    events = (Event(at_s=20, new_task=task("n", -8)), *more)
    done = carried_out(replace(given, events=events), charged={"dock": 25.0}, a="dock t0", b="dock t1")
    assert done.result().tasks_done == tuple(sorted({"t0", "t1", "n"} - {event.cancel_task for event in more}))
    begins, ends = happened(done, "service_begins"), happened(done, "service_ends")
    assert [name for _, name in begins if name == "a"] == ["a"]  # one visit
    assert begins[0][0] < 20 < ends[0][0]
    assert all(begin >= end for (begin, _), (end, _) in zip(begins[1:], ends, strict=False))


def test_no_station_that_was_in_reach_once_is_called_at_for_a_task_that_came_later():
    given = mission([robot(battery=battery(20, 0.5))], [task("a", 8)], [charger(x=1)])
    given = replace(given, events=(Event(at_s=15, new_task=task("b", 12)),))
    simulation = carried_out(given, r="a")
    assert not happened(simulation, "goes_to_station", "robot_fails")
    assert simulation.result().tasks_done == ("a",)
    (lost,) = (event for event in simulation.events if event.kind == "lost")
    assert lost.data["reason"].startswith("battery: ")


def test_an_empty_robot_counts_as_failed_where_it_is():
    given = mission([robot("r", battery=battery(20)), robot("s", -9)], [task("a", 30)])
    done = carried_out(given, ignore="battery", r="a", s="")
    assert [name for _, name in happened(done, "robot_stuck")] == ["r"]  # the body stops, and nobody counts with that
    failed = carried_out(given, r="a", s="", how={"batteries": {"r": 0.3}})
    assert failed._executor.ledger.done_by == {"a": "s"}


def test_an_unknown_station_is_refused():
    simulation = Simulation(mission([robot()], [task("a", 5)], [charger()]), plan(r="a"))
    with pytest.raises(ParameterError, match="station"):
        simulation.report(Event(at_s=0, station_fails="quay"))


def test_goods_and_levels_are_known_after_a_crash():
    tasks = [
        *(task(name, x, load=1) for name, x in (("a", 2), ("b", 4), ("c", 6), ("d", 8))),
        task("e", 9, delivers="d"),
    ]
    robots = [robot("r", battery=battery(50), load_capacity=3), robot("s", 20, load_capacity=2)]
    given = mission(robots, tasks, [depot(x=3)])

    def did(at_s, name, of="r"):
        return {"time_s": at_s, "kind": "ends", "data": {"task": name, "robot": of, "used": at_s, "usage": [1.0, 1.0],
                "arrival_usage": at_s}}  # fmt: skip

    log = [
        did(2, "a"),
        {
            "time_s": 3,
            "kind": "service_ends",
            "data": {"robot": "r", "station": "depot", "unloaded": {"": 1.0}, "used": 3.0, "charge": 0.5},
        },
        did(5, "b"),
        did(6, "c", "s"),
        {"time_s": 7, "kind": "robot_fails", "data": {"robot": "s"}},
        {"time_s": 7, "kind": "load_lies", "data": {"task": "c", "robot": "s", "position": [11, 0], "load": {"": 1.0}}},
        did(9, "d"),
    ]
    planned = plan(r="a depot b d e c")
    state = recovered_from(given, planned, log)
    assert state.tasks["c"].position == (11, 0)
    live = Live(given, planned, WorldAsFleet(given), state=state)
    executor = live.executor
    assert executor.goods.load("r") == {"": 2}  # of b and d
    assert (executor.goods.unloaded, executor.goods.lying, executor.goods.load("s")) == ({"": 1}, {"c": {"": 1}}, {})
    assert executor.crew["r"].energy.level == pytest.approx(0.5 * 50 - 6)
    assert executor.crew["r"].calls == []
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
    assert set(live.result().tasks_done) == {"a", "b", "c", "d", "e"}
    assert (executor.goods.taken, executor.goods.delivered) == ({"": 4}, {"": 1})
