"""The enumeration of timed missions, by hand, and against judge and bounds; `make campaign-times` tries thousands."""

from collections import Counter
from dataclasses import replace

import pytest

from muster import Mission, Robot, Rules, Task
from muster.allocation.remedies.remedy import Remedy
from muster.mission.model import Lag, TeamPart
from muster.mission.plan import Reason, Route, Unassigned
from muster.model.rules.capacity import CapacityChange
from muster.model.rules.window import LongerWindow
from tests.timed_missions.every_plan import EveryPlan
from tests.timed_missions.meaning import Meaning
from tests.timed_missions.missions import (
    OBJECTIVES,
    RULES,
    further_ignored_in,
    ignored_in,
    timed_mission,
    with_further_rules,
)
from tests.timed_missions.places import LIMITS, Places
from tests.timed_missions.possibilities import Possibilities
from tests.timed_missions.remedied import Remedied
from tests.timed_missions.trial import Report, Trial, judged_trial, trial


def parts(few, chunk, every):
    """The first few seeds, and the rest in parts that take long."""
    rest = (range(max(first, few), first + chunk) for first in range(0, every, chunk))
    return [range(few), *(pytest.param(seeds, marks=pytest.mark.long) for seeds in rest)]


@pytest.mark.long
@pytest.mark.parametrize("seeds", parts(3, 15, 45), ids=str)
def test_judge_bounds_reasons_and_remedies_agree_with_every_plan(seeds):
    reports = [trial(seed, planned=False) for seed in seeds]
    assert {report.seed: report.failures for report in reports if report.failures} == {}
    assert sum(report.counts["remedies: a plan was found"] for report in reports) > 0


@pytest.mark.parametrize("seeds", parts(2, 6, 18), ids=str)
def test_the_exact_solver_finds_the_best_of_every_plan(seeds):
    pytest.importorskip("ortools", reason="needs the extra exact")
    failures = {}
    for seed in seeds:
        report = Report(seed)
        tried = Trial(report, timed_mission(seed), ignored_in(seed))
        tried.exactly(tried.problem)
        failures |= {seed: report.failures} if report.failures else {}
    assert failures == {}


@pytest.mark.long
@pytest.mark.parametrize("seeds", parts(12, 120, 240), ids=str)
def test_the_judge_agrees_with_the_meaning_of_rules_that_planning_does_not_know(seeds):
    reports = [judged_trial(seed) for seed in seeds]
    assert {report.seed: report.failures for report in reports if report.failures} == {}
    counts = sum((report.counts for report in reports), Counter())
    alone = {f"judged: {kind} alone" for kind in ("shift", "duty", "aboard", "either-or")}
    assert alone <= counts.keys()


def test_the_missions_have_every_further_rule():
    missions = [with_further_rules(timed_mission(seed), seed) for seed in range(100)]
    assert {word for seed in range(300) for word in further_ignored_in(seed)} >= {
        "shift",
        "duty",
        "aboard",
        "either-or",
    }
    robots = [robot for mission in missions for robot in mission.robots]
    tasks = [task for mission in missions for task in mission.tasks]
    for values in (
        [robot.shifts_s for robot in robots],
        [robot.longest_duty_s for robot in robots],
        [task.longest_aboard_s is not None for task in tasks],
        [task.either_or for task in tasks],
    ):
        assert 0.01 < sum(bool(value) for value in values) / len(values) < 0.95


def test_a_judge_that_errs_is_found(monkeypatch):
    monkeypatch.setattr("muster.verification.rules.duty.Duty.spans", lambda rule, route: iter(()))
    assert any("but it breaks {'time'}" in failure for failure in judged_trial(6).failures)


@pytest.mark.long
def test_a_trial_that_goes_wrong_is_a_failure(monkeypatch):
    monkeypatch.setattr("tests.timed_missions.trial.lower_bound", lambda problem: 1e9)
    failing = (trial(seed, planned=False).failures for seed in range(100))
    assert any("quick bound" in failure for failures in failing for failure in failures)
    monkeypatch.setattr("tests.timed_missions.trial.lower_bound", lambda problem: 1 / 0)
    assert trial(0, planned=False).failures == ["ZeroDivisionError: division by zero"]


