"""Collision avoidance: one method per file behind one interface, and crowds of robots that use one."""

from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.avo import Avo
from muster.motion.avoidance.crowd import Crowd, Trajectories, perturbed, run, towards
from muster.motion.avoidance.hrvo import Hrvo
from muster.motion.avoidance.method import Method
from muster.motion.avoidance.orca import Orca
from muster.motion.avoidance.rvo import Rvo

__all__ = [
    "NO_OBSTACLES",
    "Agents",
    "Avo",
    "Crowd",
    "Hrvo",
    "Method",
    "Obstacles",
    "Orca",
    "Rvo",
    "Trajectories",
    "perturbed",
    "run",
    "towards",
]
