"""What a plan states of itself: right figures pass, each wrong one is found."""

import json
from dataclasses import replace

import pytest

from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route, Unassigned
from muster.mission.reading.plan_reader import read_plan
from muster.verification import verify

MISSION = Mission(
    robots=(Robot(id="r", position=(0, 0)), Robot(id="s", position=(10, 0)), Robot(id="t", position=(0, 0))),
    tasks=(
        Task(id="a", position=(3, 4), actuation_cost=2),
        Task(id="b", position=(3, 0), priority=5),
        Task(id="c", position=(10, 1), actuation_cost=1),
        Task(id="d", position=(99, 99)),
    ),
)
PLAN = Plan(
    mission="mission",
    allocator="by hand",
    seed=1,
    objective="total+max",
    objective_value=24.0,
    usage_unit="m",
    total_cost=13.0,
    max_usage=11.0,
    makespan_s=11.0,
    equality_index=1 - (2 * (2 * 2 + 3 * 11) / (3 * 13) - 4 / 3),
    tasks_completed=3,
    tasks_total=4,
    weight_completed=7.0,
    lower_bound=24.0,
    elapsed_s=0.1,
    routes=(Route("r", ("a", "b"), 11.0), Route("s", ("c",), 2.0), Route("t", (), 0.0)),
    unassigned=(Unassigned("d", ()),),
    history=((0.1, 24.0),),
)
NUMBERS = ("objective_value", "total_cost", "max_usage", "makespan_s", "equality_index", "weight_completed")


def figures_wrong(plan: Plan) -> list[tuple[str | None, str]]:
    """The robot and the figure of each violation; there must be no other kind."""
    violations = verify(MISSION, plan).violations
    assert {violation.kind for violation in violations} <= {"figure"}
    return [(violation.robot, violation.detail.split(":")[0]) for violation in violations]


def test_right_figures_pass():
    assert figures_wrong(PLAN) == []


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("factor", [1 + 2e-6, 1 - 2e-6, 2, 0, -1, float("inf"), float("nan")])
def test_a_wrong_number_is_found(name, factor):
    wrong = figures_wrong(replace(PLAN, lower_bound=None, **{name: getattr(PLAN, name) * factor}))
    assert wrong == [(None, "objective total+max" if name == "objective_value" else name)]


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("factor", [1 + 0.9e-6, 1 - 0.9e-6])
def test_a_rounded_number_passes(name, factor):
    assert figures_wrong(replace(PLAN, **{name: getattr(PLAN, name) * factor})) == []


@pytest.mark.parametrize("name", NUMBERS)
def test_a_figure_that_is_not_stated_is_not_wrong(name):
    assert figures_wrong(replace(PLAN, **{name: None})) == []


@pytest.mark.parametrize(
    ("name", "value"),
    [("tasks_completed", 4), ("tasks_completed", 2), ("tasks_total", 3), ("usage_unit", "s"), ("usage_unit", "metres")],
)
def test_a_wrong_count_or_unit_is_found(name, value):
    assert figures_wrong(replace(PLAN, **{name: value})) == [(None, name)]


@pytest.mark.parametrize(
    ("k", "usage", "wrong"),
    [
        (0, 11.0001, True),
        (0, 11.000001, False),
        (2, 1e-10, False),  # nothing is 1e-6 of zero: 1e-9 is
        (2, 1e-8, True),
        (1, 11.0, True),
        (1, None, False),
    ],
)
def test_usage_of_a_route(k, usage, wrong):
    routes = list(PLAN.routes)
    routes[k] = replace(routes[k], usage=usage)
    assert figures_wrong(replace(PLAN, routes=tuple(routes))) == ([(routes[k].robot, "usage")] if wrong else [])


def test_of_two_routes_of_one_robot_the_first_is_judged():
    plan = replace(PLAN, routes=(*PLAN.routes, Route("r", (), 0.0)))
    assert [violation.kind for violation in verify(MISSION, plan).violations] == ["repeated-robot"]


@pytest.mark.parametrize(
    ("bound", "wrong"),
    [(None, False), (0, False), (23.9, False), (24.00001, False), (24.1, True), (float("nan"), True)],
)
def test_lower_bound(bound, wrong):
    assert figures_wrong(replace(PLAN, lower_bound=bound)) == ([(None, "lower_bound")] if wrong else [])


def test_the_objective_is_the_missions_unless_the_caller_names_another():
    mission = replace(MISSION, rules=Rules(objective="max"))
    assert verify(mission, replace(PLAN, objective=None, objective_value=11.0, lower_bound=None, history=())).valid
    assert not verify(mission, replace(PLAN, objective=None, lower_bound=None)).valid
    assert verify(mission, PLAN).objective_name == "max"
    assert [v.kind for v in verify(mission, PLAN).violations] == ["objective"], "its value is right of total+max"
    assert verify(mission, PLAN, objective="total+max").valid
    assert verify(mission, PLAN, objective="total+max").objective_name == "total+max"


@pytest.mark.parametrize(
    ("history", "word"),
    [
        (((0.05, 30.0), (0.1, 24.0)), None),
        (((0.02, 10.0), (0.05, 30.0), (0.1, 24.0)), None),  # a rise: a task came in
        (((0.1, 23.0),), "ends at"),
        (((0.1, 24.0), (0.05, 24.0)), "go back"),
        (((0.2, 24.0),), "outside"),
        (((-0.1, 30.0), (0.1, 24.0)), "outside"),
        ((*((0.01 * k, 20.0 + k % 2) for k in range(9)), (0.1, 24.0)), "rises"),
    ],
)
def test_a_history_that_cannot_be(history, word):
    violations = verify(MISSION, replace(PLAN, history=history)).violations
    assert [v.kind for v in violations] == ([] if word is None else ["history"])
    assert word is None or word in violations[0].detail


def test_a_makespan_where_there_is_a_deadlock():
    waiting = replace(MISSION.tasks[0], prerequisites=("b",))
    mission = replace(MISSION, tasks=(waiting, *MISSION.tasks[1:]))
    assert [v.kind for v in verify(mission, PLAN).violations] == ["deadlock", "figure"]
    silent = replace(PLAN, makespan_s=None)
    assert [v.kind for v in verify(mission, silent).violations] == ["deadlock"]
    stated = replace(silent, objective="makespan", objective_value=11.0, history=())
    verdict = verify(mission, stated, objective="makespan")
    assert [v.kind for v in verdict.violations] == ["deadlock", "figure"]
    assert verdict.as_dict()["objective"] is None


def test_a_plan_from_elsewhere_needs_only_routes(tmp_path):
    file = tmp_path / "plan.json"
    routes = [{"robot": "r", "tasks": ["a", "b"]}, {"robot": "s", "tasks": ["c"]}]
    file.write_text(json.dumps({"schema": "muster-plan/1", "routes": routes}))
    assert verify(MISSION, read_plan(file)).as_dict() == {
        "valid": True,
        "violations": [],
        "ignored": [],
        "objective_name": "total+max",
        "objective": 24,
        "usage_unit": "m",
        "total_cost": 13,
        "max_usage": 11,
        "average": 17 / 3,
        "makespan_s": 11,
        "lateness": 0,
        "equality_index": pytest.approx(PLAN.equality_index),
        "station_visits": 0,
        "charged": 0.0,
        "tasks_completed": 3,
        "tasks_total": 4,
        "weight_completed": 7,
        "reasons_undecided": 0,
    }


def test_a_saved_plan_says_the_same(tmp_path):
    PLAN.save(tmp_path / "plan.json")
    assert verify(MISSION, read_plan(tmp_path / "plan.json")) == verify(MISSION, PLAN)