def test_false_sentences_are_found():
    late = Task(id="a", position=(10, 0), duration_s=5, window_s=((0, 6),), deadline_s=30)
    mission = Mission(rules=Rules(timing="constant"), robots=(Robot(id="r_0", position=(0, 0)),), tasks=(late,))
    places = Places(mission, (), ((),), 0, 0)
    assert [word for word in ("not-chosen", *LIMITS, "prerequisite", "team", "lock") if places.is_true(word)] == [
        "window"
    ]
    said = "arrives at {} s at the earliest, its window closes at {} s"
    said = {times: said.format(*times) for times in ((10, 6), (9, 6), (10, 7))}
    assert [places.sentence_holds("window", sentence) for sentence in said.values()] == [True, False, False]
    possible = Possibilities(mission, (), EveryPlan(places.meaning))
    wrong = {
        times: [*possible.wrong_alone([Unassigned("a", (Reason("r_0", "window", sentence),))])]
        for times, sentence in said.items()
    }
    assert [bool(found) for found in wrong.values()] == [False, False, True]  # 9 s is a bound, though not the best


@pytest.mark.parametrize(("until", "least", "wrong"), [(10, 10, 0), (10, None, 0), (9, None, 1), (12, 12, 1)])
def test_remedies_that_promise_too_much_are_found(until, least, wrong):
    late = Task(id="a", position=(10, 0), duration_s=5, window_s=((0, 6),))
    mission = Mission(rules=Rules(timing="constant"), robots=(Robot(id="r_0", position=(0, 0)),), tasks=(late,))
    changes = {"window": LongerWindow(6, until, least)}
    routes = (Route("r_0", ("a",)),)
    remedy = Remedy(robot="r_0", changes=changes, capacity=CapacityChange(now=None), enough=True, routes=routes)
    assert len(list(Remedied(mission, (), ((),), 0, 0, remedy).wrong())) == wrong


def test_the_missions_have_every_rule():
    missions = [timed_mission(seed) for seed in range(300)]
    tasks = [task for mission in missions for task in mission.tasks]
    robots = [robot for mission in missions for robot in mission.robots]
    assert {mission.rules.objective for mission in missions} == set(OBJECTIVES)
    assert {mission.rules.makespan_includes_return for mission in missions} == {True, False}
    assert {word for seed in range(300) for word in ignored_in(seed)} >= {
        "window",
        "deadline",
        "shift",
        "team",
        "relation",
        "min-tasks",
    }
    for values in (
        [len(task.window_s) > 1 for task in tasks],
        [task.deadline_s for task in tasks],
        [task.due_s for task in tasks],
        [any(lag.within_s for lag in task.lags.values()) for task in tasks],
        [any(lag.after_s for lag in task.lags.values()) for task in tasks],
        [task.robots_needed for task in tasks],
        [task.team for task in tasks],
        [task.needs for task in tasks],
        [task.same_robot_as for task in tasks],
        [task.other_robot_than for task in tasks],
        [task.starts_with for task in tasks],
        [robot.available_until_s for robot in robots],
        [robot.abilities for robot in robots],
        [robot.min_tasks > 1 for robot in robots],
    ):
        assert 0.01 < sum(bool(value) for value in values) / len(values) < 0.95
    assert len(RULES) == len(set(RULES))


def mission_of(*tasks, robots=2, **rules):
    """Robots at 0, 10, 20, ... on a line, and tasks of 5 s."""
    made = (Robot(id=f"r_{k}", position=(10 * k, 0), abilities={"lift": 3}) for k in range(robots))
    return Meaning(Mission(rules=Rules(timing="constant", **rules), robots=tuple(made), tasks=tasks))


def task(name, x, **more):
    return Task(id=name, position=(x, 0), duration_s=5, **more)


def test_work_waits_for_the_next_window_and_for_the_last_of_a_team():
    meaning = mission_of(task("a", 3, robots_needed=2, window_s=((0, 6), (8, 20))), task("b", 0))
    begins, ends = meaning.schedule(((0,), (0,)))
    assert (begins[0], ends[0]) == (8, 13)
    assert meaning.faults(((0,), ())) == {"team"}
    begins, _ = meaning.schedule(((1, 0), (0,)))
    assert begins == {1: 0, 0: 8}


def test_a_lag_of_at_most_so_long_holds_the_prerequisite_back():
    later = task("b", 20, prerequisites=("a",), lags={"a": Lag(after_s=1, within_s=2)}, window_s=((30, 40),))
    meaning = mission_of(task("a", 0), later)
    begins, _ = meaning.schedule(((0,), (1,)))
    assert begins == {0: 23, 1: 30}
    assert meaning.faults(((0, 1), ())) == {"time"}  # 20 m from the end of a: more than 2 s


