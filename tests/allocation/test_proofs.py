"""The bound that a plan is given."""

import pytest

import muster
from muster.allocation.bounds.of_objective import Bound, best_bound, sound_bound
from muster.allocation.exact import proofs, solving
from muster.allocation.exact.proofs import prove
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster.planning.judging import admits


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


@pytest.mark.parametrize("proof", ["quick", "exact"])
def test_a_bound_above_the_value_is_an_internal_error(proof, monkeypatch):
    """It must not be cut down to the value, which would print "the plan is optimal"."""
    if proof == "exact":
        pytest.importorskip("ortools")
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, "greedy")
    unsound = Bound(plan.objective_value * 1.001, ("the farthest task",))
    monkeypatch.setattr(proofs, "best_bound", lambda problem: unsound)
    monkeypatch.setattr(solving, "best_bound", lambda problem: unsound)
    with pytest.raises(muster.MusterError, match=r"^internal error: a lower bound of .*: the farthest task"):
        prove(Problem.compile(mission), plan, proof, Stop(), judge=admits)


@pytest.mark.parametrize("above", [0.0, 1e-10])
def test_a_bound_that_rounding_has_put_above_the_value_is_the_value(above):
    assert sound_bound(7.0 * (1 + above), 7.0, "because") == 7.0
    assert sound_bound(6.0, 7.0, "because") == 6.0


def test_what_cannot_be_proven_is_refused():
    with pytest.raises(muster.ParameterError, match="expected quick or exact"):
        muster.solve(muster.load("6T-2R"), "greedy", bound="best")
    with pytest.raises(muster.ParameterError, match="expected at most 40"):
        muster.solve(muster.load("eil51-5"), "greedy", bound="exact")


@pytest.mark.long
def test_why_a_bound_holds_or_is_missing():
    pytest.importorskip("ortools")
    problem = Problem.compile(muster.load("11T-2R"))
    plan = muster.solve(problem.mission, "greedy")
    assert prove(problem, plan, "quick", Stop(), judge=admits).why == best_bound(problem).why
    exact = prove(problem, plan, "exact", Stop(), 20.0, judge=admits)
    assert exact.plan.lower_bound == pytest.approx(exact.plan.objective_value)
    assert "leave no room for a better plan" in exact.why
    crowded = Problem.compile(muster.load("31T-3R44-3R26"))
    unknown = prove(crowded, muster.solve(crowded.mission, "greedy"), "exact", Stop(), 1e-9, judge=admits)
    assert unknown.plan.lower_bound is None
    assert unknown.why.startswith("whether more tasks can be done is not known")


def test_what_cannot_be_proven_is_refused_before_the_search():
    def no_step(_):
        raise AssertionError("the search has begun")

    for bound, name in (("best", "6T-2R"), ("exact", "eil51-5")):
        with pytest.raises(muster.ParameterError, match="bound: "):
            muster.solve(muster.load(name), "search", iterations=50, bound=bound, on_progress=no_step)
