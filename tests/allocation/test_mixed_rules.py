"""Missions in which rules meet, and of which something wrong was said once, or nothing at all."""

import subprocess
import sys
from pathlib import Path

import pytest
from tests.judged_plans import best_plan

import muster
from muster.allocation.bounds.work_shortfall import shortfalls
from muster.allocation.exact import solve_exactly
from muster.mission.model import Battery, Lag, Mission, Robot, Rules, Task
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify

CASES = Path(__file__).parents[1] / "data" / "cases" / "planner"
PATIENCE_S = 300  # of a command that ends at once


def case(name):
    return muster.load(CASES / f"{name}.yaml")


# --- cycles of lags --------------------------------------------------------------------------------------------------


@pytest.mark.long
def test_a_plan_ends_where_a_stop_at_a_station_makes_a_cycle_of_lags_impossible():
    command = [str(Path(sys.executable).with_name("muster")), "solve", str(CASES / "hang.yaml"), "--iterations", "50"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert ended.returncode == 0, ended.stderr
    assert "tasks completed" in ended.stdout


def test_routes_round_an_impossible_cycle_have_no_schedule():
    """Each of two robots waits for the other's next task, which may begin only shortly after the first."""
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 0)))
    tasks = [
        {"id": "a", "position": (1, 0)},
        {"id": "b", "position": (9, 0), "prerequisites": [{"task": "a", "within_s": 1}]},
        {"id": "c", "position": (2, 0), "deadline_s": 50},
    ]
    mission = Mission(
        rules=Rules(objective="makespan", timing="constant"),
        robots=robots,
        tasks=tuple(_task(**task) for task in tasks),
    )
    problem = Problem.compile(mission)
    a, b, c = (problem.task_index[name] for name in "abc")
    assert not muster.core.Inspection(problem.core, [[a, c, b], []]).admissible
    assert muster.core.Inspection(problem.core, [[a], [c, b]]).admissible


def _task(prerequisites=(), **keys):
    lags = {one["task"]: Lag(within_s=one["within_s"]) for one in prerequisites}
    return Task(**keys, prerequisites=tuple(lags), lags=lags)


# --- units of more than one visit ------------------------------------------------------------------------------------


@pytest.mark.parametrize("allocator", ["search", "greedy", "genetic", "greedy+genetic", "hill-climbing", "auction"])
def test_a_delivery_that_begins_with_another_task_is_planned(allocator):
    plan = muster.solve(case("tiny-238"), allocator, iterations=200)
    assert plan.complete
    assert plan.objective_value == pytest.approx(22.763054614)


def test_the_exact_solver_excludes_nothing_that_the_judge_admits():
    pytest.importorskip("ortools", reason="needs the extra exact")
    plan = muster.solve(case("tiny-238"), bound="exact", iterations=50)
    assert plan.objective_value == pytest.approx(22.763054614)
    assert plan.lower_bound == pytest.approx(plan.objective_value)


def test_the_exact_solver_takes_the_judges_word_against_the_cores(monkeypatch):
    """A core that rejects every plan changes neither what is found nor what is proven."""
    pytest.importorskip("ortools", reason="needs the extra exact")
    problem = Problem.compile(case("tiny-238"))
    true = muster.core.Inspection

    class Rejecting:
        def __init__(self, core, routes):
            self._true = true(core, routes)

        admissible = False

        def __getattr__(self, name):
            return getattr(self._true, name)

    monkeypatch.setattr("muster.core.Inspection", Rejecting)
    exact = solve_exactly(problem, 30.0, judge=admits)
    assert exact.optimal
    assert problem.value(exact.routes) == pytest.approx((5.0, 22.763054614))


def guarded_transport():
    """A crate that one robot carries, and that is put down when two others begin to hold its place."""
    robots = tuple(Robot(id=name, position=(k, 0), load_capacity=5) for k, name in enumerate("rst"))
    tasks = (
        Task(id="lift", position=(4, 0), load=3),
        Task(id="put", position=(8, 0), delivers="lift", duration_s=2),
        Task(id="hold", position=(8, 3), starts_with=("put",), robots_needed=2, duration_s=2),
    )
    return Mission(rules=Rules(objective="makespan", timing="constant"), robots=robots, tasks=tasks)


@pytest.mark.parametrize("allocator", ["search", "greedy", "auction"])
def test_a_transport_that_ends_as_a_team_begins_is_planned(allocator):
    mission = guarded_transport()
    best = best_plan(mission)
    plan = muster.solve(mission, allocator, iterations=200)
    assert plan.complete
    assert verify(mission, plan).value() == pytest.approx(best.objective)


def test_a_delivery_by_another_robot_than_the_pick_up_is_not_planned():
    robots = tuple(Robot(id=name, position=(k, 0), load_capacity=5) for k, name in enumerate("rs"))
    tasks = (
        Task(id="p", position=(4, 0), load=3),
        Task(id="d", position=(8, 0), delivers="p", other_robot_than=("p",)),
    )
    plan = muster.solve(Mission(robots=robots, tasks=tasks), iterations=50)
    assert plan.tasks_completed == 0


def test_a_task_between_a_pick_up_and_its_delivery_is_planned_with_them():
    """The delivery waits for a task that waits for the pick-up: none of the three is in a plan without the others."""
    robot = Robot(id="r", position=(0, 0), load_capacity=5)
    tasks = (
        Task(id="p", position=(4, 0), load=3),
        Task(id="seal", position=(5, 0), prerequisites=("p",)),
        Task(id="d", position=(8, 0), delivers="p", prerequisites=("seal",)),
    )
    plan = muster.solve(Mission(robots=(robot,), tasks=tasks), iterations=50)
    assert plan.routes[0].tasks == ("p", "seal", "d")


