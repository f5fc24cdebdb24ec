"""Tasks and robots without the rules that a caller ignores."""

from dataclasses import fields

import pytest

from muster.mission.ignorable_rules import IGNORABLE, as_it_holds, timed_keys
from muster.mission.model import Battery, Lag, Robot, Task

AT = {"id": "x", "position": (0, 0)}
ITEMS = (
    Task(**AT, prerequisites=("s",), lags={"s": Lag(after_s=1)}, window_s=((0, 5),), deadline_s=9, load=3),
    Task(**AT, robots_needed=2, same_robot_as=("a",), other_robot_than=("b",), starts_with=("c",)),
    Task(**AT, either_or=("a",), delivers="b", longest_aboard_s=4),
    Robot(**AT, longest_duty_s=9, min_tasks=2, shifts_s=((0, 3), (5, 9))),
    Robot(**AT, available_until_s=9, battery=Battery(capacity=5), load_capacity=4, load_at_start=1),
)


def test_without_all_rules_what_they_state_is_as_by_default():
    plain = Task(**AT, prerequisites=("s",)), Task(**AT), Task(**AT), Robot(**AT), Robot(**AT)
    assert tuple(as_it_holds(item, IGNORABLE) for item in ITEMS) == plain


@pytest.mark.parametrize("rule", IGNORABLE)
def test_without_one_rule_all_else_is_as_stated(rule):
    for item in ITEMS:
        left = as_it_holds(item, (rule,))
        changed = {f.name for f in fields(item) if getattr(left, f.name) != getattr(item, f.name)}
        keys = {key for key in timed_keys(rule) if item.states(key)}
        beside = {f.name for f in fields(item) if f.metadata.get("beside") in keys and item.states(f.name)}
        assert changed == keys | beside


def test_every_key_of_a_rule_is_one_of_tasks_or_robots():
    known = {f.name for cls in (Task, Robot) for f in fields(cls)}
    assert known.issuperset(key for rule in IGNORABLE for key in timed_keys(rule))
