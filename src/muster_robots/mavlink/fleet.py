"""Drones behind MAVLink as a fleet: a session for each, and the links to them.

A thread hears and speaks from `connect` to `close`, because drones must hear way points, and heartbeats, while the
executor plans: PX4 leaves its offboard mode below 2 Hz. What it shares with the executor's is behind one lock.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

from muster.execution.final_state import FinalState
from muster.execution.fleet import Failure
from muster.execution.robots.monitor import Limits
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Event, Mission, Robot
from muster.mission.plan import Plan
from muster.mission.system.clock import Clock, SystemClock
from muster.mission.value_types import shown
from muster.motion.port import Place, RobotPort, Telemetry, Waypoint
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink.autopilots import AtEnd
from muster_robots.mavlink.drone import Drone, final_state_of
from muster_robots.mavlink.faults import Fault, Kind
from muster_robots.mavlink.fence import fences_of, no_fence
from muster_robots.mavlink.frames import GlobalFrame, LocalFrame, StartFrame
from muster_robots.mavlink.links import Link, links_of
from muster_robots.mavlink.planned_legs import Way, planned_refusals, show_fence
from muster_robots.mavlink.session import Session
from muster_robots.mavlink.telemetry import DroneTelemetry

_STEP_S = 0.02
_LAST_WORDS_S = 1.0, 15.0
"""Seconds, at least and at most, for which final commands are sent to drones that do not confirm, or are silent."""
_HEARTBEAT_S = 1.5
"""Seconds within which a drone sends a heartbeat."""
_COMPARED_S = 0.5
"""Seconds for which messages are compared before anything is ordered: two autopilots may have one system id."""
_STANDSTILL_S, _MOVED_M = 20.0, 3.0
"""A drone that returns or lands and moves less in this time is waited for no longer."""


class MavlinkFleet:
    """The drones of a mission.

    Parameters
    ----------
    mission
        whose robots they are.
    endpoints
        for each robot how it is reached: see `endpoint_of`.
    settings
        what is allowed: by default nothing but to listen.
    height_m
        how high above home they fly; for a mission in the plane, and for it alone.
    clock, wait
        time, and how it is waited for, in seconds; by default the system's. With another clock there is no thread:
        nothing is heard or said but in calls of the fleet.

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
        settings: FlightSettings | None = None,
        *,
        height_m: float | None = None,
        clock: Clock | None = None,
        wait: Callable[[float], None] = time.sleep,
    ) -> None:
        self._settings = FlightSettings() if settings is None else settings
        _check(mission, endpoints, self._settings, height_m)
        self._clock, self._wait = SystemClock() if clock is None else clock, wait
        self.simulated_time = clock is not None
        self._begun_s = self._clock.now()
        self._speaker = threading.Thread(target=self._speak_on, daemon=True) if clock is None else None
        self._lock, self._closed = threading.RLock(), threading.Event()
        self._failure: Exception | None = None  # of the thread that speaks
        fences = fences_of(mission)
        self.sessions: dict[str, Session] = {}
        for robot in mission.robots:
            drone = Drone(robot, _telemetry_of(mission, robot, self._settings), self._settings, height_m)
            self.sessions[robot.id] = Session(drone, fences.get(robot.id, no_fence))
        self._link_of: dict[str, Link] = links_of(endpoints)
        self._links = list({id(link): link for link in self._link_of.values()}.values())
        self._ports = {
            robot: Port(session, lambda: self.time_s, self._lock) for robot, session in self.sessions.items()
        }
        self._told: set[str] = set()
        self._listened = False

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        return self._ports

    @property
    def time_s(self) -> float:
        return self._clock.now() - self._begun_s

    @property
    def limits(self) -> Limits:
        """How long a drone may be silent, and how long the mission waits for one that is absent."""
        return self._settings.limits

    @property
    def faults(self) -> list[Fault]:
        """What went wrong so far, in order of time."""
        found = [fault for session in self.sessions.values() for fault in session.faults]
        return sorted(found, key=lambda fault: fault.at_s)

    def connect(self, within_s: float = 10.0, *, again: bool = False) -> None:
        """Wait until every drone has sent a heartbeat and its position.

        Parameters
        ----------
        within_s
            how long is waited, seconds.
        again
            whether an earlier run has begun the mission: drones are anywhere then, those that it has left in the air
            hover from now on, and those that are not heard are silent.

        Raises
        ------
        NetworkError
            if one does not; where the mission is under way, if none does.
        ParameterError
            if one is none that Muster flies, or stands far from where the mission says, or is not alone on its line.
        """
        self._listen_until(self.time_s + within_s, lambda drone: drone.located)
        self._listen_until(self.time_s + _COMPARED_S, lambda drone: drone.autopilot is None)
        heard = [name for name, session in self.sessions.items() if session.drone.located]
        for name, session in self.sessions.items():
            if again and heard and name not in heard:
                continue
            self._require_one(name, within_s)
            if not session.drone.located:
                raise NetworkError(
                    f"{name}: no position within {within_s:g} s; expected a drone that knows where it is"
                )
            if not again:
                self._require_near(session.drone)
        self._read_limits(may_refuse=not again)
        if again and self._settings.arm:
            self._tell_all(Session.take_over)
        if self._speaker is not None:
            self._speaker.start()

    def _read_limits(self, *, may_refuse: bool) -> None:
        """Read the limits that the autopilot of each drone sets, before the drone gets an order; see `show_fence`."""
        self._tell_all(Session.read_limits)
        while any(session.busy for session in self.sessions.values()):
            self._go_on()
        for session in self.sessions.values():
            show_fence(session.drone, may_refuse=may_refuse)

    def refusals(self, mission: Mission, plan: Plan, way: Way) -> Iterator[tuple[str, str, str]]:
        """For each task that an autopilot would refuse to fly: the robot, the task, and why; see `refusals_of`."""
        for robot in mission.robots:
            session = self.sessions[robot.id]
            if session.drone.limits.is_read:
                yield from planned_refusals(session.drone, mission, plan, way, session.fence)

    def finish(self, at_end: AtEnd, halted: Callable[[], bool]) -> None:
        """Give all drones the last order, and wait until they have landed; at `halted` they hover. `hold`: nothing."""
        if at_end == "hold" or halted():
            return
        self.end(at_end)
        self.await_landing(halted)
        if halted():
            self.stop()

    def recover(self, at_end: AtEnd, halted: Callable[[], bool]) -> None:
        """Let every drone that is Muster's return and land, or land where it is, and wait until drones are disarmed."""
        self.finish("return" if at_end == "hold" else at_end, halted)

    def advance(self, until_s: float) -> Sequence[Event]:
        """Receive and send; reports each drone with a fault once (`robot_fails`). Raises what has ended the thread."""
        while True:
            self._go_on()
            if self._failure is not None:
                raise self._failure
            events = [self._event(fault) for fault in self._new_faults()]
            if events or self.time_s >= until_s:
                return events

    def stop(self) -> None:
        """Let every flying drone hover, repeated until it is confirmed; on the ground none is left armed."""
        self._tell_all(Session.hold)
        self._speak_last_words()
        with self._lock:
            for session in self.sessions.values():
                session.note_missing_hold(self.time_s)

    def end(self, at_end: AtEnd) -> None:
        """Let every drone that flies, and answers, end its flight: also those that take no part any more."""

        def tell(session: Session, now: float) -> None:
            session.end(at_end, now)

        self._tell_all(tell)
        self._speak_last_words()

    def await_landing(self, halted: Callable[[], bool]) -> None:
        """Wait until drones that return or land are disarmed, until they move no more, or until `halted`."""
        places: dict[str, Place | None] = {}
        moved_s = self.time_s
        while not halted() and self.time_s < moved_s + _STANDSTILL_S and (ending := self._ending_flights()):
            for drone in ending:
                place, before = drone.telemetry.place, places.get(drone.robot.id)
                if before is None or (place is not None and math.dist(place, before) > _MOVED_M):
                    places[drone.robot.id], moved_s = place, self.time_s
            self._go_on()

    def final_states(self) -> list[FinalState]:
        """Where each drone is now, and what it does; drones that were not listened to are, for a moment."""
        if not self._listened:
            self._listen_until(self.time_s + _HEARTBEAT_S, lambda drone: drone.autopilot is not None)
            self._listen_until(self.time_s + _HEARTBEAT_S, lambda drone: drone.located or not drone.telemetry.armed)
        with self._lock:
            return [final_state_of(session.drone, self.time_s) for session in self.sessions.values()]

    def close(self) -> None:
        self._closed.set()
        if self._speaker is not None and self._speaker.is_alive():
            self._speaker.join()
        for link in self._links:
            link.close()

    def _listen_until(self, time_s: float, enough: Callable[[Drone], bool]) -> None:
        """Receive and send until a time, or until enough is known of each drone."""
        self._listened = True
        while self.time_s < time_s and not all(enough(session.drone) for session in self.sessions.values()):
            self._go_on()

    def _new_faults(self) -> list[Fault]:
        """The first fault of each drone that was not reported yet, once its status texts are complete."""
        first = [session.fault for session in self.sessions.values() if session.fault is not None]
        ready = [fault for fault in first if fault.robot not in self._told and not fault.awaits_texts(self.time_s)]
        return sorted(ready, key=lambda fault: fault.at_s)

    def _event(self, fault: Fault) -> Event:
        self._told.add(fault.robot)
        return Failure(at_s=max(0.0, fault.at_s), robot_fails=fault.robot, reason=fault.reason)

    def _ending_flights(self) -> list[Drone]:
        """The drones that return or land, or are to, and were heard lately."""
        heard = [
            session
            for session in self.sessions.values()
            if session.drone.autopilot is not None
            and session.drone.telemetry.armed
            and self.time_s < session.drone.telemetry.heard_s + _STANDSTILL_S
        ]
        return [session.drone for session in heard if session.ends_its_flight]

    def _tell_all(self, what: Callable[[Session, float], object]) -> None:
        with self._lock:
            for session in self.sessions.values():
                self._do(session, what)

    def _do(self, session: Session, what: Callable[..., object], *more: object) -> None:
        """Do something with one drone; an error ends the session of this drone alone."""
        try:
            what(session, *more, self.time_s)
        except ParameterError:  # none that Muster flies
            raise
        except Exception as error:
            session.fail(Kind.NOT_UNDERSTOOD, f"{type(error).__name__}: {error}", self.time_s)

    def _speak_last_words(self) -> None:
        least, most = (self.time_s + seconds for seconds in _LAST_WORDS_S)
        while self.time_s < least or (
            self.time_s < most and any(session.busy or session.is_pending for session in self.sessions.values())
        ):
            self._go_on()

    def _speak_on(self) -> None:
        """The thread that sends and receives; `advance` raises its errors."""
        try:
            while not self._closed.is_set():
                self._step()
                self._wait(_STEP_S)
        except Exception as error:
            self._failure = error

    def _go_on(self) -> None:
        """Let a step pass: the thread's, or one of our own while there is none, or none any more."""
        if self._speaker is None or not self._speaker.is_alive():
            self._step()
        self._wait(_STEP_S)

    def _step(self) -> None:
        """Receive on all links, advance all sessions, send."""
        with self._lock:
            for link in self._links:
                for name, message in link.hear():
                    self._do(self.sessions[name], Session.hear, message)
            for name, session in self.sessions.items():
                self._do(session, Session.tick)
                for message in session.take():
                    self._link_of[name].say(name, message)

    def _require_one(self, name: str, within_s: float) -> None:
        link = self._link_of[name]
        if self.sessions[name].drone.autopilot is None:
            raise NetworkError(f"{name}: no heartbeat within {within_s:g} s; expected a drone at its endpoint")
        if link.others:
            found = " and ".join(map(str, [link.system_of(name), *sorted(link.others)]))
            raise ParameterError(f"{name}: systems {found} on {link.name}; expected one, or which: {link.name}#1")
        if self.sessions[name].drone.telemetry.doubles.are_there:
            found = f"two autopilots with the system id {link.system_of(name)} on {link.name}"
            raise ParameterError(
                f"{name}: {found}; expected an id for each (PX4: MAV_SYS_ID, ArduPilot: SYSID_THISMAV)"
            )

    def _require_near(self, drone: Drone) -> None:
        place, start = drone.telemetry.place, drone.telemetry.start
        assert place is not None
        metres = ((place[0] - start[0]) ** 2 + (place[1] - start[1]) ** 2) ** 0.5
        if metres > self._settings.far_m:
            raise ParameterError(
                f"{drone.robot.id}: stands {metres:.1f} m from its start in the mission; "
                f"expected at most {self._settings.far_m:g} m: check origin_wgs84 and its position"
            )