# --- calls at stations -----------------------------------------------------------------------------------------------


def test_a_robot_charges_before_its_first_task_for_what_is_put_in_behind_it():
    plan = muster.solve(case("tiny-55"), iterations=200)
    assert plan.objective_value == pytest.approx(58.584869642)


# --- reasons ---------------------------------------------------------------------------------------------------------


def test_what_excluded_a_robot_is_said():
    found = muster.check(case("tiny-148"))
    assert [item.task for item in found.impossible] == ["t2"]
    assert {(r.robot, r.reason) for r in found.impossible[0].reasons} == {("r0", "team"), ("r1", "team")}


def test_a_rule_that_another_robot_breaks_is_not_a_robots_own():
    """What t1 puts down nobody has; t0 begins with it. That is no load of the robot that would do t0."""
    robots = tuple(Robot(id=name, position=(k, 0), load_capacity=3) for k, name in enumerate("rs"))
    tasks = (Task(id="t0", position=(1, 8)), Task(id="t1", position=(2, 7), load=-2, starts_with=("t0",)))
    mission = Mission(robots=robots, tasks=tasks)
    plan = muster.solve(mission, iterations=20)
    reasons = {item.task: {r.reason for r in item.reasons} for item in plan.unassigned}
    assert reasons == {"t0": {"relation"}, "t1": {"load"}}
    assert verify(mission, plan).valid


# --- sums of work ----------------------------------------------------------------------------------------------------


@pytest.mark.long
def test_work_that_is_more_than_all_shifts_is_said_first():
    found = muster.check(case("fifty"))
    (short,) = found.together.shortfalls
    assert (short.needed, short.available, short.lacking) == pytest.approx((1982, 1800, 182))
    assert short.detail.endswith("182 robot-seconds short before any travel")
    assert short.least == "least to add: 182 robot-seconds of shift, or 1 more robot; or leave out at least 2 tasks"
    assert not found.together.unknown
    data = found.as_dict()
    assert data["shortfalls"][0]["lacking"] == pytest.approx(182)
    assert type(found).from_dict(data) == found


def robots_with(**keys):
    return tuple(Robot(id=name, position=(0, 0), skills=("lift",) if name != "t" else (), **keys) for name in "rst")


def test_a_shortfall_of_those_with_a_skill_is_found_where_all_together_have_enough():
    tasks = tuple(Task(id=str(k), position=(1, 0), duration_s=30, requires=("lift",)) for k in range(5))
    problem = Problem.compile(Mission(robots=robots_with(available_until_s=60), tasks=tasks))
    (short,) = shortfalls(problem, range(5))
    assert (short.robots, short.everyone, short.resource) == (("r", "s"), False, "shift")
    assert (short.needed, short.available, short.left_out, short.more_robots) == (150, 120, 1, 1)
    assert short.detail.startswith(
        "5 tasks that only r, s can do (others: skill, lacks lift): 150 robot-seconds of work in 120 of shift"
    )


def test_a_teams_work_counts_for_each_member_as_long_as_for_the_slowest():
    slow = Robot(id="slow", position=(0, 0), efficiency=0.5, available_until_s=50)
    fast = Robot(id="fast", position=(0, 0), available_until_s=50)
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=15, robots_needed=2) for k in range(2))
    (short,) = shortfalls(Problem.compile(Mission(robots=(slow, fast), tasks=tasks)), range(2))
    assert (short.needed, short.available) == (120, 100)


@pytest.mark.parametrize(
    ("keys", "resource", "available"),
    [
        ({"work_capacity": 5}, "capacity", 15),
        ({"battery": Battery(capacity=5, reserve=0.2)}, "battery", 12),
    ],
)
def test_work_that_is_more_than_all_capacities_or_batteries(keys, resource, available):
    tasks = tuple(Task(id=str(k), position=(0, 0), actuation_cost=4) for k in range(5))
    problem = Problem.compile(Mission(robots=robots_with(**keys), tasks=tasks))
    (short,) = shortfalls(problem, range(5))
    assert short.resource == resource
    assert (short.needed, short.available) == pytest.approx((20, available))


def test_work_that_must_be_over_by_the_last_deadline():
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=20, deadline_s=30) for k in range(5))
    (short,) = shortfalls(Problem.compile(Mission(robots=robots_with(), tasks=tasks)), range(5))
    assert (short.resource, short.needed, short.available) == ("time", 100, 90)


def test_enough_is_no_shortfall():
    tasks = tuple(Task(id=str(k), position=(0, 0), duration_s=30) for k in range(6))
    assert shortfalls(Problem.compile(Mission(robots=robots_with(available_until_s=60), tasks=tasks)), range(6)) == ()


# --- states of the core ----------------------------------------------------------------------------------------------


def test_what_a_task_took_the_last_robot_says_nothing_of_the_next():
    """A robot of half the efficiency would take more than the other's battery holds."""
    robots = (
        Robot(id="r", position=(0, 0), battery=Battery(capacity=10)),
        Robot(id="slow", position=(0, 0), efficiency=0.5, battery=Battery(capacity=30)),
    )
    task = Task(id="t", position=(2, 0), duration_s=7)
    problem = Problem.compile(Mission(rules=Rules(usage="time", timing="constant"), robots=robots, tasks=(task,)))
    r, slow = problem.robot_index["r"], problem.robot_index["slow"]
    roster = muster.core.Roster(problem.core)
    assert roster.begin([[0] if i == slow else [] for i in range(2)])
    roster.remove(0)
    assert roster.best_insertion(0, robots=[r]).members == [(0, r, 0)]
