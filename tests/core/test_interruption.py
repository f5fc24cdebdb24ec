"""Ctrl-C is heard while the core looks for what sees what, which may take minutes."""

import os
import signal
import threading

import numpy as np
import pytest

from muster import core
from muster.motion.grid import Grid
from muster.motion.paths.on_grid import core_grid


def test_a_graph_that_is_not_built_to_its_end_is_none():
    blocked = np.random.default_rng(1).random((1500, 1500)) < 0.02
    ways = core.Ways.on_grid(core_grid(Grid(blocked, 1.0)))
    press = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    press.start()
    with pytest.raises(KeyboardInterrupt):
        ways.build(2)
    press.join()
    assert not ways.built
    assert ways.pieces == 0
