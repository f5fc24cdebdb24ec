"""What every allocator keeps, whatever it does inside."""

import signal
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.mission.plan import REASONS
from muster.mission.system.clock import VirtualClock
from muster.model.problem import Problem

every_allocator = pytest.mark.parametrize("allocator", ALLOCATORS)
RULES = ("prerequisite", "suitability", "skill", "lock", "capacity")


def without_times(plan):
    return replace(plan, elapsed_s=None, history=tuple((0.0, value) for _, value in plan.history))


@pytest.mark.long(keep=1)
@every_allocator
@given(seed=st.integers(0, 10**6), ignore=st.sets(st.sampled_from(RULES)), tasks=st.integers(0, 12))
def test_every_plan_is_admissible_and_its_figures_are_the_judges(allocator, seed, ignore, tasks):
    mission = random_mission(seed, tasks=tasks, robots=1 + seed % 4)
    plan = muster.solve(mission, allocator, seed=seed, iterations=30, ignore=ignore)
    verdict = muster.verify(mission, plan, ignore)
    assert verdict.violations == ()
    assert plan.objective_value == pytest.approx(verdict.value(), rel=1e-9)
    assert [route.robot for route in plan.routes] == [robot.id for robot in mission.robots]
    assert plan.ignored == tuple(rule for rule in RULES if rule in ignore)


@pytest.mark.long(keep=1)
@every_allocator
@given(seed=st.integers(0, 10**6))
def test_every_task_left_out_has_a_reason_for_every_robot(allocator, seed):
    mission = random_mission(seed)
    plan = muster.solve(mission, allocator, seed=seed, iterations=10)
    done = {task for route in plan.routes for task in route.tasks}
    assert [item.task for item in plan.unassigned] == [task.id for task in mission.tasks if task.id not in done]
    for item in plan.unassigned:
        assert [reason.robot for reason in item.reasons] == [robot.id for robot in mission.robots]
        assert {reason.reason for reason in item.reasons} <= set(REASONS)


@pytest.mark.long(keep=21)
@every_allocator
@pytest.mark.parametrize("name", ["31T-6R50", "market-rescue", "eil51-5"])
def test_the_same_seed_and_iterations_give_the_same_plan(allocator, name):
    mission = muster.load(name)
    first, second = (muster.solve(mission, allocator, seed=7, iterations=50) for _ in range(2))
    assert without_times(first).text() == without_times(second).text()


@pytest.mark.long(keep=6)
@pytest.mark.parametrize("allocator", [name for name, a in ALLOCATORS.items() if a.anytime])
def test_other_seeds_give_other_plans(allocator):
    mission = muster.load("eil51-5")
    plans = {muster.solve(mission, allocator, seed=seed, iterations=50).routes for seed in range(5)}
    assert len(plans) > 1


@pytest.mark.long(keep=3)
@every_allocator
def test_history_only_improves_and_ends_at_the_plan(allocator):
    plan = muster.solve(muster.load("eil51-5"), allocator, iterations=300)
    values = [value for _, value in plan.history]
    seconds = [time for time, _ in plan.history]
    assert values == sorted(set(values), reverse=True)
    assert values[-1] == plan.objective_value
    assert seconds == sorted(seconds)
    assert seconds[-1] <= plan.elapsed_s


@every_allocator
def test_an_interrupted_run_returns_an_admissible_plan(allocator):
    mission = muster.load("31T-6R50")
    problem = Problem.compile(mission).ready()
    stop = Stop()
    stop.interrupt()
    plan = ALLOCATORS[allocator].solve(problem, stop)
    assert muster.verify(mission, plan).valid


def test_a_second_interruption_leaves_out_the_reasons():
    problem = Problem.compile(muster.load("31T-6R50")).ready()
    stop = Stop()
    stop.interrupt()
    assert all(item.reasons for item in ALLOCATORS["greedy"].solve(problem, stop).unassigned)
    stop.interrupt()
    plan = ALLOCATORS["greedy"].solve(problem, stop)
    assert [item.reasons for item in plan.unassigned] == [()] * 31
    assert muster.verify(problem.mission, plan).valid


@pytest.mark.parametrize("allocator", [name for name, a in ALLOCATORS.items() if a.anytime])
def test_a_time_limit_is_kept_on_the_given_clock(allocator):
    problem = Problem.compile(muster.load("16T-3R")).ready()
    stop = Stop(time_limit=1.0, clock=VirtualClock(step_s=0.01))
    plan = ALLOCATORS[allocator].solve(problem, stop)
    assert 0.9 <= plan.elapsed_s < 1.1
    assert stop.iterations_done > (3 if allocator == "ant-colony" else 10)  # ants look after each of 20 plans


