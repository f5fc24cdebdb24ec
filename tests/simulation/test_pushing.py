"""Robots that drive push each other in narrow places, turn meanwhile, and do not touch."""

import pytest

from muster import Simulation, solve
from muster.generation import narrow


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(("scene", "seed"), [(narrow.dead_ends, 0), (narrow.one_way_door, 3)])
def test_who_pushes_another_and_turns_does_not_touch_it(scene, seed):
    mission = scene("differential-drive", seed)
    simulation = Simulation(mission, solve(mission, "greedy"), avoidance="hrvo", traffic="free", seed=seed)
    while not simulation.done:
        simulation.advance(simulation.time_s + 60.0)
        assert simulation.time_s < 1000.0
    assert simulation.result().contacts == 0
