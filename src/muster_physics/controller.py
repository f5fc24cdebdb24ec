"""The interface of closed-loop controllers, from commanded velocities to the forces of motors, and common parts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from muster.motion.grid import Floats
from muster_physics.simulated_model import Group, Indices, Motion


@dataclass(frozen=True)
class Commands:
    """The commands to some robots.

    Parameters
    ----------
    rates
        (n, 4): velocities in the map frame, m/s, and yaw rates, rad/s.
    ahead
        (n,) speeds ahead of robots that face their way, m/s.
    """

    rates: Floats
    ahead: Floats

    def of(self, who: Indices) -> Commands:
        return Commands(self.rates[who], self.ahead[who])


class Controller(Protocol):
    """Drives the robots of a group, which have the same kind of body.

    `following`, in 1/s, is the gain from the distance (and angle) behind the reference to additional speed (and yaw
    rate); one number, or (n, 4).
    """

    group: Group

    @property
    def following(self) -> float | Floats: ...

    def lags(self, motion: Motion) -> Floats:
        """By how much poses would still change after a command to stand: (n, 4), metres and radians."""
        ...

    def drive(self, commands: Commands, motion: Motion) -> None:
        """Set the motors for a step of physics."""
        ...

    def set_force_shares(self, shares: Floats) -> None:
        """Set the shares (n, 2) of commanded force that motors give from now on: left, right wheel; force, torque."""
        ...

    def odometers(self) -> Floats:
        """Metres ahead and radians to the left that wheels have rolled so far (n, 2); NaN for robots without wheels."""
        ...


def no_wheels(group: Group) -> Floats:
    return np.full((len(group.who), 2), np.nan)


def lags_of(x: Floats, y: Floats, z: Floats | float, turn: Floats, seconds: float) -> Floats:
    lags = np.empty((len(x), 4))
    lags[:, 0], lags[:, 1], lags[:, 2], lags[:, 3] = x, y, z, turn
    lags *= seconds
    return lags
