"""Paths: where they turn."""

import numpy as np
import pytest

from muster.motion.path import Path


@pytest.mark.parametrize(
    ("points", "turns"),
    [
        ([[0, 0]], [[0, 0]]),
        ([[0, 0], [1, 1]], [[0, 0], [1, 1]]),
        ([[0, 0], [1, 0], [2, 0], [5, 0]], [[0, 0], [5, 0]]),
        ([[0, 0], [1, 0], [2, 1], [3, 2], [3, 3]], [[0, 0], [1, 0], [3, 2], [3, 3]]),
        ([[0, 0], [3, 0], [1, 0]], [[0, 0], [3, 0], [1, 0]]),
        ([[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 2]], [[0, 0, 0], [2, 2, 2], [3, 3, 2]]),
    ],
)
def test_turns(points, turns):
    path = Path(np.array(points, dtype=np.float64))
    assert path.turns.tolist() == turns
    assert Path(path.turns).length_m == pytest.approx(path.length_m)
