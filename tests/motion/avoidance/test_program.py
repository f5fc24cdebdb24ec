"""The linear program of ORCA against enumeration of all that could be its optimum."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster import core

SOLVERS = {2: core.nearest_in_plane, 3: core.nearest_in_space}


def random_spaces(dimensions, seed, count, reach):
    """Half-spaces with borders up to `reach` beyond the origin (in a ball of radius 1), and what is wanted."""
    random = np.random.default_rng(seed)
    normals = random.normal(size=(count, dimensions))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, random.uniform(-1.0, reach, count), tuple(random.normal(size=dimensions))


def enumerated(normals, offsets, wanted):
    """The nearest feasible point of all subsets of borders, the sphere among them; None if nothing is feasible."""
    wanted, dimensions = np.array(wanted), normals.shape[1]
    best = None
    for size in range(dimensions + 1):
        for chosen in itertools.combinations(range(len(normals)), size):
            a, b = normals[list(chosen)], offsets[list(chosen)]
            centre = np.linalg.pinv(a) @ b if size else np.zeros(dimensions)
            free = np.eye(dimensions) - (np.linalg.pinv(a) @ a if size else 0.0)
            towards = free @ wanted
            candidates = [centre + towards]
            left, length = 1.0 - centre @ centre, np.linalg.norm(towards)
            if left >= 0 and length > 1e-12:
                candidates.append(centre + np.sqrt(left) / length * towards)
            for x in candidates:
                if np.linalg.norm(x) <= 1 + 1e-9 and (normals @ x >= offsets - 1e-9).all():
                    distance = np.linalg.norm(x - wanted)
                    if best is None or distance < best:
                        best = distance
    return best


@pytest.mark.parametrize("dimensions", [2, 3])
@given(seed=st.integers(0, 10**6), count=st.integers(0, 7), reach=st.sampled_from([-0.2, 0.1, 0.5]))
def test_the_optimum_is_that_of_enumeration(dimensions, seed, count, reach):
    normals, offsets, wanted = random_spaces(dimensions, seed, count, reach)
    x, feasible = SOLVERS[dimensions](normals, offsets, 1.0, wanted)
    best = enumerated(normals, offsets, wanted)
    assert feasible == (best is not None)
    if feasible:
        assert np.linalg.norm(x) <= 1 + 1e-9
        assert (normals @ x >= offsets - 1e-9).all()
        assert np.linalg.norm(np.array(x) - wanted) == pytest.approx(best, abs=1e-7)


@pytest.mark.parametrize("dimensions", [2, 3])
@given(seed=st.integers(0, 10**6), hard=st.integers(0, 2))
def test_where_nothing_is_feasible_the_penetration_is_least(dimensions, seed, hard):
    """No shift of the soft borders that is smaller by a millionth leaves a point."""
    normals, offsets, wanted = random_spaces(dimensions, seed, 8, 0.9)
    offsets[:hard] = np.minimum(offsets[:hard], 0.0)
    solve = SOLVERS[dimensions]
    x, feasible = solve(normals, offsets, 1.0, wanted, hard)
    violations = offsets - normals @ x
    if feasible:
        assert (violations <= 1e-9).all()
        return
    assert np.linalg.norm(x) <= 1 + 1e-9
    assert (violations[:hard] <= 1e-9).all()
    soft = np.arange(8) >= hard
    depth = violations[soft].max()
    assert solve(normals, offsets - soft * (depth + 1e-9), 1.0, wanted)[1]
    assert not solve(normals, offsets - soft * (depth - 1e-6), 1.0, wanted)[1]


def test_by_hand():
    normals, offsets = np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([0.5, 0.25])
    assert core.nearest_in_plane(normals, offsets, 1.0, (0.0, 0.0)) == ([0.5, 0.25], True)
    x, feasible = core.nearest_in_plane(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.array([0.5, 0.25]), 1.0, (0.0, 0.0))
    assert not feasible
    assert x[0] == pytest.approx(0.125)
