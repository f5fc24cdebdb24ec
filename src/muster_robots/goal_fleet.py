"""A fleet of robots that find their way to goals themselves: what an adapter of another kind of robot is made of.

The adapter states how robots are reached (`RobotLink`). The fleet does the rest: it polls poses, gives goals one after
the other, each once, and again only where it was not delivered or a robot does not do it (`pose_custody`), and notices
arrivals and holds (`follower`).
"""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, Self

from muster.mission.model import Event, Mission, Robot
from muster.mission.system.clock import TIME_ROUNDING_S, Clock, SystemClock
from muster.motion.port import Place, Telemetry, Waypoint
from muster.running.live import wait_for_robots
from muster_robots.custody import Holder
from muster_robots.custody_settings import CustodySettings
from muster_robots.follower import Follower
from muster_robots.pose_custody import PoseCustody, failures
from muster_robots.pose_port import require_finite, velocity_by

NOT_DELIVERED = (OSError, ValueError)
"""Errors of a link that mean that nothing was delivered or understood: it is tried again. Others end the run."""
_POLL_S = 0.2
_STOPS_WITHIN_S = 2.0
LEASE_S = 10.0
"""Seconds for which orders hold where a link renews them: planning the rest again may take a few, without a poll."""
_TURNED_RAD = 0.1
_Goal = tuple[int, Place | None, float | None]
_log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class RobotPose:
    """What one robot reports.

    Parameters
    ----------
    x, y, z : float
        Position in the map frame, metres; z does not count in a mission in the plane.
    heading : float, default 0
        Radians from east, anticlockwise.
    age_s : float, default 0
        How old the report is, in seconds: a robot that has fallen silent has the same report, which grows older.
    charge : float, optional
        Share of its battery that is left, 0 to 1.
    taken_by : str, default ""
        Who else commands it now, such as "a person with a joystick"; it takes no part until nobody does, and it stands.
    """

    x: float
    y: float
    z: float = 0.0
    heading: float = 0.0
    age_s: float = 0.0
    charge: float | None = None
    taken_by: str = ""


class RobotLink(Protocol):
    """How robots are reached. Each call returns within a second, or raises an error of `NOT_DELIVERED`.

    A link may have a method `renew(seconds)`: orders hold for so long after each call, and then robots stop by
    themselves, as Muster may have been killed. It is called before each look at poses.
    """

    def poses(self) -> Mapping[str, RobotPose]:
        """Return what robots report, by their ids; those of which nothing is known are left out."""
        ...

    def go(self, robot: str, to: Waypoint) -> None:
        """Let a robot go to a place, in place of where it goes now."""
        ...

    def stop(self, robot: str) -> None:
        """Let a robot stop where it is."""
        ...


