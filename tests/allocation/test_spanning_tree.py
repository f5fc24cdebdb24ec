"""The least spanning tree of a root and tasks, over all legs at once and a row at a time."""

import itertools
import math

import numpy as np
import pytest

from muster import core
from muster.allocation.bounds.spanning import _tree_of_rows, never, spanning_tree


def legs_of(rng, n, *, gaps):
    legs = np.round(rng.random((n, n)) * 20) / 4  # some are equal
    legs = np.minimum(legs, legs.T)
    missing = rng.random((n, n)) < gaps
    legs[missing | missing.T | np.eye(n, dtype=bool)] = math.inf
    return legs


@pytest.mark.parametrize("gaps", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("n", [1, 2, 7, 60])
def test_both_are_the_same_tree(n, gaps):
    rng = np.random.default_rng(n)
    for _ in range(20):
        legs, p = legs_of(rng, n, gaps=gaps), rng.normal(size=n)
        root = np.where(rng.random(n) < gaps, math.inf, rng.random(n) * 5)
        joined, parent = spanning_tree(legs, root, p)
        by_rows, parents = _tree_of_rows(legs.__getitem__, root, p, never)
        assert joined.sum() == by_rows.sum()
        if math.isfinite(joined.sum()):
            assert np.array_equal(joined, by_rows)
            assert np.array_equal(parent, parents)


def test_no_tree_is_less():
    rng = np.random.default_rng(5)
    legs, root = legs_of(rng, 4, gaps=0.0), rng.random(4) * 5
    costs = [
        sum(root[j] if i < 0 else legs[i, j] for j, i in enumerate(parents))
        for parents in itertools.product(range(-1, 4), repeat=4)
        if is_tree(parents)
    ]
    assert len(costs) == 5**3  # as there are trees of five places
    assert spanning_tree(legs, root)[0].sum() == pytest.approx(min(costs))


def is_tree(parents):
    """Whether all tasks lead to the root, -1."""
    for j in range(len(parents)):
        seen = set()
        while j >= 0 and j not in seen:
            seen.add(j)
            j = parents[j]
        if j >= 0:
            return False
    return True


def test_no_tasks_are_no_tree():
    joined, parent = spanning_tree(np.zeros((0, 0)), np.zeros(0))
    assert joined.shape == parent.shape == (0,)


def test_arrays_that_do_not_belong_together_are_refused():
    with pytest.raises(ValueError, match="as many columns as rows"):
        core.spanning_tree(np.zeros((2, 3)), np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2, np.int64))
    with pytest.raises(ValueError, match="one entry for each row"):
        core.spanning_tree(np.zeros((2, 2)), np.zeros(3), np.zeros(2), np.zeros(2), np.zeros(2, np.int64))
