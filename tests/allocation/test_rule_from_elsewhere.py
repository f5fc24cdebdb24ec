"""A rule that allocation has never heard of: it plans by the primitives, and gives reasons by the rule's own words."""

import math
from dataclasses import replace

import pytest

import muster
from muster.allocation.bounds.feasibility import impossible
from muster.allocation.reasons.explanations import unassigned
from muster.mission.model import Mission, Robot, Task
from muster.model import problem as compiled
from muster.model.problem import Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import Rule

DARK_S = 25.0


class Daylight(Rule):
    """Robots are back before dark."""

    word = "daylight"
    lifted_late = True

    def compile(self, problem, parts):
        for i in range(len(problem.robots)):
            parts.is_over(i, DARK_S)

    def over_late(self, problem, i, over):
        return None if over <= DARK_S else f"it would be back at {over:g} s, in the dark"

    def broken_at(self, tried):
        return self.over_late(tried.problem, tried.i, tried.over) or "another robot would be back in the dark"


class Unspoken(Daylight):
    """The same rule without words of its own."""

    broken_at = Rule.broken_at


@pytest.fixture
def problem():
    robot = Robot(id="r", position=(0, 0), speed_mps=1)
    tasks = (Task(id="near", position=(10, 0)), Task(id="far", position=(20, 0)))
    return Problem.compile(Mission(robots=(robot,), tasks=tasks, rules=muster.Rules(return_to_start=True)))


@pytest.mark.parametrize(
    ("rule", "detail"),
    [
        (Daylight(), "it would be back at 40 s, in the dark"),
        (Unspoken(), "at every place in its route it would break the rule daylight"),
    ],
)
def test_it_is_the_reason_why_a_task_is_left_out(monkeypatch, problem, rule, detail):
    monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), rule))
    assert problem.model.over_by.tolist() == [DARK_S]
    assert problem.model.word_of("over_by") == "daylight"
    (left,) = unassigned(problem, [[problem.task_index["near"]]])
    assert left.task == "far"
    assert [(reason.reason, reason.detail) for reason in left.reasons] == [("daylight", detail)]


def test_it_is_the_reason_why_a_task_can_never_be_done(monkeypatch, problem):
    """What gave the bound is named, and not the rule that ships and looks at bounds of its sort."""
    monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), Daylight()))
    (lost,) = impossible(problem)
    said = "its route would end at 40 s at the earliest, it is to end by 25 s"
    assert [(reason.reason, reason.detail) for reason in lost.reasons] == [("daylight", said)]


@pytest.mark.parametrize(
    ("give", "detail"),
    [
        (lambda parts: parts.ends(0, 15.0), "ends at 20 s at the earliest, its latest end is 15 s"),
        (
            lambda parts: parts.opens(0, [(0, 5)]),
            "arrives at 20 s at the earliest, its last time to begin closes at 5 s",
        ),
    ],
)
def test_the_rule_of_a_bound_that_holds_is_named_and_not_of_one_that_is_wider(monkeypatch, give, detail):
    rule = Daylight()
    rule.compile = lambda problem, parts: give(parts)
    monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), rule))
    task = Task(id="far", position=(20, 0), deadline_s=30, window_s=((0, 30),))
    mission = Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=(task,))
    (lost,) = impossible(Problem.compile(mission))
    assert [(reason.reason, reason.detail) for reason in lost.reasons] == [("daylight", detail)]


def test_where_it_does_not_hold_the_task_fits(monkeypatch, problem):
    monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), Daylight()))
    free = replace(problem, ignored=("daylight",))
    assert math.isinf(free.model.over_by[0])
    (left,) = unassigned(free, [[free.task_index["near"]]])
    assert left.reasons[0].reason == "not-chosen"


@pytest.mark.parametrize(
    ("give", "word"),
    [
        (lambda parts: parts.lasts(0, 9.0), "duty"),
        (lambda parts: parts.rests(0, [(0, 9)]), "rests"),
        (lambda parts: parts.follows(1, 0, least_s=2.0), "lag"),
        (lambda parts: parts.follows(1, 0), None),
    ],
)
def test_what_an_allocator_is_asked_for_follows_from_the_primitives(monkeypatch, problem, give, word):
    class Elsewhere(Rule):
        word = "elsewhere"

        def compile(self, problem, parts):
            give(parts)

    monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), Elsewhere()))
    assert set(problem.asked) == ({word} - {None})
