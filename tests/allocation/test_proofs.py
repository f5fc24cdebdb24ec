"""The bound that a plan is given."""

import pytest

import muster


def test_a_complete_plan_has_a_bound_below_its_objective():
    plan = muster.solve(muster.load("eil51-5"), "search", iterations=3000, bound="quick")
    assert 500 < plan.lower_bound <= plan.objective_value
    assert muster.verify(muster.load("eil51-5"), plan).valid


def test_a_plan_that_leaves_tasks_out_has_none():
    plan = muster.solve(muster.load("31T-3R44-3R26"), "greedy", bound="quick")
    assert not plan.complete
    assert plan.lower_bound is None


def test_an_exact_solver_improves_a_plan_and_proves_it():
    pytest.importorskip("ortools")
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, "greedy", bound="exact")
    assert plan.objective_value == pytest.approx(25.99, abs=0.01)
    assert plan.lower_bound == pytest.approx(plan.objective_value, rel=1e-6)
    assert plan.allocator == "greedy, exact"
    assert muster.verify(mission, plan).valid


def test_what_cannot_be_proven_is_refused():
    with pytest.raises(muster.ParameterError, match="expected quick or exact"):
        muster.solve(muster.load("6T-2R"), "greedy", bound="best")
    with pytest.raises(muster.ParameterError, match="expected at most 40"):
        muster.solve(muster.load("eil51-5"), "greedy", bound="exact")