class Port:
    """One drone, behind the fleet's lock."""

    def __init__(self, session: Session, now: Callable[[], float], lock: threading.RLock) -> None:
        self._session, self._now, self._lock = session, now, lock

    @property
    def robot(self) -> str:
        return self._session.drone.robot.id

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        with self._lock:
            return self._session.follow(waypoints, self._now())

    def cancel(self) -> int:
        with self._lock:
            return self._session.hold(self._now())

    def telemetry(self) -> Telemetry | None:
        with self._lock:
            return self._session.telemetry()


def _telemetry_of(mission: Mission, robot: Robot, settings: FlightSettings) -> DroneTelemetry:
    start: Place = (robot.position[0], robot.position[1], robot.position[2] if len(robot.position) > 2 else 0.0)
    if mission.origin_wgs84 is not None:
        return DroneTelemetry(start, GlobalFrame(mission.origin_wgs84, start))
    forward = settings.local_frame == "forward"
    local = StartFrame(start, math.radians(robot.heading_deg)) if forward else LocalFrame(start)
    return DroneTelemetry(start, None, local=local)


def _check(mission: Mission, endpoints: Mapping[str, str], settings: FlightSettings, height_m: float | None) -> None:
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
    if mission.origin_wgs84 is not None and settings.local_frame == "forward":
        raise ParameterError(f"mission {mission.name}: origin_wgs84; expected none with the local frame forward")
    if (mission.dimensions == 2) != (height_m is not None):
        told = "no height" if height_m is None else f"height {height_m:g} m"
        expected = "a height for a mission in the plane" if height_m is None else "none: the mission has heights"
        raise ParameterError(f"{told}; expected {expected} (--height)")