def test_a_circle_is_no_schedule_even_if_nothing_takes_time():
    first, second = (Task(id=name, position=(0, 0), robots_needed=2) for name in "ab")
    meaning = mission_of(first, second)
    assert meaning.schedule(((0, 1), (0, 1))) is not None
    assert meaning.schedule(((0, 1), (1, 0))) is None


def test_parts_are_seated_whatever_the_order():
    parts = (TeamPart(count=1), TeamPart(count=1, type="arm"))
    meaning = mission_of(Task(id="a", position=(0, 0), team=parts))
    assert meaning.faults(((0,), (0,))) == {"team"}
    robots = (Robot(id="x", position=(0, 0), type="arm"), Robot(id="y", position=(0, 0)))
    assert not Meaning(Mission(robots=robots, tasks=meaning.tasks)).faults(((0,), (0,)))


def test_every_plan_of_two_tasks_and_two_robots():
    """Each alone (4), both with one robot (4), each with another (2), and none."""
    assert len(EveryPlan(mission_of(task("a", 1), task("b", 2))).admissible) == 11
    assert len(EveryPlan(mission_of(task("a", 1), task("b", 2, starts_with=("a",)))).admissible) == 3
    assert len(EveryPlan(mission_of(task("a", 1, needs={"lift": 5}))).admissible) == 2


def test_a_robot_does_at_least_so_many_tasks_or_none():
    meaning = mission_of(task("a", 1), task("b", 2))
    shy = replace(meaning.mission, robots=(replace(meaning.robots[0], min_tasks=2), meaning.robots[1]))
    assert Meaning(shy).faults(((0,), (1,))) == {"min-tasks"}
    assert not Meaning(shy, ignored=("min-tasks",)).faults(((0,), (1,)))
    assert len(EveryPlan(Meaning(shy)).admissible) == 11 - 4  # all but those in which it does one of the two


def robot_with(**keys):
    """A meaning of one robot at 0 with these keys and tasks at 3 and 5, of 5 s each."""
    tasks = (task("a", 3), task("b", 5))
    return Meaning(
        Mission(rules=Rules(timing="constant"), robots=(Robot(id="r", position=(0, 0), **keys),), tasks=tasks)
    )


def test_legs_and_work_lie_within_shifts():
    meaning = robot_with(shifts_s=((0, 9), (20, 27)), return_to_start=True)
    assert meaning.schedule(((0, 1),)) == ({0: 3, 1: 22}, {0: 8, 1: 27})  # the way to b waits for the second shift
    assert meaning.faults(((0, 1),)) == {"shift"}
    assert not meaning.faults(((0,),))
    assert robot_with(shifts_s=((0, 9), (20, 26))).faults(((0, 1),)) == {"time"}


def test_a_robot_leaves_as_late_as_its_duty_demands():
    meaning = robot_with(longest_duty_s=15)
    assert not meaning.faults(((0, 1),))
    assert robot_with(longest_duty_s=14.9).faults(((0, 1),)) == {"time"}
    late = replace(meaning.mission, tasks=(meaning.tasks[0], replace(meaning.tasks[1], window_s=((40, 50),))))
    assert Meaning(late).schedule(((0, 1),))[0] == {0: 33, 1: 40}


def test_of_alternatives_one_is_done_and_of_deliveries_both():
    assert mission_of(task("a", 1), task("b", 2, either_or=("a",))).faults(((0,), (1,))) == {"either-or"}
    meaning = mission_of(task("a", 1, load=1), task("b", 2, delivers="a", longest_aboard_s=1))
    assert not meaning.faults(((0, 1), ()))
    assert meaning.faults(((0,), (1,))) == meaning.faults(((1, 0), ())) == meaning.faults(((0,), ())) == {"load"}
    meaning = mission_of(task("a", 1, load=1), task("b", 3, delivers="a", longest_aboard_s=1))
    assert meaning.faults(((0, 1), ())) == {"time"}


def test_lateness_is_weighed_and_cost_breaks_ties():
    meaning = mission_of(task("a", 3, due_s=6, priority=2), objective="lateness")
    assert meaning.value(((0,), ())) == (2, 4, 3)
    assert EveryPlan(meaning).best()[1] == ((0,), ())
