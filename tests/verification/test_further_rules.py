"""Shifts with breaks, longest duties, stations for certain robots, times on board and alternatives: plans by hand."""

import pytest

from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task
from muster.mission.plan import Plan, Reason, Route, Unassigned
from muster.verification import verify
from muster.verification.rules import RULES
from muster.verification.verdict import KINDS

NEAR, FAR = 1e-12, 1e-6
"""Less than rounding, and more."""


def task(name, x, **keys):
    return Task(id=name, position=(x, 0), **keys)


def robot(name="r", x=0, **keys):
    return Robot(id=name, position=(x, 0), **keys)


def judged(tasks, *routes, robots=(), ignore=(), unassigned=(), **keys):
    robots = robots or (robot(),)
    made = tuple(Route(one.id, tuple(route)) for one, route in zip(robots, routes, strict=True))
    mission = Mission(name="m", rules=Rules(timing="constant"), robots=robots, tasks=tasks, **keys)
    return verify(mission, Plan(routes=made, unassigned=unassigned), ignore)


def said(verdict):
    return [(found.kind, found.robot, found.task, found.detail) for found in verdict.violations]


def times(verdict):
    """By robot what is at its stops: the id, arrival, begin and end."""
    return {
        route.robot: [(stop.name, stop.arrives_s, stop.starts_s, stop.ends_s) for stop in route.stops]
        for route in verdict.routes
    }


def back(verdict, name="r"):
    (route,) = (route for route in verdict.routes if route.robot == name)
    return route.leaves_s, route.back_s


# --- shifts ----------------------------------------------------------------------------------------------------------


def test_work_and_legs_wait_for_a_shift_in_which_they_end():
    shifts = ((0, 10), (20, 30), (40, 50))
    verdict = judged([task("a", 5, duration_s=6)], "a", robots=[robot(shifts_s=shifts, return_to_start=True)])
    assert verdict.valid
    assert times(verdict) == {"r": [("a", 5, 20, 26)]}
    assert back(verdict) == (0, 45)  # from 26 it would be back at 31, in the break


@pytest.mark.parametrize(("ends", "begins"), [(10, 5), (10 - NEAR, 5), (10 - FAR, 20)])
def test_work_that_ends_with_the_shift_is_in_it(ends, begins):
    verdict = judged([task("a", 5, duration_s=5)], "a", robots=[robot(shifts_s=((0, ends), (20, 30)))])
    assert times(verdict)["r"] == [("a", 5, begins, begins + 5)]
    assert verdict.valid


def test_a_leg_longer_than_every_shift_is_named():
    verdict = judged([task("a", 15)], "a", robots=[robot(shifts_s=((0, 10), (20, 34)))])
    detail = "the way to a takes 15 s from 0 s at the earliest; no shift left has room for it"
    assert said(verdict) == [("shift", "r", None, detail)]
    assert judged([task("a", 15)], "a", robots=[robot(shifts_s=((0, 10), (20, 35)))]).valid


def test_work_longer_than_every_shift_is_named():
    tasks, robots = [task("a", 5, duration_s=11)], [robot(shifts_s=((0, 10), (20, 30)))]
    detail = "the work on a takes 11 s from 5 s at the earliest; no shift left has room for it"
    assert said(judged(tasks, "a", robots=robots)) == [("shift", "r", "a", detail)]
    assert judged(tasks, "a", robots=robots, ignore="shift").valid


def test_work_that_a_window_forbids_in_the_next_shift_is_named():
    robots = [robot(shifts_s=((0, 10), (20, 40)))]
    detail = (
        "the work on a takes 6 s from 5 s at the earliest; that is not within a shift, and in the next one other limits"
    )
    verdict = judged([task("a", 5, duration_s=6, window_s=(0, 19))], "a", robots=robots)
    assert said(verdict) == [("shift", "r", "a", f"{detail} forbid it")]
    assert judged([task("a", 5, duration_s=6, window_s=(0, 20))], "a", robots=robots).valid


def test_the_way_to_the_end_is_in_a_shift_too():
    robots = [robot(shifts_s=((0, 10), (20, 24.5)), return_to_start=True)]
    detail = "the way to its end takes 5 s from 10 s at the earliest; no shift left has room for it"
    assert said(judged([task("a", 5, duration_s=5)], "a", robots=robots)) == [("shift", "r", None, detail)]


