"""A function of the judge's figures ranks several plans."""

import pytest

import muster


@pytest.fixture(scope="module")
def mission():
    return muster.load("31T-6R50")


def solved(mission, objective, **how):
    return muster.solve(mission, iterations=200, seed=1, objective=objective, **how)


def test_the_plan_with_the_lowest_figure_is_chosen(mission):
    seen = []

    def busiest_share(verdict):
        seen.append(verdict.max_usage / verdict.total_cost)
        assert verdict.valid
        return seen[-1]

    plan = solved(mission, busiest_share, candidates=6)
    assert len(seen) == 6
    assert plan.max_usage / plan.total_cost == pytest.approx(min(seen))
    assert len(set(seen)) > 1


def test_its_figures_are_those_of_the_missions_objective(mission):
    plan = solved(mission, lambda verdict: verdict.makespan_s, candidates=5)
    verdict = muster.verify(mission, plan)
    assert verdict.violations == ()
    assert (plan.objective, plan.objective_value) == ("total+max", pytest.approx(verdict.value()))


def test_more_tasks_count_before_the_figure(mission):
    seen = []

    def few(verdict):
        seen.append(verdict.weight_completed)
        return verdict.tasks_completed

    plan = muster.solve(mission, "hill-climbing", iterations=50, objective=few, candidates=8)
    assert len(set(seen)) > 1
    assert plan.weight_completed == max(seen)


def test_the_same_seed_gives_the_same_plan(mission):
    first, second = (solved(mission, lambda verdict: verdict.average, candidates=3) for _ in range(2))
    assert first.routes == second.routes


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"objective": lambda verdict: None}, "objective: returned null; expected a finite number"),
        ({"objective": lambda verdict: float("nan")}, "objective: returned nan; expected a finite number"),
        ({"objective": lambda verdict: 1.0, "candidates": 0}, "candidates: 0; expected a whole number of at least 1"),
        ({"objective": lambda verdict: 1.0, "bound": "quick"}, "bound: quick; expected none beside an objective"),
    ],
)
def test_what_cannot_be_done_is_refused(mission, how, message):
    with pytest.raises(muster.ParameterError, match=message):
        solved(mission, **how)