class GoalFleet:
    """The robots of a mission behind a link; see `muster.execution.fleet.Fleet`.

    Parameters
    ----------
    mission : Mission
        Whose robots they are.
    link : RobotLink
        How they are reached.
    arrival_m : float, default 0.25
        Distance to a way point at which it counts as reached, in metres.
    custody : CustodySettings, optional
        How long robots may be silent, in trouble or in other hands; the settings of the fleet, if made from these.
    clock, wait
        Time, and how it is waited for, in seconds; by default the system's.
    """

    def __init__(
        self,
        mission: Mission,
        link: RobotLink,
        *,
        arrival_m: float = 0.25,
        custody: CustodySettings | None = None,
        clock: Clock | None = None,
        wait: Callable[[float], None] = time.sleep,
    ) -> None:
        self._link, self._clock, self._wait = link, SystemClock() if clock is None else clock, wait
        self._renew: Callable[[float], object] = getattr(link, "renew", lambda _seconds: None)
        self.simulated_time = clock is not None
        self._begun_s, self._polled_s = self._clock.now(), -math.inf
        self._failing: dict[str, str] = {}  # why by robot, "" for the poll; the last to fail is the last
        flat, kept = mission.dimensions == 2, custody or CustodySettings()
        self.limits = kept.limits
        self.ports = {
            robot.id: GoalPort(
                robot, PoseCustody(robot.id, kept.custody_limits), lambda: self.time_s, arrival_m=arrival_m, flat=flat
            )
            for robot in mission.robots
        }
        self._custodies = [port.custody for port in self.ports.values()]

    @classmethod
    def ready(
        cls,
        mission: Mission,
        link: RobotLink,
        halt: threading.Event,
        *,
        wait_s: float = 10.0,
        arrival_m: float = 0.25,
        custody: CustodySettings | None = None,
    ) -> Self:
        """Return the fleet when each robot of the mission has reported its pose.

        Raises
        ------
        NetworkError
            If one has not within `wait_s` seconds.
        """
        fleet = cls(mission, link, arrival_m=arrival_m, custody=custody)
        wait_for_robots(fleet, halt, wait_s)
        return fleet

    @property
    def time_s(self) -> float:
        """See `Fleet`."""
        return self._clock.now() - self._begun_s

    @property
    def not_told(self) -> list[str]:
        """Robots that did not get their last order."""
        return [name for name, port in self.ports.items() if port.is_due]

    def robots_not_ready(self) -> dict[str, str]:
        """Return the robots of the mission that have not reported yet, and why, by what has come until now."""
        self._poll()
        why = self._failing.get("", "no pose")
        return {name: why for name, port in self.ports.items() if port.telemetry() is None}

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`: returns before, where a way point is passed, or a robot is put out."""
        while True:
            self._deliver()
            self._wait(max(0.0, min(until_s, self._polled_s + _POLL_S) - self.time_s))
            now = self.time_s + TIME_ROUNDING_S
            passed = now >= self._polled_s + _POLL_S and self._poll()
            events = failures(self._custodies, self.time_s, self.time_s)
            if passed or events or now >= until_s:
                self._deliver()
                return events

    def stop(self) -> None:
        """See `Fleet`. A robot that cannot be told is told again for two seconds."""
        for port in self.ports.values():
            port.cancel()
        until_s = self.time_s + _STOPS_WITHIN_S
        self._deliver()
        while self.not_told and self.time_s < until_s:
            self._wait(_POLL_S)
            self._deliver()

    def close(self) -> None:
        """See `Fleet`: calls the link's `close`, if it has one."""
        getattr(self._link, "close", lambda: None)()

    def _poll(self) -> bool:
        """Take in what robots report; returns whether one has passed a way point."""
        try:
            self._renew(LEASE_S)
            poses = self._link.poses()
        except NOT_DELIVERED as error:
            self._note("", error)
            poses = {}
        else:
            self._failing.pop("", None)
        self._polled_s = self.time_s
        passed = [port.hear(self.time_s, poses.get(name)) for name, port in self.ports.items()]
        return any(passed)

    def _deliver(self) -> None:
        """Send orders that are due, at last to robots that failed last; one failure ends it, as it may take long."""
        failed = list(self._failing)
        for name in sorted(self.not_told, key=lambda name: failed.index(name) if name in failed else -1):
            try:
                self.ports[name].deliver(self._link)
            except NOT_DELIVERED as error:
                self._note(name, error)
                return
            self._failing.pop(name, None)

    def _note(self, what: str, error: Exception) -> None:
        """Note what failed last, and log what had not failed before."""
        why = f"{type(error).__name__}: {error}"
        if self._failing.pop(what, None) is None:
            _log.warning("%s is not reached: %s", f"robot {what}" if what else "the server of the robots", why)
        self._failing[what] = why


class GoalPort:
    """One robot: a `RobotPort`."""

    def __init__(
        self, robot: Robot, custody: PoseCustody, clock: Callable[[], float], *, arrival_m: float, flat: bool
    ) -> None:
        self._robot, self.custody, self._clock, self._flat = robot, custody, clock, flat
        self._follower = Follower(arrival_m=arrival_m, turned_rad=_TURNED_RAD, flat=flat or robot.kind == "ground")
        self._said: Telemetry | None = None
        self._delivered: _Goal = (0, None, None)
        self._is_told_again = False

    @property
    def robot(self) -> str:
        return self._robot.id

    @property
    def is_due(self) -> bool:
        """Whether the robot is to get an order that was not delivered yet, or that it does not carry out."""
        return not self.custody.is_taken and (self._is_told_again or self._wanted != self._delivered)

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`.

        Raises
        ------
        ParameterError
            If a number of a way point is not finite.
        """
        require_finite(self.robot, waypoints)
        self.custody.want(self._clock(), goes=bool(waypoints))
        return self._follower.take(waypoints)

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self.custody.judged(self._said)

    def deliver(self, link: RobotLink) -> None:
        """Send the robot to its next way point, or let it stop; an error of `NOT_DELIVERED` leaves that due."""
        wanted = self._wanted
        if wanted[1] is None:
            link.stop(self.robot)
        else:
            link.go(self.robot, self._follower.target)
        self._delivered, self._is_told_again = wanted, False
        self.custody.told(self._clock())

    def hear(self, now: float, pose: RobotPose | None) -> bool:
        """Take in a report, and see whether the robot obeys; returns whether a way point is passed."""
        passed = self._take_in(now, pose)
        if pose is not None and pose.taken_by:
            self.custody.take(now, Holder.PILOT, pose.taken_by)
        is_there = self._follower.aim is None or self._follower.stays
        if self.custody.look(now, is_carried_out=is_there) is not None:
            self._is_told_again = True
        return passed

    def _take_in(self, now: float, pose: RobotPose | None) -> bool:
        """Take in a report, if it is new; returns whether a way point is passed."""
        time_s = -math.inf if pose is None else now - pose.age_s
        before = self._said
        if pose is None or (before is not None and time_s <= before.time_s + 1e-3):
            return False
        place = (pose.x, pose.y, 0.0 if self._flat else pose.z)
        passed = self._follower.hear(now, place, pose.heading)
        self.custody.hear(time_s, place, pose.heading)
        order = self._delivered[0]
        self._said = Telemetry(
            time_s,
            place,
            pose.heading,
            velocity_by(before, place, time_s),
            self._follower.odometry_m,
            order,
            self._follower.passed if order == self._follower.order else 0,
            charge=pose.charge,
        )
        return passed

    @property
    def _wanted(self) -> _Goal:
        """The number of the order, and where the robot is to go or to stay by it, with the heading there."""
        follower = self._follower
        if follower.aim is None and follower.passed == 0:
            return follower.order, None, None
        return follower.order, follower.target.position, follower.target.heading
