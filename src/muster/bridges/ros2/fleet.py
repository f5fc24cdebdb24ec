"""Robots of ROS 2 as a fleet: those of a mission, and those that are found while it goes on.

Each is given goals, one after the other: as poses on `<robot>/goal_pose`, or by Nav2's action
`<robot>/navigate_to_pose`. It has arrived when its pose (`port`), or Nav2, says so. All happens in the
thread that calls `advance`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from muster.bridges.ros2.goals import Goals, Nav2Goals, PoseGoals
from muster.bridges.ros2.joining import Newcomers
from muster.bridges.ros2.messages import PoseStamped
from muster.bridges.ros2.names import ros_names
from muster.bridges.ros2.port import Arrival, Ros2Port
from muster.bridges.ros2.wire import Wire, open_wire
from muster.mission.clock import Clock, SystemClock
from muster.mission.model import Event, Mission, Robot

Give = Literal["goals", "nav2"]
_POLL_S = 0.02
_LAST_WORDS_S = 0.2
"""That what was said last takes to arrive."""
_STOPS_WITHIN_S = 2.0


class Ros2Fleet:
    """The robots of a mission in a domain of ROS 2; see `bridges.fleet.Fleet`.

    Parameters
    ----------
    mission
        robot `r_0` is at `/r_0/pose` or `/r_0/odom`.
    wire
        by which they are reached, closed with the fleet; None: as `open_wire()` does.
    give
        `goals`: poses on a topic; `nav2`: Nav2's action.
    namespace
        in which the robots' own are; "" for the root.
    arrival
        when a way point is reached.
    joins
        whether robots that the mission does not name may join.

    Raises
    ------
    MissingExtraError, NetworkError, ParameterError
        as of `open_wire` and `Wire.navigator`; if two robots have the same name in ROS.
    """

    def __init__(
        self,
        mission: Mission,
        *,
        wire: Wire | None = None,
        give: Give = "goals",
        namespace: str = "",
        arrival: Arrival | None = None,
        joins: bool = True,
        clock: Clock | None = None,
    ) -> None:
        self._clock: Clock = clock or SystemClock()
        self._begin = self._clock.now()
        self._namespace, self._give, self._arrival = namespace.strip("/"), give, arrival or Arrival()
        self._flat = mission.dimensions == 2
        self._wire = open_wire() if wire is None else wire
        self._ports: dict[str, Ros2Port] = {}
        try:
            names = ros_names(robot.id for robot in mission.robots)
            for robot in mission.robots:
                self._ports[robot.id] = self._reached(robot, names[robot.id])
        except BaseException:
            self._wire.close()
            raise
        self._newcomers = self._looks(names) if joins else None

    @property
    def ports(self) -> Mapping[str, Ros2Port]:
        """See `Fleet`."""
        return self._ports

    @property
    def time_s(self) -> float:
        """See `Fleet`."""
        return self._clock.now() - self._begin

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`: returns before, where a way point is passed or a robot joins."""
        while True:
            self._wire.wait(max(0.0, min(until_s - self.time_s, _POLL_S)))
            passed = [port.hear(self.time_s) for port in self._ports.values()]
            events = self._joined()
            if events or any(passed) or self.time_s >= until_s:
                return events

    def unheard(self) -> dict[str, str]:
        """Robots of the mission that cannot be sent anywhere yet, and what is missing, by what has come until now."""
        self._hear_for(0.0)
        return {name: port.missing for name, port in self._ports.items() if port.missing}

    def stop(self) -> None:
        """See `Fleet`: goals become where robots are, or are cancelled."""
        for port in self._ports.values():
            port.cancel()
        until = self.time_s + _STOPS_WITHIN_S
        self._hear_for(_LAST_WORDS_S)
        while self.time_s < until and not all(port.goals.at_rest for port in self._ports.values()):
            self._hear_for(_POLL_S)

    def close(self) -> None:
        """See `Fleet`."""
        self._wire.close()

    def _hear_for(self, seconds: float) -> None:
        self._wire.wait(seconds)
        for port in self._ports.values():
            port.hear(self.time_s)

    def _joined(self) -> list[Event]:
        found = [] if self._newcomers is None else self._newcomers.look(self.time_s)
        for port in found:
            self._ports[port.robot] = port
        return [Event(at_s=self.time_s, robot_joins=port.body) for port in found]

    def _reached(self, robot: Robot, name: str) -> Ros2Port:
        topics = "/".join(["", *filter(None, [self._namespace]), name])
        return Ros2Port(robot, self._wire, topics, self._goals(topics), self._arrival, flat=self._flat)

    def _goals(self, topics: str) -> Goals:
        if self._give == "nav2":
            return Nav2Goals(self._wire.navigator(f"{topics}/navigate_to_pose"))
        return PoseGoals(self._wire.writer(f"{topics}/goal_pose", PoseStamped))

    def _looks(self, names: Mapping[str, str]) -> Newcomers:
        def reach(robot: Robot) -> Ros2Port:
            return self._reached(robot, robot.id)

        return Newcomers(self._wire, self._namespace, names.values(), reach, flat=self._flat)
