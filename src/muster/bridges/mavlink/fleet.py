"""Drones behind MAVLink as a fleet: one session and one line each."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

from muster.bridges.mavlink.dialect import Codec
from muster.bridges.mavlink.endpoints import Line, line_to
from muster.bridges.mavlink.faults import Fault
from muster.bridges.mavlink.fence import fences_of, no_fence
from muster.bridges.mavlink.frames import GlobalFrame
from muster.bridges.mavlink.seen import Seen
from muster.bridges.mavlink.session import Session
from muster.bridges.mavlink.settings import Settings
from muster.mission.clock import Clock, SystemClock
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.kinds import shown
from muster.mission.model import Event, Mission, Robot
from muster.motion.port import Place, RobotPort, Telemetry, Waypoint

_STEP_S = 0.02


class MavlinkFleet:
    """The drones of a mission.

    Parameters
    ----------
    mission
        whose robots they are.
    endpoints
        for each robot how it is reached: see `line_to`.
    settings
        what is allowed: by default nothing but to listen.
    height_m
        how high above home they fly; for a mission in the plane, and for it alone.
    clock, wait
        time, and how it is waited for, in seconds.

    Raises
    ------
    ParameterError
        if robots and endpoints do not fit together, or the mission lacks an origin or heights.
    NetworkError
        if an endpoint cannot be opened.
    """

    def __init__(
        self,
        mission: Mission,
        endpoints: Mapping[str, str],
        settings: Settings | None = None,
        *,
        height_m: float | None = None,
        clock: Clock | None = None,
        wait: Callable[[float], None] = time.sleep,
    ) -> None:
        self._settings = Settings() if settings is None else settings
        _check(mission, endpoints, self._settings, height_m)
        self._clock, self._wait = SystemClock() if clock is None else clock, wait
        self._begun_s = self._clock.now()
        fences = fences_of(mission)
        self.sessions: dict[str, Session] = {}
        self._lines: dict[str, tuple[Line, Codec]] = {}
        try:
            for robot in mission.robots:
                seen = _seen_of(mission, robot)
                fence = fences.get(robot.id, no_fence)
                self.sessions[robot.id] = Session(robot, seen, self._settings, fence, height_m)
                self._lines[robot.id] = line_to(endpoints[robot.id]), Codec()
        except BaseException:
            self.close()
            raise
        self._ports = {robot: Port(session, lambda: self.time_s) for robot, session in self.sessions.items()}
        self._told: set[str] = set()

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        return self._ports

    @property
    def time_s(self) -> float:
        return self._clock.now() - self._begun_s

    @property
    def faults(self) -> list[Fault]:
        """What went wrong so far, in order of time."""
        found = [session.fault for session in self.sessions.values() if session.fault is not None]
        return sorted(found, key=lambda fault: fault.at_s)

    @property
    def remaining(self) -> dict[str, float | None]:
        """For each robot the work capacity that its battery leaves, in the mission's unit; without one the share.

        None before its battery was heard of.
        """
        shares = {name: session.seen.battery for name, session in self.sessions.items()}
        return {
            name: None if share is None else share * (self.sessions[name].robot.work_capacity or 1.0)
            for name, share in shares.items()
        }

    def connect(self, within_s: float = 10.0) -> None:
        """Wait until every drone has said who and where it is.

        Raises
        ------
        NetworkError
            if one does not.
        ParameterError
            if one is none that Muster flies, or stands far from where the mission says.
        """
        until = self.time_s + within_s
        while self.time_s < until and not all(session.located for session in self.sessions.values()):
            self._step()
        for name, session in self.sessions.items():
            if session.autopilot is None:
                raise NetworkError(f"{name}: no heartbeat within {within_s:g} s; expected a drone at its endpoint")
            if not session.located:
                raise NetworkError(
                    f"{name}: no position within {within_s:g} s; expected a drone that knows where it is"
                )
            self._require_near(session)

    def advance(self, until_s: float) -> Sequence[Event]:
        """Hear and speak; a drone that cannot go on is told once (`robot_fails`)."""
        while True:
            self._step()
            events = [self._event(fault) for fault in self.faults if fault.robot not in self._told]
            if events or self.time_s >= until_s:
                return events

    def stop(self) -> None:
        """Let every drone that flies hover, and go on speaking for as long as they need to hear it."""
        for session in self.sessions.values():
            session.hold(self.time_s)
        self._speak_for(3.0)

    def go_back(self) -> None:
        """Let every drone that flies return to where it was armed, and land there."""
        for session in self.sessions.values():
            session.go_back(self.time_s)
        self._speak_for(3.0)

    def land(self) -> None:
        """Let every drone that flies land where it is."""
        for session in self.sessions.values():
            session.land(self.time_s)
        self._speak_for(3.0)

    def close(self) -> None:
        for line, _ in self._lines.values():
            line.close()

    def _event(self, fault: Fault) -> Event:
        self._told.add(fault.robot)
        return Event(at_s=max(0.0, fault.at_s), robot_fails=fault.robot)

    def _speak_for(self, seconds: float) -> None:
        until = self.time_s + seconds
        while self.time_s < until:
            self._step()

    def _step(self) -> None:
        """Hear all lines, let sessions think, speak, wait."""
        for name, session in self.sessions.items():
            line, codec = self._lines[name]
            for message in codec.parse(line.read()):
                if message.get_srcComponent() == 1:  # the autopilot itself, not a camera or gimbal on board
                    session.hear(message, self.time_s)
            session.tick(self.time_s)
            for message in session.take():
                line.write(codec.pack(message))
        self._wait(_STEP_S)

    def _require_near(self, session: Session) -> None:
        place, start = session.seen.place, session.seen.start
        assert place is not None
        metres = ((place[0] - start[0]) ** 2 + (place[1] - start[1]) ** 2) ** 0.5
        if metres > self._settings.far_m:
            raise ParameterError(
                f"{session.robot.id}: stands {metres:.1f} m from its start in the mission; "
                f"expected at most {self._settings.far_m:g} m: check origin_wgs84 and its position"
            )


class Port:
    """One drone."""

    def __init__(self, session: Session, now: Callable[[], float]) -> None:
        self._session, self._now = session, now

    @property
    def robot(self) -> str:
        return self._session.robot.id

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        return self._session.follow(waypoints, self._now())

    def cancel(self) -> int:
        return self._session.hold(self._now())

    def telemetry(self) -> Telemetry | None:
        return self._session.telemetry()


def _seen_of(mission: Mission, robot: Robot) -> Seen:
    start: Place = (robot.position[0], robot.position[1], robot.position[2] if len(robot.position) > 2 else 0.0)
    return Seen(start, None if mission.origin_wgs84 is None else GlobalFrame(mission.origin_wgs84, start))


def _check(mission: Mission, endpoints: Mapping[str, str], settings: Settings, height_m: float | None) -> None:
    names = [robot.id for robot in mission.robots]
    for name in endpoints:
        if name not in names:
            raise ParameterError(f"endpoint: robot {shown(name)}; expected {' or '.join(names)}")
    for robot in mission.robots:
        if robot.id not in endpoints:
            raise ParameterError(f"endpoint: none for robot {shown(robot.id)}; expected one for each robot")
        if robot.kind != "air":
            raise ParameterError(f"robot {shown(robot.id)}: kind {robot.kind}; expected air: it is flown")
    if mission.origin_wgs84 is None and not settings.offboard:
        raise ParameterError(
            f"mission {mission.name}: no origin_wgs84; expected one, or way points said one by one (--offboard)"
        )
    if (mission.dimensions == 2) != (height_m is not None):
        told = "no height" if height_m is None else f"height {height_m:g} m"
        expected = "a height for a mission in the plane" if height_m is None else "none: the mission has heights"
        raise ParameterError(f"{told}; expected {expected} (--height)")
