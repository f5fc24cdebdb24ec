"""The search for neighbours against looking at everybody."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.motion.avoidance import Agents


def agents_at(positions):
    count = len(positions)
    return Agents(
        positions=positions,
        velocities=np.zeros_like(positions),
        preferred=np.zeros_like(positions),
        radii=np.zeros(count),
        max_speeds=np.zeros(count),
    )


@pytest.mark.parametrize("dimensions", [2, 3])
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 120),
    most=st.integers(0, 12),
    distance=st.sampled_from([0.5, 3.0, np.inf]),
    lattice=st.booleans(),
)
def test_equals_brute_force(dimensions, seed, count, most, distance, lattice):
    positions = np.random.default_rng(seed).uniform(0, 10, (count, dimensions))
    positions = np.round(positions) if lattice else positions  # many equal distances, and places taken twice
    agents = agents_at(positions)
    found = (agents.in_plane() if dimensions == 2 else agents.in_space()).near(most, distance)
    for i, near in enumerate(found):
        squared = ((positions - positions[i]) ** 2).sum(axis=1)
        order = sorted((squared[k], *positions[k], k) for k in range(count) if k != i and squared[k] <= distance**2)
        assert near == [key[-1] for key in order[:most]]
