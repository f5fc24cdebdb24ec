"""Every allocator keeps the rules of time, teams and relations that it can, and refuses the others by name."""

import re
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from tests.timed_missions.meaning import Meaning
from tests.timed_missions.missions import timed_mission

import muster
from muster.allocation.capabilities import _WORDS, ALL, FOR_GOOD, those_that_can
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.mission.model import Battery, Lag
from muster.model.problem import Problem

every_allocator = pytest.mark.parametrize("allocator", ALLOCATORS)

ROBOTS = tuple(muster.Robot(id=f"r_{k}", position=(10.0 * k, 0.0), abilities={"lift": 3}) for k in range(3))
TASK = muster.Task(id="b", position=(3.0, 4.0), duration_s=5)
CASES = {
    "window": {"window_s": ((20.0, 30.0),)},
    "deadline": {"deadline_s": 40.0},
    "lag": {"prerequisites": ("a",), "lags": {"a": Lag(after_s=2.0, within_s=60.0)}},
    "team": {"robots_needed": 2},
    "relation": {"other_robot_than": ("a",)},
    "starts-with": {"starts_with": ("a",)},
    "load": {"load": 1},
    "either-or": {"either_or": ("a",)},
}
RULES_OF = {
    "lateness": {"objective": "lateness"},
    "makespan-return": {"objective": "makespan", "makespan_includes_return": True, "return_to_start": True},
}
OF_ROBOTS = {
    "shift": {"available_until_s": 200.0},
    "rests": {"shifts_s": ((0.0, 9.0), (12.0, None))},
    "duty": {"longest_duty_s": 60.0},
    "min-tasks": {"min_tasks": 2},
    "battery": {"battery": Battery(capacity=500.0)},
}


def mission_of(word):
    """A mission that asks for one capability."""
    robots = tuple(replace(robot, **OF_ROBOTS.get(word, {})) for robot in ROBOTS)
    task = replace(TASK, **CASES.get(word, {}))
    rules = muster.Rules(**{"timing": "constant", **RULES_OF.get(word, {})})
    tasks = (muster.Task(id="a", position=(1.0, 1.0), duration_s=5, due_s=3.0), task)
    return muster.Mission(name=word, rules=rules, robots=robots, tasks=tasks)


def solved(mission, allocator, seed):
    return ALLOCATORS[allocator].solve(Problem.compile(mission).ready(), Stop(iterations=20), seed=seed)


def holds_true(mission, plan):
    """Compare a plan with the meaning of its routes, which shares no code with planner and judge."""
    meaning = Meaning(mission)
    routes = tuple(tuple(meaning.number[name] for name in route.tasks) for route in plan.routes)
    assert meaning.faults(routes) == set()
    weight, value, _ = meaning.value(routes)
    assert plan.weight_completed == pytest.approx(weight)
    assert plan.objective_value == pytest.approx(value, rel=1e-9, abs=1e-9)
    assert plan.tasks_completed == len(meaning.teams(routes))
    begins, ends = meaning.schedule(routes)
    for stop in (stop for route in plan.routes for stop in route.stops):
        times = begins[meaning.number[stop.name]], ends[meaning.number[stop.name]]
        assert (stop.begin_s, stop.end_s) == pytest.approx(times)
        assert stop.arrive_s <= stop.begin_s + 1e-9


@pytest.mark.long(keep=84)
@every_allocator
@pytest.mark.parametrize("word", sorted(ALL))
def test_each_rule_is_kept_or_refused_by_name(allocator, word):
    mission = mission_of(word)
    assert set(Problem.compile(mission).asked) == {word}
    if word in ALLOCATORS[allocator].can:
        plan = solved(mission, allocator, 1)
        holds_true(mission, plan)
        assert plan.complete
        assert plan.tasks_completed == (1 if word == "either-or" else 2)
    else:
        with pytest.raises(
            muster.ParameterError, match=rf"{re.escape(allocator)} cannot do .*\({word}\); expected .*greedy"
        ):
            muster.solve(mission, allocator, iterations=1)


RETURNING = [name for name, allocator in ALLOCATORS.items() if "makespan-return" in allocator.can]
RANDOM_RETURNS = range(5)


def returning(seed, *, counted):
    """Robots of several speeds that go back to where they start, which the makespan counts or not."""
    random = Random(seed)
    rules = replace(mission_of("makespan-return").rules, makespan_includes_return=counted)

    def point():
        return random.uniform(0, 50), random.uniform(0, 50)

    robots = tuple(muster.Robot(id=f"r_{k}", position=point(), speed_mps=random.choice((0.5, 1, 2))) for k in range(3))
    tasks = tuple(muster.Task(id=f"t_{k}", position=point(), duration_s=random.uniform(0, 20)) for k in range(6))
    return muster.Mission(name="returning", rules=rules, robots=robots, tasks=tasks)


@pytest.mark.long(keep=6)
@pytest.mark.parametrize("allocator", RETURNING)
def test_plans_are_better_where_the_return_counts(allocator):
    """An allocator that can count the return finds routes that end earlier, on average, than without counting it."""
    counted = [solved(returning(seed, counted=True), allocator, 1) for seed in RANDOM_RETURNS]
    not_counted = [solved(returning(seed, counted=False), allocator, 1) for seed in RANDOM_RETURNS]
    for seed, plan in zip(RANDOM_RETURNS, counted, strict=True):
        holds_true(returning(seed, counted=True), plan)
    judged = [muster.verify(returning(seed, counted=True), bare(plan)) for seed, plan in enumerate(not_counted)]
    assert sum(plan.objective_value for plan in counted) < sum(verdict.makespan_s for verdict in judged)


def bare(plan):
    """The routes of a plan."""
    return muster.Plan(routes=tuple(muster.Route(route.robot, route.tasks) for route in plan.routes))


@pytest.mark.parametrize("allocator", [name for name, a in ALLOCATORS.items() if a.can == ALL])
@pytest.mark.parametrize("seed", range(20))
def test_plans_with_all_rules_are_admissible_and_their_figures_true(allocator, seed):
    mission = timed_mission(seed)
    plan = solved(mission, allocator, seed)
    holds_true(mission, plan)


@pytest.mark.parametrize("word", sorted(FOR_GOOD))
def test_those_that_an_issue_needs_can_do_all(word):
    assert {"greedy", "greedy+genetic", "auction", "search"} <= set(those_that_can([word]))


def test_an_auction_never_takes_back_what_it_sold():
    assert {"min-tasks"} == ALL - FOR_GOOD
    assert "auction" not in those_that_can(["min-tasks"])
    assert {"greedy", "greedy+genetic", "search"} <= set(those_that_can(["min-tasks"]))


def test_a_task_of_a_team_is_won_by_a_coalition():
    mission = mission_of("team")
    plan = solved(mission, "auction", 0)
    award = plan.book.award_of("b")
    assert award.robot == "r_0+r_1"
    assert [bid.winner for bid in plan.book.bids if bid.price is not None and bid.task == "b"]
    assert dict(award.bids)[award.robot] == award.price == min(dict(award.bids).values())
    assert award.bidders > 1


def test_the_docs_say_which_allocator_can_do_what():
    rows = [
        f"| `{name}` | {' | '.join('yes' if word in allocator.can else '' for word in _WORDS)} |"
        for name, allocator in ALLOCATORS.usable().items()
    ]
    table = "\n".join([f"| allocator | {' | '.join(_WORDS)} |", "|---|" + "---|" * len(_WORDS), *rows])
    page = Path(__file__).parents[2] / "docs" / "algorithms.md"
    assert table in page.read_text(encoding="utf-8")
