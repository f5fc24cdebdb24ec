"""Batteries of bodies: how much they hold, and what is drawn from them beside the work of rotors and wheels.

A drone's holds what lets it hover for its flight time. A ground robot's is the TurtleBot3 Waffle's, 19.98 Wh for two
hours of operation [robotis2017]; what that draws in the mean it draws all the time, wheels beside.
"""

from __future__ import annotations

from dataclasses import dataclass

from muster_physics.bodies import BodyKind, RobotBody

WAFFLE_J = 19.98 * 3600.0
WAFFLE_OPERATION_S = 2 * 3600.0


@dataclass(frozen=True)
class PowerSupply:
    """A battery of a capacity in joules, from which a body draws `standing_w` all the time."""

    capacity_j: float
    standing_w: float

    def drained(self, energy_j: float, seconds: float) -> float:
        """The share of the capacity that this work, and being on for so long, have drained."""
        return (energy_j + self.standing_w * seconds) / self.capacity_j


def power_supply(body: RobotBody) -> PowerSupply:
    """The supply of a body; in proportion to its mass."""
    if body.kind is BodyKind.ROTORCRAFT:
        airframe = body.rotorcraft
        return PowerSupply(airframe.hover_w * airframe.flight_s, 0.0)
    capacity_j = WAFFLE_J * body.scale**3
    return PowerSupply(capacity_j, capacity_j / WAFFLE_OPERATION_S)