@pytest.mark.parametrize("allocator", ["auction", "market", "consensus-bundle"])
def test_an_auction_ends_when_its_time_is_up_and_notes_it(allocator):
    problem = Problem.compile(muster.load("31T-6R50")).ready()
    stop = Stop(time_limit=0.1, first_plan_s=0.1, clock=VirtualClock(step_s=0.01))
    plan = ALLOCATORS[allocator].solve(problem, stop)
    assert plan.elapsed_s < 0.3  # in which each robot sees once that time is up
    assert plan.tasks_completed < 31
    assert plan.cut_short
    assert muster.verify(problem.mission, plan).valid


def test_an_auction_that_ends_by_itself_was_not_cut_short():
    stop = Stop(time_limit=1e6)
    ALLOCATORS["auction"].solve(Problem.compile(muster.load("31T-6R50")), stop)
    assert not stop.cut_short


def test_no_reasons_are_looked_for_long_after_the_time_is_up():
    problem, clock = Problem.compile(muster.load("31T-6R50")).ready(), VirtualClock()
    stop = Stop(time_limit=0.0, clock=clock)
    assert all(item.reasons for item in ALLOCATORS["auction"].solve(problem, stop).unassigned)
    clock.advance(0.2)
    assert not any(item.reasons for item in ALLOCATORS["auction"].solve(problem, stop).unassigned)


@pytest.mark.long(keep=8)
@every_allocator
def test_an_anytime_run_never_ends_below_its_start(allocator):
    mission = muster.load("31T-6R50")
    start = muster.solve(mission, "greedy+genetic", seed=3, iterations=2000)
    plan = muster.solve(mission, allocator, seed=1, iterations=20, start=start)
    assert plan.tasks_completed == start.tasks_completed
    assert plan.objective_value <= start.objective_value + 1e-9


@every_allocator
def test_a_start_that_is_not_admissible_is_refused(allocator):
    mission = muster.load("31T-6R50")
    start = muster.Plan(routes=(muster.Route("r_1", ("16", "5")),))
    with pytest.raises(muster.ParameterError, match="start"):
        muster.solve(mission, allocator, iterations=1, start=start)


@every_allocator
def test_two_routes_of_one_robot_are_no_start(allocator):
    mission = muster.load("31T-6R")
    start = muster.Plan(routes=(muster.Route("r_0", ("4",)), muster.Route("r_0", ("6",))))
    with pytest.raises(muster.ParameterError, match="two routes"):
        muster.solve(mission, allocator, iterations=1, start=start)


@every_allocator
@pytest.mark.parametrize("seed", [-1, 2**64, 1.5])
def test_a_seed_out_of_range_is_refused(allocator, seed):
    with pytest.raises(muster.ParameterError, match="seed"):
        muster.solve(muster.load("6T-2R"), allocator, iterations=1, seed=seed)


@every_allocator
def test_one_robot_and_no_task(allocator):
    mission = muster.Mission(robots=(muster.Robot(id="r", position=(0, 0)),), tasks=())
    plan = muster.solve(mission, allocator, iterations=5)
    assert plan.complete
    assert plan.objective_value == plan.makespan_s == 0.0
    assert plan.equality_index == 1.0


def test_progress_is_reported_and_leaves_signals_alone():
    before = signal.getsignal(signal.SIGINT)
    seen = []
    muster.solve(muster.load("eil51-5"), "genetic", iterations=100, on_progress=seen.append)
    assert seen
    assert seen[-1].weight == 50
    assert [p.objective for p in seen] == sorted((p.objective for p in seen), reverse=True)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"allocator": "gredy"}, "did you mean 'greedy'"),
        ({"allocator": None}, "allocator"),
        ({"time_limit": -1}, "time_limit"),
        ({"time_limit": float("nan")}, "time_limit"),
        ({"time_limit": "1"}, "time_limit"),
        ({"iterations": -1}, "iterations"),
        ({"iterations": 1.5}, "iterations"),
        ({"objective": "least"}, "objective"),
        ({"ignore": ("skils",)}, "ignore"),
        ({"ignore": "skils"}, 'ignore: "skils"'),
        ({"population_size": 0}, "population_size"),
        ({"popsize": 3}, "has no parameter popsize"),
    ],
)
def test_wrong_parameters_are_refused_in_words(arguments, message):
    with pytest.raises(muster.ParameterError, match=message):
        muster.solve(muster.load("6T-2R"), **arguments)


def test_a_name_is_no_mission():
    with pytest.raises(muster.ParameterError, match=r"muster\.load"):
        muster.solve("6T-2R")
