"""Goods: what is on board, by commodity, and pairs of tasks of which one delivers what the other takes on."""

import pytest
from tests.carry_charge import depot, faults, judged, kinds, loads, mission, robot, task

from muster.mission.plan import Plan, Reason, Route, Unassigned
from muster.verification import verify


def test_loads_by_commodity_after_each_stop():
    keys = {"load_capacity": {"parcels": 3, "water_l": 10}, "load_at_start": {"water_l": 8}}
    tasks = [task("a", load={"parcels": 2}), task("b", load={"parcels": 1, "water_l": -5}), task("c")]
    verdict = judged(mission([robot(**keys)], tasks), r="a b c")
    assert verdict.valid
    both = {"parcels": 3, "water_l": 3}
    assert loads(verdict) == [{"parcels": 2, "water_l": 8}, both, both]


def test_a_load_above_capacity_is_named_once_for_all_stops_that_it_lasts():
    tasks = [task("a", load=4), task("b", load=4), task("c"), task("d", load=-7), task("e", load=4.5)]
    given = mission([robot(load_capacity=5)], tasks)
    verdict = judged(given, r="a b c d e")
    assert faults(verdict) == [
        ("load", "r", "b", "8 on board after it; expected 0 to 5"),
        ("load", "r", "e", "5.5 on board after it; expected 0 to 5"),
    ]
    assert judged(given, "load", r="a b c d e").valid


def test_less_than_nothing_cannot_be_on_board():
    given = mission([robot(load_capacity=5, load_at_start=2)], [task("a", load=-3)])
    assert faults(judged(given, r="a")) == [("load", "r", "a", "-1 on board after it; expected 0 to 5")]


def test_a_commodity_that_a_capacity_does_not_name_is_not_carried_and_without_capacities_all_is():
    tasks = [task("a", load={"sand_kg": 1})]
    verdict = judged(mission([robot(load_capacity={"parcels": 9})], tasks), r="a")
    assert faults(verdict) == [("load", "r", "a", "1 sand_kg on board after it; expected 0 to 0 sand_kg")]
    assert judged(mission([robot()], tasks), r="a").valid
    below = judged(mission([robot()], [task("a", load={"sand_kg": -1})]), r="a")
    assert faults(below) == [("load", "r", "a", "-1 sand_kg on board after it; expected 0 to any amount")]


def test_rounding_is_no_breach():
    tasks = [task(str(k), load=0.1) for k in range(10)] + [task("down", load=-1)]
    verdict = judged(mission([robot(load_capacity=1)], tasks), r=" ".join([*map(str, range(10)), "down"]))
    assert verdict.valid
    assert loads(verdict)[-1] == {}


def test_unloading_lets_a_robot_take_several_trips():
    tasks = [task(name, x, load=3) for name, x in (("a", 4), ("b", 5), ("c", 6))]
    given = mission([robot(load_capacity=6)], tasks, [depot(x=1)])
    assert kinds(judged(given, r="a b c")) == ["load"]
    verdict = judged(given, r="a b depot c depot")
    assert verdict.valid
    assert loads(verdict) == [{"": 3}, {"": 6}, {}, {"": 3}, {}]
    assert verdict.total_cost == 5 + 4 + 5 + 5
    assert verdict.tasks_completed == 3
    assert verdict.makespan_s == 14


# --- pairs ------------------------------------------------------------------------------------------------------------

PAIR = [task("p", 2, load=3), task("d", 5, delivers="p"), task("x", 3, load=2)]


def test_what_is_delivered_leaves_the_robot_where_it_is_delivered():
    verdict = judged(mission([robot(load_capacity=5)], PAIR), r="p x d")
    assert verdict.valid
    assert loads(verdict) == [{"": 3}, {"": 5}, {"": 2}]


def test_a_delivery_may_take_on_a_load_of_its_own():
    tasks = [task("p", load=3), task("d", delivers="p", load=2)]
    verdict = judged(mission([robot(load_capacity=3)], tasks), r="p d")
    assert verdict.valid
    assert loads(verdict) == [{"": 3}, {"": 2}]


