"""Robots of a world whose traffic is managed: their ports, and the time that goes by between what they say."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from muster.mission.model import Mission, Robot
from muster.motion.port import RobotPort
from muster.traffic.manager import LOOK_S, TrafficManager

if TYPE_CHECKING:
    from muster.running.state_estimation import RobotsInWorld
    from muster.simulation import SimulatedWorld, WaypointPassed


class RobotsInTraffic:
    """A `RobotsInWorld` whose robots are ordered through a manager of traffic.

    Parameters
    ----------
    robots
        as they are without it.
    world
        in which they are.
    """

    def __init__(self, robots: RobotsInWorld, world: SimulatedWorld, manager: TrafficManager, mission: Mission) -> None:
        self._robots, self._world, self._manager = robots, world, manager
        self._ports: dict[str, RobotPort] = {}
        self._look_s = world.time_s
        for robot in mission.robots:
            self.join(robot)

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """See `RobotsInWorld`."""
        return self._ports

    def join(self, robot: Robot) -> None:
        """Take in a robot that is in the world."""
        port = self._robots.ports[robot.id]
        self._ports[robot.id] = self._manager.managed(robot, port)
        if self._ports[robot.id] is not port:
            self._world.leave_to_traffic(robot.id)

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        self._manager.close(doors)

    def advance(self, until_s: float) -> tuple[WaypointPassed, ...]:
        """See `RobotsInWorld`: up to a time, or until a robot has passed a way point of its order."""
        passed = self._passed()
        while self._world.time_s + self._world.dt_s <= until_s + 1e-6 * self._world.dt_s:
            if self._world.time_s >= self._look_s - 1e-9:
                self._manager.look(self._world.time_s)
                self._look_s = self._world.time_s + LOOK_S
            points = self._robots.advance(max(min(until_s, self._look_s), self._world.time_s + self._world.dt_s))
            if points and self._passed() != passed:
                self._look_s = self._world.time_s  # orders follow
                return points
        return ()

    def _passed(self) -> list[tuple[int, int]]:
        said = [port.telemetry() for port in self._ports.values()]
        return [(one.order, one.passed) for one in said if one is not None]
