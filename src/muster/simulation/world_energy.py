"""The energy of the robots of one simulated world: what each uses and is given as time goes on, and who is empty."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np

from muster import core
from muster.mission.model import Mission, Robot
from muster.model.energy import Energy
from muster.motion.grid import Floats
from muster.simulation.energy import NONE, GivenEnergy, SimulatedEnergy, capacity_in_usage, of_robot, require_by_robot
from muster.simulation.port import Serving, SimulatedPort
from muster.simulation.station_service import WorldStations

_STILL = 1e-6  # metres, or radians, that a robot may move in a step and stand

DrainedBy = Callable[[Robot, int, SimulatedPort], Callable[[], float]]
"""Returns what tells the share that a robot, by its number, has drained of a battery that the mission does not give."""


@dataclass(frozen=True)
class EnergyLook:
    """What is compared after some steps: (m, 2) metres travelled and headings, and who is served at which station."""

    moved: Floats
    served: Mapping[str, Serving | None]


_NOTHING = EnergyLook(np.zeros((0, 2)), {})
"""The look at robots of which none has a battery of the mission."""


class WorldEnergy:
    """The energy of all robots of a world.

    Parameters
    ----------
    mission, crowd
        of the world.
    drained_by
        see `DrainedBy`.
    snapshot
        of the world that this one continues, if any.
    given
        see `GivenEnergy`.

    Raises
    ------
    ParameterError
        if a number is out of range, or its robot is not in the mission.
    """

    def __init__(
        self,
        mission: Mission,
        crowd: core.CrowdWorld,
        drained_by: DrainedBy,
        snapshot: Mapping[str, Any] | None,
        **given: Unpack[GivenEnergy],
    ) -> None:
        self._at_start = {**given.get("batteries", NONE), **(snapshot["charges"] if snapshot is not None else {})}
        self._drain = given.get("drain", NONE)
        for what, values in (("battery", self._at_start), ("drain", self._drain)):
            require_by_robot(what, values, [robot.id for robot in mission.all_robots])
        self._crowd, self._drained_by = crowd, drained_by
        self._in_time = mission.rules.usage == "time"
        self._stations = WorldStations.of(mission.stations)
        self._ports: dict[str, SimulatedPort] = {}
        self._numbers: dict[str, int] = {}
        self._moving_s: dict[str, float] = {}  # of robots with a battery of the mission
        self._empty: set[str] = set()

    @property
    def limited(self) -> bool:
        """Whether a robot stops when its battery is empty."""
        return bool(self._moving_s)

    def begin(self, robot: Robot, number: int, port: SimulatedPort) -> None:
        """Give a robot its battery, if it has one: of the mission, drained by usage; else as the world has it."""
        self._ports[robot.id], self._numbers[robot.id] = port, number
        energy, drain = Energy.of(robot), of_robot(self._drain, robot.id, 1.0)
        at_start = of_robot(self._at_start, robot.id, None if robot.battery is None else robot.battery.at_start)
        if at_start is None:
            return
        if energy is None:
            capacity, used = 1.0, self._drained_by(robot, number, port)
        else:
            self._moving_s[robot.id] = 0.0
            capacity, used = energy.capacity, self._usage_of(robot, number, port)
        port.energy = SimulatedEnergy(capacity, at_start * capacity, used, drain, counted=0.0)

    def drained_by_usage(self, robot: Robot, number: int, port: SimulatedPort) -> Callable[[], float]:
        """Return what tells the share of its work capacity that a robot has used.

        A stop costs what it costs where the mission does not say how long it takes: its seconds times the speed.
        """
        capacity = capacity_in_usage(robot)
        if self._in_time:
            return lambda: (self._crowd.travelled()[number] / robot.speed_mps + port.held_s) / capacity
        return lambda: (self._crowd.travelled()[number] + port.stay_usage) / capacity

    def recover(self, robot: str) -> None:
        """Fill the battery of a robot that was empty."""
        energy = self._ports[robot].energy
        if robot in self._empty and energy is not None:
            self._empty.discard(robot)
            energy.add(math.inf)

    def snapshot(self) -> dict[str, dict[str, float]]:
        """Return the share of its battery that each robot has, where it has one."""
        energies = {name: port.energy for name, port in self._ports.items()}
        return {"charges": {name: energy.look().share for name, energy in energies.items() if energy is not None}}

    def look(self) -> EnergyLook:
        """What `emptied_since` compares."""
        if not self._moving_s:
            return _NOTHING
        return EnergyLook(self._moved(), {robot: self._ports[robot].serving for robot in self._moving_s})

    def emptied_since(self, before: EnergyLook, seconds: float) -> list[int]:
        """Count what was used and given since a look; the numbers of robots that are empty now, and were not."""
        if not self._moving_s:
            return []
        moved = np.abs(self._moved() - before.moved).max(axis=1)
        largest_m = max(port.body.radius_m for port in self._ports.values())
        emptied = []
        for robot in self._moving_s:
            port = self._ports[robot]
            if moved[self._numbers[robot]] > _STILL:
                self._moving_s[robot] += seconds
            self._stations.serve(port, before.served[robot], seconds, largest_m)
            if port.energy is not None and port.energy.look().level <= 0.0 and robot not in self._empty:
                self._empty.add(robot)
                emptied.append(self._numbers[robot])
        return emptied

    def _usage_of(self, robot: Robot, number: int, port: SimulatedPort) -> Callable[[], float]:
        """What tells a robot's usage, in the mission's unit: way and work, or the time of both; waiting is none."""
        if self._in_time:
            return lambda: self._moving_s[robot.id] + port.held_s
        return lambda: float(self._crowd.travelled()[number]) + port.stay_usage

    def _moved(self) -> Floats:
        return np.column_stack([self._crowd.travelled(), self._crowd.headings()])