def test_unloading_leaves_what_is_to_be_delivered_on_board():
    given = mission([robot(load_capacity=5)], PAIR, [depot()])
    verdict = judged(given, r="p x depot d depot")
    assert verdict.valid
    assert loads(verdict) == [{"": 3}, {"": 5}, {"": 3}, {}, {}]


def test_unloading_a_load_that_was_put_down_does_not_put_it_down_again():
    given = mission([robot(load_capacity=3)], PAIR, [depot()])
    verdict = judged(given, r="p depot d x")
    assert verdict.valid
    assert loads(verdict) == [{"": 3}, {"": 3}, {}, {"": 2}]


@pytest.mark.parametrize(
    ("routes", "found"),
    [
        ({"r": "p", "s": "d"}, [("s", "d", "delivers what p takes on board, which r does; expected the same robot")]),
        ({"r": "p"}, [("r", "p", "takes on board what d delivers, which is not in the plan")]),
        ({"r": "d"}, [("r", "d", "delivers what p takes on board, which is not in the plan")]),
        ({"r": "d p"}, [("r", "d", "comes before p, which takes on board what it delivers")]),
        ({"r": "d x p"}, [("r", "d", "comes before p, which takes on board what it delivers")]),
    ],
)
def test_a_pair_that_is_not_done_as_one(routes, found):
    given = mission([robot("r", load_capacity=5), robot("s", load_capacity=5)], PAIR)
    verdict = judged(given, **routes)
    assert faults(verdict) == [("load", *one) for one in found]
    assert judged(given, "load", **routes).valid
    assert verdict.makespan_s is not None


def test_a_pair_that_waits_for_another_robot_that_waits_for_it_deadlocks():
    tasks = [task("p", load=1), task("d", delivers="p"), task("y", prerequisites=("d",)), task("z")]
    tasks[0] = task("p", load=1, prerequisites=("z",))
    verdict = judged(mission([robot("r"), robot("s")], tasks), r="p d", s="y z")
    assert kinds(verdict) == ["deadlock"]


# --- reasons ----------------------------------------------------------------------------------------------------------


def judged_reason(given, word, name, **routes):
    done = {one for text in routes.values() for one in text.split()}
    left_out = [
        Unassigned(one.id, (Reason("r", word, "..."),) if one.id == name else ())
        for one in given.tasks
        if one.id not in done
    ]
    stated = tuple(Route(robot, tuple(text.split())) for robot, text in routes.items())
    return verify(given, Plan(routes=stated, unassigned=tuple(left_out)))


@pytest.mark.parametrize(
    ("load", "word", "is_false"),
    [
        (9, "load", False),
        (9, "not-chosen", True),
        (-9, "load", False),
        (2, "not-chosen", False),
        (2, "load", True),  # the robot could do it as the plan is
        (4, "load", False),  # 3 are on board, of 5
        (4, "not-chosen", True),
        (None, "load", True),
        (None, "capacity", True),
        (None, "not-chosen", False),
    ],
)
def test_reasons_of_a_task_with_a_load(load, word, is_false):
    given = mission([robot(load_capacity=5)], [task("a", load=3), task("b", load=load)])
    verdict = judged_reason(given, word, "b", r="a")
    assert kinds(verdict) == (["reason"] if is_false else [])


@pytest.mark.parametrize("word", ["load", "capacity", "not-chosen"])
def test_reasons_of_pairs_are_undecided(word):
    given = mission([robot(load_capacity=5, work_capacity=100)], PAIR)
    verdict = judged_reason(given, word, "p", r="x")
    assert kinds(verdict) == []
    assert verdict.reasons_undecided == 1


def test_a_robot_that_cannot_hold_what_is_to_be_delivered_can_do_neither():
    given = mission([robot(load_capacity=2)], PAIR)
    for name in ("p", "d"):
        assert kinds(judged_reason(given, "load", name, r="")) == []
        assert kinds(judged_reason(given, "not-chosen", name, r="")) == ["reason"]
