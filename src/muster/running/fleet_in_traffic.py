"""A fleet of real robots whose traffic is managed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from muster.execution.fleet import Fleet, is_paused
from muster.mission.model import Event, Mission, Robot
from muster.motion.port import RobotPort
from muster.traffic.manager import LOOK_S, TrafficManager


class FleetInTraffic:
    """A `Fleet` that is another's, whose robots are ordered through a manager of traffic.

    Parameters
    ----------
    mission
        has the robots; those that are discovered join.
    """

    def __init__(self, fleet: Fleet, manager: TrafficManager, mission: Mission) -> None:
        self._fleet, self._manager = fleet, manager
        self._look_s = fleet.time_s
        self.ports = _ManagedPorts(fleet, manager, {robot.id: robot for robot in mission.all_robots})

    @property
    def paused(self) -> bool:
        return is_paused(self._fleet)

    @property
    def time_s(self) -> float:
        return self._fleet.time_s

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`. Traffic looks at robots in between."""
        if self.time_s >= self._look_s:
            self._manager.look(self.time_s)
            self._look_s = self.time_s + LOOK_S
        happened = self._fleet.advance(min(until_s, self._look_s))
        for event in happened:
            if event.robot_joins is not None:
                self.ports.robots[event.robot_joins.id] = event.robot_joins
        return happened

    def stop(self) -> None:
        self._fleet.stop()

    def close(self) -> None:
        self._fleet.close()


class _ManagedPorts(Mapping[str, RobotPort]):
    """Each is managed from when it is first asked for."""

    def __init__(self, fleet: Fleet, manager: TrafficManager, robots: dict[str, Robot]) -> None:
        self.robots = robots
        self._fleet, self._manager = fleet, manager
        self._managed: dict[str, RobotPort] = {}

    def __getitem__(self, robot: str) -> RobotPort:
        if robot not in self._managed:
            self._managed[robot] = self._manager.managed(self.robots[robot], self._fleet.ports[robot])
        return self._managed[robot]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fleet.ports)

    def __len__(self) -> int:
        return len(self._fleet.ports)
