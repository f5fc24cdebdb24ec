"""Robots that drive push each other in narrow places, turn meanwhile, and do not touch."""

from muster import Simulation, solve
from muster_studies.jams import scenes


def test_who_pushes_another_and_turns_does_not_touch_it():
    mission = scenes.dead_ends("differential-drive", 0)
    simulation = Simulation(mission, solve(mission, "greedy"), avoidance="hrvo", traffic="free")
    while not simulation.done:
        simulation.advance(simulation.time_s + 60.0)
        assert simulation.time_s < 1000.0
    assert simulation.result().contacts == 0
