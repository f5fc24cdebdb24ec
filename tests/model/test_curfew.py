"""A rule from elsewhere that gives ends and openings is said in its own words: by check, by allocators and in runs."""

import pytest
from tests.execution.test_executor import carried_out, plan_of

from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import impossible
from muster.execution.reports.report import report_of
from muster.mission.model import DelayedTask, Event
from muster.model import problem as compiled
from muster.model.problem import Problem
from muster.model.rules import all_rules
from muster.model.rules.rule import Rule

OPENS_S, CLOSES_S = 10.0, 30.0


class Curfew(Rule):
    """Nothing is done, or nobody is out, but in some hours; which of the two the word of the limit says."""

    word = "curfew"
    lifted_late = True

    def __init__(self, limit):
        self.limit = limit

    def compile(self, problem, parts):
        for k in range(parts.tasks):
            if self.limit == "openings":
                parts.opens(k, [(OPENS_S, CLOSES_S)])
            elif self.limit == "ends_by":
                parts.ends(k, CLOSES_S)
        for k in range(parts.robots):
            if self.limit == "over_by":
                parts.is_over(k, CLOSES_S)
            elif self.limit == "lasts_most":
                parts.lasts(k, CLOSES_S)
            elif self.limit == "spans":
                parts.rests(k, [(0, OPENS_S), (CLOSES_S, None)])


class Spoken(Curfew):
    """The same with words of its own."""

    def never(self, problem, i, j, outlook):
        return "too far for one night"


@pytest.fixture
def holds(monkeypatch):
    """Lets a rule hold beside those that ship."""
    return lambda rule: monkeypatch.setattr(compiled, "all_rules", lambda: (*all_rules(), rule))


def mission(*events, far=50.0, robots=1):
    tasks = tuple(Task(id=name, position=(x, 0), duration_s=5) for name, x in (("near", 5.0), ("far", far)))
    crew = tuple(Robot(id=f"r_{k}", position=(0, 0)) for k in range(robots))
    return Mission(rules=Rules(return_to_start=True), robots=crew, tasks=tasks, events=events)


@pytest.mark.parametrize(
    ("limit", "detail"),
    [
        ("openings", "arrives at 50 s at the earliest, its last time to begin closes at 30 s"),
        ("ends_by", "ends at 55 s at the earliest, its latest end is 30 s"),
        ("over_by", "its route would end at 105 s at the earliest, it is to end by 30 s"),
        ("lasts_most", "takes at least 105 s from its start to the end of its route, it may take at most 30 s"),
    ],
)
def test_check_says_it_in_the_word_of_the_rule_that_gave_it(holds, limit, detail):
    for rule, said in ((Curfew(limit), detail), (Spoken(limit), "too far for one night")):
        holds(rule)
        (lost,) = impossible(Problem.compile(mission()))
        assert (lost.task, [(one.reason, one.detail) for one in lost.reasons]) == ("far", [("curfew", said)])


@pytest.mark.parametrize(
    ("limit", "word"), [("openings", "window"), ("ends_by", "deadline"), ("over_by", "shift"), ("lasts_most", "duty")]
)
def test_who_gave_it_is_asked_for_the_place_in_the_mission(holds, limit, word):
    assert Problem.compile(mission()).asked == {}
    holds(Curfew(limit))
    assert Problem.compile(mission()).asked == {word: "rule curfew"}


def test_a_limit_of_the_mission_that_is_nearer_is_said_as_before(holds):
    holds(Curfew("ends_by"))
    tasks = (Task(id="far", position=(50, 0), deadline_s=20),)
    (lost,) = impossible(Problem.compile(Mission(robots=mission().robots, tasks=tasks)))
    assert [(one.reason, one.detail) for one in lost.reasons] == [
        ("deadline", "ends at 50 s at the earliest, its deadline is 20 s")
    ]


def test_no_other_rule_offers_to_lift_it(holds):
    holds(Curfew("over_by"))
    problem = Problem.compile(mission())
    assert [rule.word for rule in problem.rules if rule.unlimited(problem, 0, 0)] == []
    ends = Mission(robots=(Robot(id="r", position=(0, 0), available_until_s=20),), tasks=mission().tasks)
    problem = Problem.compile(ends)
    assert [rule.word for rule in problem.rules if rule.unlimited(problem, 0, 0)] == ["shift"]


def lost_in_a_run(holds, limit, *events, **keys):
    holds(Curfew(limit))
    executor = carried_out(mission(*events, **keys), plan_of(r_0=["near", "far"]))
    assert executor.done
    return executor, dict(report_of(executor.account).tasks_lost)


def test_a_run_waits_and_misses_in_its_word(holds):
    delay = Event(at_s=12, delay_task=DelayedTask(task="near", by_s=30))
    executor, lost = lost_in_a_run(holds, "openings", delay, far=9.0)
    waits = [event.data["words"] for event in executor.events if event.kind == "waits"]
    assert waits == ["waits for curfew: opens at 10 s"]
    assert [event.kind for event in executor.events if event.kind.endswith("_missed")] == ["window_missed"]
    assert lost == {"far": "curfew: closed at 30 s"}


def test_a_robot_refuses_in_its_word_what_would_end_too_late(holds):
    executor, lost = lost_in_a_run(holds, "ends_by")
    refused = [event.data["reason"] for event in executor.events if event.kind == "task_refused"]
    (reason,) = refused
    assert reason.startswith("curfew: would end at 60.")
    assert lost["far"].startswith("curfew: ")


@pytest.mark.parametrize("limit", ["over_by", "lasts_most"])
def test_a_robot_that_is_late_already_is_planned_again_in_its_word(holds, limit):
    """Its past is over the limit: that it cannot help, and it does no more."""
    delay = Event(at_s=8, delay_task=DelayedTask(task="near", by_s=30))
    again = Event(at_s=38, new_task=Task(id="new", position=(4, 0)))
    _, lost = lost_in_a_run(holds, limit, delay, again, far=6.0)
    assert lost.keys() == {"far", "new"}
    assert lost["new"].startswith("curfew: would be back at")


def test_a_robot_rests_in_its_word(holds):
    executor, lost = lost_in_a_run(holds, "spans", far=9.0)
    assert lost == {}
    waits = [event.data["words"] for event in executor.events if event.kind == "waits"]
    assert all("curfew: r_0 works from 30 s on" in words for words in waits)
    assert report_of(executor.account).starts_s["far"] >= CLOSES_S
