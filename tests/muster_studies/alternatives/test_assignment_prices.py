"""The auction with rising prices against SciPy's assignment."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_studies.alternatives.assignment_prices import assign
from muster_studies.alternatives.bertsekas_auction import assignment


@given(seed=st.integers(0, 10**6), persons=st.integers(1, 8), more=st.integers(0, 8), whole=st.booleans())
def test_the_sum_is_within_epsilon_a_person_of_the_greatest(seed, persons, more, whole):
    from scipy.optimize import linear_sum_assignment

    random = np.random.default_rng(seed)
    benefit = random.uniform(-10, 10, (persons, persons + more))
    benefit = benefit.round() if whole else benefit
    assigned = assign(benefit, 1e-3)
    assert len(set(assigned.tolist())) == persons
    best = benefit[linear_sum_assignment(benefit, maximize=True)].sum()
    assert best - 1e-3 * persons - 1e-9 <= benefit[np.arange(persons), assigned].sum() <= best + 1e-9


def test_nobody_is_assigned_nothing():
    assert assign(np.empty((0, 3)), 0.1).tolist() == []


@pytest.mark.parametrize(("shape", "epsilon"), [((3, 2), 0.1), ((2, 2), 0.0)])
def test_what_cannot_be_assigned_is_refused(shape, epsilon):
    with pytest.raises(ValueError, match="expected"):
        assign(np.zeros(shape), epsilon)


@given(seed=st.integers(0, 10**6), robots=st.integers(1, 6), tasks=st.integers(0, 10))
def test_most_robots_get_a_task_and_their_bids_are_the_lowest(seed, robots, tasks):
    from scipy.optimize import linear_sum_assignment

    random = np.random.default_rng(seed)
    bids = np.where(random.random((robots, tasks)) < 0.6, random.uniform(0, 100, (robots, tasks)), np.inf)
    pairs = assignment(bids, 1e-6)
    assert len({i for i, _ in pairs}) == len({j for _, j in pairs}) == len(pairs)
    assert all(np.isfinite(bids[pair]) for pair in pairs)
    cost = np.where(np.isfinite(bids), bids, 1e4)
    chosen = linear_sum_assignment(cost)
    possible = np.isfinite(bids[chosen])
    assert len(pairs) == possible.sum()
    assert sum(bids[pair] for pair in pairs) == pytest.approx(bids[chosen][possible].sum(), abs=1e-3)
