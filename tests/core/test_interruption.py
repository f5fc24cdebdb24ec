"""Ctrl-C is heard while the core looks for what sees what, which may take minutes."""

import os
import signal
import threading

import numpy as np
import pytest

from muster.motion.free_space import GridSpace
from muster.motion.grid import Grid
from muster.motion.paths import PathFinder


def test_while_a_graph_is_built():
    blocked = np.random.default_rng(1).random((1500, 1500)) < 0.02
    finder = PathFinder(GridSpace(Grid(blocked, 1.0)))
    press = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    press.start()
    with pytest.raises(KeyboardInterrupt):
        finder.lengths(np.random.default_rng(2).uniform(0, 1500, (200, 2)))
    press.join()