def test_a_team_works_when_all_its_members_have_a_shift():
    robots = [robot("r", shifts_s=((0, 10), (20, 30))), robot("s", shifts_s=((5, 24), (27, 60)))]
    verdict = judged([task("a", 0, duration_s=3, robots_needed=2)], "a", "a", robots=robots)
    assert verdict.valid
    assert times(verdict)["r"] == [("a", 0, 5, 8)]
    verdict = judged([task("a", 0, duration_s=5, robots_needed=2)], "a", "a", robots=robots)
    assert times(verdict)["r"] == [("a", 0, 5, 10)]
    verdict = judged([task("a", 0, duration_s=5, robots_needed=2, window_s=(6, 90))], "a", "a", robots=robots)
    assert [kind for kind, *_ in said(verdict)] == ["shift"]  # 4 s from 20, 3 s from 27: nowhere 5
    verdict = judged([task("a", 0, duration_s=4, robots_needed=2, window_s=(8, 90))], "a", "a", robots=robots)
    assert times(verdict)["s"] == [("a", 5, 20, 24)]


def test_a_prerequisite_waits_for_a_shift_and_its_dependant_for_it():
    robots = [robot("r", shifts_s=((0, 4), (20, 30))), robot("s")]
    verdict = judged([task("a", 0, duration_s=5), task("b", 0, prerequisites=("a",))], "a", "b", robots=robots)
    assert verdict.valid
    assert times(verdict)["s"] == [("b", 0, 25, 25)]


def test_a_robot_charges_in_its_break():
    dock = Station(id="dock", position=(5, 0), services=("charge",), charge_per_s=1)
    robots = [robot(battery=Battery(capacity=10), shifts_s=((0, 6), (10, 30)))]
    verdict = judged([task("a", 11)], ("dock", "a"), robots=robots, stations=[dock])
    assert verdict.valid
    assert times(verdict)["r"] == [("dock", 5, 5, 10), ("a", 16, 16, 16)]


def test_service_ends_with_the_last_shift():
    dock = Station(id="dock", position=(5, 0), services=("charge",), charge_per_s=1)
    robots = [robot(battery=Battery(capacity=10), shifts_s=((0, 6), (7, 9)))]
    detail = "its route ends at 10 s at the earliest, it is available until 9 s"
    assert said(judged([], ("dock",), robots=robots, stations=[dock])) == [("shift", "r", None, detail)]


def test_one_shift_and_shifts_that_touch_are_the_keys_of_availability():
    one = robot(shifts_s=((5, 20), (20, 40)))
    assert (one.shifts_s, one.available_from_s, one.available_until_s) == ((), 5, 40)
    assert one == robot(available_from_s=5, available_until_s=40)


# --- duties ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("longest", "valid"), [(10, True), (10 - NEAR, True), (10 - FAR, False)])
def test_waiting_at_the_start_is_no_duty(longest, valid):
    robots = [robot(longest_duty_s=longest, return_to_start=True)]
    verdict = judged([task("a", 5, window_s=(50, 60))], "a", robots=robots)
    assert verdict.valid == valid
    if valid:
        assert back(verdict) == pytest.approx((45, 55))


def test_a_duty_that_is_too_long_is_named_and_can_be_ignored():
    tasks = [task("a", 5, window_s=(0, 10)), task("b", 5, window_s=(50, 60))]
    detail = "its duty, from leaving its start to the end of its route, takes 50 s at the earliest times"
    robots = [robot(longest_duty_s=44)]
    verdict = judged(tasks, "ab", robots=robots)
    assert said(verdict) == [("duty", "r", None, f"{detail}, and at none at most 44 s")]
    assert judged(tasks, "ab", robots=robots, ignore="duty").valid
    assert judged(tasks, "ab", robots=[robot(longest_duty_s=45)]).valid


def test_a_duty_binds_robots_that_wait_for_each_other():
    tasks = [task("a", 5, robots_needed=2), task("b", 20)]
    robots = [robot("r", longest_duty_s=5), robot("s", x=30)]
    verdict = judged(tasks, "a", "ba", robots=robots)
    assert verdict.valid
    assert back(verdict)[0] == 20
    assert times(verdict)["r"] == [("a", 25, 25, 25)]


def test_only_the_duty_that_cannot_be_kept_is_named():
    tasks = [task("a", 5, window_s=(50, 60)), task("b", 5)]
    robots = [robot("r", longest_duty_s=5), robot("s", longest_duty_s=4)]
    assert [found[:2] for found in said(judged(tasks, "a", "b", robots=robots))] == [("duty", "s")]


