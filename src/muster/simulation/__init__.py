"""Worlds in which a plan is carried out."""

from muster.simulation.kinematic_world import Contact, KinematicWorld, Observer, Passing
from muster.simulation.noise import NO_NOISE, Noise

__all__ = ["NO_NOISE", "Contact", "KinematicWorld", "Noise", "Observer", "Passing"]
