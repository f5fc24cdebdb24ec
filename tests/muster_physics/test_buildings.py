"""What is drawn of an image: just what is blocked."""

from importlib.util import find_spec

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

if find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)
from muster_physics.buildings import rectangles


@given(hnp.arrays(np.bool_, st.tuples(st.integers(1, 8), st.integers(1, 8))))
def test_rectangles_cover_each_blocked_cell_once(blocked):
    covered = np.zeros(blocked.shape, dtype=int)
    for left, right, low, high in rectangles(blocked):
        covered[low:high, left:right] += 1
    np.testing.assert_array_equal(covered, blocked.astype(int))