def test_a_break_counts_for_a_duty():
    keys = {"shifts_s": ((0, 8), (20, 30)), "return_to_start": True}
    tasks = [task("a", 5)]
    assert judged(tasks, "a", robots=[robot(longest_duty_s=10, **keys)]).valid  # leaves at 20
    keys["shifts_s"] = ((0, 8), (20, 26))
    verdict = judged(tasks, "a", robots=[robot(longest_duty_s=20, **keys)])
    assert [kind for kind, *_ in said(verdict)] == ["duty"]  # 3 to 25 at the least
    assert judged(tasks, "a", robots=[robot(longest_duty_s=22, **keys)]).valid


# --- on board --------------------------------------------------------------------------------------------------------


def transport(longest, **keys):
    return [task("a", 5, load=1), task("b", 9, delivers="a", longest_aboard_s=longest, **keys)]


@pytest.mark.parametrize(("longest", "valid"), [(4, True), (4 - NEAR, True), (4 - FAR, False)])
def test_time_on_board_is_that_between_end_and_begin(longest, valid):
    tasks = transport(longest, duration_s=7)
    assert judged(tasks, "ab").valid == valid


def test_what_is_not_to_be_long_on_board_is_taken_on_later():
    verdict = judged(transport(6, window_s=(50, 60)), "ab")
    assert verdict.valid
    assert times(verdict)["r"] == [("a", 5, 44, 44), ("b", 48, 50, 50)]


def test_a_time_on_board_that_is_too_long_is_named_and_can_be_ignored():
    detail = (
        "the way on board from the end of a to the begin of b takes 4 s at the earliest times, and at none at most 3 s"
    )
    assert said(judged(transport(3), "ab")) == [("aboard", "r", "b", detail)]
    assert judged(transport(3), "ab", ignore="aboard").valid
    assert judged(transport(3), "ab", ignore="load").valid


def test_a_delivery_that_comes_first_breaks_the_rule_of_loads_alone():
    assert [kind for kind, *_ in said(judged(transport(3), "ba"))] == ["load"]


# --- alternatives ----------------------------------------------------------------------------------------------------

EITHER = (task("a", 5), task("b", 9, either_or=("a",)), task("c", 1, either_or=("b",)), task("d", 2))


def test_at_most_one_of_a_set_is_done():
    detail = "b is in the plan too; expected at most one of a, b, c"
    verdict = judged(EITHER, "cdb")
    assert said(verdict) == [("either-or", "r", "c", detail)]
    assert judged(EITHER, "cdb", ignore="either-or").valid
    assert [name for *_, name, _ in said(judged(EITHER, "abcd"))] == ["b", "c"]


def test_what_another_stands_for_is_not_missing():
    verdict = judged(EITHER, "bd")
    assert verdict.valid
    assert (verdict.tasks_completed, verdict.tasks_total) == (2, 2)
    assert judged(EITHER, "bd", ignore="either-or").tasks_total == 4


@pytest.mark.parametrize(
    ("route", "name", "reason", "valid"),
    [
        ("a", "b", "either-or", True),
        ("a", "b", "not-chosen", False),
        ("a", "d", "either-or", False),
        ("a", "d", "not-chosen", True),
        ("d", "b", "either-or", False),
        ("d", "b", "not-chosen", True),
    ],
)
def test_the_reason_either_or_is_checked(route, name, reason, valid):
    left = [one.id for one in EITHER if one.id not in route]
    reasons = {one: "either-or" if route == "a" and one != "d" else "not-chosen" for one in left} | {name: reason}
    unassigned = tuple(Unassigned(one, (Reason("r", why, ""),)) for one, why in reasons.items())
    verdict = judged(EITHER, route, unassigned=unassigned)
    assert verdict.valid == valid
    assert {found.kind for found in verdict.violations} <= {"reason"}


# --- stations for certain robots -------------------------------------------------------------------------------------


def test_a_station_may_be_for_certain_robots():
    depot = Station(id="depot", position=(1, 0), services=("unload",), only_robots=("s",))
    robots = [robot("r"), robot("s")]
    verdict = judged([], ("depot",), ("depot",), robots=robots, stations=[depot])
    assert said(verdict) == [("lock", "r", None, "calls at depot, only for s")]
    assert judged([], ("depot",), ("depot",), robots=robots, stations=[depot], ignore="lock").valid


# --- the rules of the judge ------------------------------------------------------------------------------------------


def test_the_judge_finds_its_rules_in_an_order_of_its_own():
    kinds = [rule.kind for rule in RULES]
    assert kinds[:6] == ["skill", "skill", "suitability", "lock", "team", "relation"]
    assert kinds[-5:] == ["shift", "aboard", "duty", "either-or", "min-tasks"]
    assert set(kinds) <= set(KINDS)
    assert len(RULES) == 19
