"""Robots on ROS 2 as a fleet: those of a mission, and those that are discovered during it.

Each is given goals, one after the other: as poses on `<robot>/goal_pose`, or by Nav2's action
`<robot>/navigate_to_pose`. It has arrived when its pose (`port`), or Nav2, says so. All happens in the
thread that calls `advance`.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from muster.mission.errors import NetworkError
from muster.mission.model import Event, Mission, Robot
from muster.mission.system.clock import Clock, SystemClock
from muster.perception.robot_grids import RobotGrid
from muster_robots.discovery import pose_topics, topics_in
from muster_robots.fleet_settings import Ros2Settings
from muster_robots.pose_custody import failures
from muster_robots.ros2.goals import Goals, Nav2Goals, PoseGoals
from muster_robots.ros2.joining import Ros2Newcomers
from muster_robots.ros2.map_frame import Ros2MapFrame
from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.names import ros_names
from muster_robots.ros2.open_middleware import open_middleware
from muster_robots.ros2.port import Arrival, Ros2Port
from muster_robots.ros2.robot_maps import Ros2Maps
from muster_robots.ros2.simulator_clock import SimulatorClock
from muster_robots.tied_frames import start_frame, start_pose

if TYPE_CHECKING:
    from muster_robots.ros2.target_localization import Ros2TargetLocalization
    from muster_robots.target_search import SearchSettings

_POLL_S = 0.02
_LAST_WORDS_S = 0.2
"""That what was said last takes to arrive."""
_STOPS_WITHIN_S = 2.0
_log = logging.getLogger(__name__)


class Ros2Fleet:
    """The robots of a mission in a domain of ROS 2; see `execution.fleet.Fleet`.

    Parameters
    ----------
    mission
        robot `r_0` is at `/r_0/pose` or `/r_0/odom`.
    settings
        how they are reached, given goals and kept; those of `muster run --fleet ros2` without it.
    middleware
        by which they are reached, closed with the fleet; None: as the settings say.
    targets
        how tags that robots' cameras see are found; None: cameras are not heard.
    clock
        by which the mission goes; None: as the settings say.

    Raises
    ------
    MissingExtraError, NetworkError, ParameterError
        as of `open_middleware` and `Middleware.navigator`; if two robots have the same name in ROS.
    """

    def __init__(
        self,
        mission: Mission,
        settings: Ros2Settings | None = None,
        *,
        middleware: Middleware | None = None,
        targets: SearchSettings | None = None,
        clock: Clock | None = None,
    ) -> None:
        how = settings or Ros2Settings()
        self._namespace, self._topics = how.namespace, topics_in(how.namespace)
        self._pose_topic = pose_topics(how.poses)
        self._give, self._arrival = how.give, Arrival(near_m=how.arrival_m)
        self.limits, self._custody_limits = how.limits, how.custody_limits
        self._flat = mission.dimensions == 2
        self._middleware = open_middleware(how.by, how.domain) if middleware is None else middleware
        self._simulator = SimulatorClock(self._middleware) if how.use_sim_time else None
        self._clock: Clock = clock or self._simulator or SystemClock()
        self.simulated_time = clock is not None or how.use_sim_time
        self._begin = self._clock.now()
        self._frames = Ros2MapFrame(self._middleware, how.frame)
        self._ports: dict[str, Ros2Port] = {}
        try:
            names = ros_names(robot.id for robot in mission.robots)
            for robot in mission.robots:
                if how.odometry == "start":
                    self._frames.fix(start_frame(self._topics(names[robot.id])), start_pose(robot))
                self._ports[robot.id] = self._reached(robot, names[robot.id])
            self._targets = None if targets is None else self._searched(mission, names, targets)
        except BaseException:
            self._middleware.close()
            raise
        self._names, self._maps, self._hears_maps = names, Ros2Maps(self._middleware, self._frames), False
        self._newcomers = None if how.known_only else self._looks(names)

    @property
    def ports(self) -> Mapping[str, Ros2Port]:
        """See `Fleet`."""
        return self._ports

    @property
    def time_s(self) -> float:
        """See `Fleet`."""
        return self._clock.now() - self._begin

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`: returns before, where a way point is passed, or a robot joins or is put out."""
        real_until = time.monotonic() + until_s - self.time_s
        while True:
            self._middleware.wait(max(0.0, min(until_s - self.time_s, _POLL_S)))
            passed = self._hear()
            failed = failures([port.custody for port in self._ports.values()], self.time_s, self.time_s)
            events = [*self._joined(), *self._found(), *failed]
            stands = self._simulator is not None and time.monotonic() >= real_until  # the simulator's clock
            if events or any(passed) or self.time_s >= until_s or stands:
                return events

    def robots_not_ready(self) -> dict[str, str]:
        """Robots of the mission that cannot be sent anywhere yet, and what is missing, by what has come until now."""
        self._middleware.wait(0.0)
        self._hear()
        if self._simulator is not None and not self._simulator.has_begun:
            return dict.fromkeys(self._ports, "use_sim_time is set, and nothing is on /clock; expected a simulator")
        missing = {robot: port.missing or self._maps.missing(robot) for robot, port in self._ports.items()}
        return {name: why for name, why in missing.items() if why}

    def hear_maps(self) -> None:
        """See `MappingFleet`."""
        self._hears_maps = True
        for robot in self._ports:
            self._maps.listen(robot, self._topics(self._names.get(robot, robot)))

    def new_maps(self) -> Mapping[str, RobotGrid]:
        """See `MappingFleet`."""
        return self._maps.new()

    def stop(self) -> None:
        """See `Fleet`: goals become where robots are, or are cancelled. One that fails does not keep it from others.

        Raises
        ------
        NetworkError
            if a robot could not be told; all others were.
        """
        failed: dict[str, Exception] = {}
        _try(failed, "", partial(self._middleware.wait, 0.0))
        for name, port in self._ports.items():
            _try(failed, name, port.cancel)
        until, wait_s = self.time_s + _STOPS_WITHIN_S, _LAST_WORDS_S
        while True:
            _try(failed, "", partial(self._middleware.wait, wait_s))
            for name, port in self._ports.items():
                _try(failed, name, port.hear)
            if self.time_s >= until or all(port.at_rest for port in self._ports.values()):
                break
            wait_s = _POLL_S
        self._say_who_was_not_told(failed)

    def _say_who_was_not_told(self, failed: Mapping[str, Exception]) -> None:
        lines = [f"ROS 2: {failed['']}"] if "" in failed else []
        for name, port in self._ports.items():
            if port.is_to_stay and name in failed:
                lines.append(f"robot {name} was not told to stay: {failed[name]}")
            elif port.is_to_stay:
                _log.warning("robot %s was not heard, and not told to stay: it may go on to its last goal", name)
            elif not port.at_rest:
                _log.warning(
                    "robot %s was told to stay, and does not say within %g s that it does", name, _STOPS_WITHIN_S
                )
        if lines:
            raise NetworkError("; ".join(lines)) from next(iter(failed.values()))

    @property
    def not_told(self) -> list[str]:
        """Robots that did not get the command to stay where they are."""
        return [name for name, port in self._ports.items() if port.is_to_stay]

    def close(self) -> None:
        """See `Fleet`."""
        self._middleware.close()

    def _hear(self) -> list[bool]:
        """Take in what has come; returns of each robot whether it has passed a way point."""
        self._frames.hear(self.time_s)
        passed = [port.hear() for port in self._ports.values()]
        self._frames.moved = []
        return passed

    def _joined(self) -> list[Event]:
        found = [] if self._newcomers is None else self._newcomers.look(self.time_s)
        for port in found:
            self._ports[port.robot] = port
            if self._hears_maps:
                self._maps.listen(port.robot, self._topics(port.robot))
        return [Event(at_s=self.time_s, robot_joins=port.body) for port in found]

    def _found(self) -> list[Event]:
        """Tasks that robots' cameras have found, or found to lie elsewhere."""
        found = [] if self._targets is None else self._targets.look()
        return [replace(event, at_s=self.time_s) for event in found]

    def _searched(self, mission: Mission, names: Mapping[str, str], settings: SearchSettings) -> Ros2TargetLocalization:
        from muster_robots.ros2.target_localization import Ros2TargetLocalization

        topics = {robot: self._topics(name) for robot, name in names.items()}
        return Ros2TargetLocalization(mission, self._middleware, topics, settings)

    def _reached(self, robot: Robot, name: str) -> Ros2Port:
        topics = self._topics(name)
        return Ros2Port(
            robot,
            self._middleware,
            topics,
            self._goals(topics),
            self._arrival,
            flat=self._flat,
            clock=lambda: self.time_s,
            frames=self._frames,
            pose_topic=self._pose_topic(name),
            stamp=time.time if self._simulator is None else self._simulator.stamp,
            limits=self._custody_limits,
        )

    def _goals(self, topics: str) -> Goals:
        if self._give == "nav2":
            action = f"{topics}/navigate_to_pose"
            return Nav2Goals(self._middleware.navigator(action), action)
        topic = f"{topics}/goal_pose"
        others = self._middleware.others(topic, PoseStamped)
        return PoseGoals(self._middleware.writer(topic, PoseStamped), topic, others)

    def _looks(self, names: Mapping[str, str]) -> Ros2Newcomers:
        def reach(robot: Robot) -> Ros2Port:
            return self._reached(robot, robot.id)

        return Ros2Newcomers(self._middleware, self._namespace, names.values(), reach, flat=self._flat)


def _try(failed: dict[str, Exception], whose: str, act: Callable[[], object]) -> None:
    """Act, and note an error of any kind: other robots are still to get the command."""
    try:
        act()
    except Exception as error:
        failed[whose] = error
