"""The hexacopter: it moves as the quadcopter does; where motors and rotors are simulated, it has six of them."""

from __future__ import annotations

from muster.motion.kinematics.quadcopter import Quadcopter


class Hexacopter(Quadcopter):
    """A quadcopter's motion. The physics world flies it as an AscTec Firefly, rotor by rotor."""

    name = "hexacopter"
