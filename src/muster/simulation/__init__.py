"""The kinematic world, and what simulated worlds share; worlds are looked up by name in `muster.running.worlds`."""

from muster.motion.noise import CALM, NO_NOISE, Noise, Wind
from muster.simulation.kinematic_world import KinematicWorld
from muster.simulation.lasers import Laser
from muster.simulation.world import Contact, Observer, SimulatedWorld, WaypointPassed

__all__ = [
    "CALM",
    "NO_NOISE",
    "Contact",
    "KinematicWorld",
    "Laser",
    "Noise",
    "Observer",
    "SimulatedWorld",
    "WaypointPassed",
    "Wind",
]
