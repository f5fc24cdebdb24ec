"""The test stand: opens a fleet, lets time go by, and measures what its robots report."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from muster.execution.fleet import Fleet, reason_of
from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.motion.kinematics.registry import limits_of
from muster.motion.port import Place, Telemetry, Waypoint
from muster.running.fleet_type import FleetType
from muster_robots.goal_fleet import LEASE_S

NEAR_M = 0.5
"""Distance to a place at which a robot counts as there, in metres."""
FRESH_S = 2.0
"""Age in seconds up to which a robot that answers may have reported last."""
STILL_M = 0.1
"""Distance that a robot which stands may be reported to move, in metres."""
LATENCY_S = 1.0
"""Seconds until a robot does what it is told, and until that is reported."""
_STEP_S = 0.1
_LEASE_MARGIN_S = 5.0
"""Seconds of driving beside two leases: the robot is watched for longer than one, and may brake late."""


class LackingError(Exception):
    """A clause does not hold; the message says what the fleet lacks."""


@dataclass(kw_only=True)
class Stand:
    """What clauses are tested with.

    Parameters
    ----------
    kind : FleetType
        The fleet that is tested.
    settings : Settings
        Its settings, as its class.
    mission : Mission
        Whose robots are moved; they stand at their positions.
    reach_m : float, default 2
        How far each robot is sent, east of its position, in metres; robots that fly are sent as far up, too.
    lease_reach_m : float, default 0
        How far east of its position the first robot may drive, in metres, for the clause of leases.
    silence, wake : callable, optional
        Let a robot, by its id, fall silent, and answer again.
    watch : callable
        Wall-clock seconds, by which calls that take too long are noticed.
    idle : callable
        Lets wall-clock seconds go by, in which the fleet is not open.
    ends_s : float, default 3
        Seconds that threads of a closed fleet may take to end.
    """

    kind: FleetType
    settings: Any
    mission: Mission
    reach_m: float = 2.0
    lease_reach_m: float = 0.0
    silence: Callable[[str], object] | None = None
    wake: Callable[[str], object] | None = None
    watch: Callable[[], float] = time.monotonic
    idle: Callable[[float], object] = time.sleep
    ends_s: float = 3.0
    _there: Mission = field(init=False)

    def __post_init__(self) -> None:
        self._there = self.mission

    def open(self, mission: Mission, *, again: bool = False, settings: Any = None) -> Fleet:
        """Open the fleet as a run does; whoever calls closes it."""
        given = self.settings if settings is None else settings
        fleet, _ = self.kind.open(mission, given, threading.Event(), again)
        return fleet

    @contextmanager
    def opened(self, mission: Mission | None = None, *, again: bool = False) -> Iterator[Trial]:
        """Open the fleet for a clause, with robots where they were left; afterwards stop the robots, and close it."""
        trial = Trial(self, self.open(self._there if mission is None else mission, again=again))
        try:
            yield trial
        finally:
            with suppress(Exception):  # the clause says what went wrong
                trial.fleet.stop()
                self._there = trial.where_robots_stand(self._there)
            trial.fleet.close()

    @contextmanager
    def abandoned(self) -> Iterator[Trial]:
        """Open the fleet for a clause, and close it without a word to robots, as if Muster were killed."""
        trial = Trial(self, self.open(self._there))
        try:
            yield trial
        except BaseException:
            with suppress(Exception):  # the clause says what went wrong
                trial.fleet.stop()
            raise
        finally:
            with suppress(Exception):
                self._there = trial.where_robots_stand(self._there)
            trial.fleet.close()

    @property
    def lease_room_m(self) -> float:
        """How far the first robot may get in the clause of leases, in metres: two leases of driving, and more."""
        return self.reach_m + self.mission.robots[0].speed_mps * (2 * LEASE_S + _LEASE_MARGIN_S)

    def is_declared(self, ability: str) -> bool:
        """Whether the fleet declares an ability."""
        return ability in self.kind.abilities


@dataclass(frozen=True)
class Resources:
    """Threads and open files of this process; no files where the system does not list them."""

    threads: frozenset[threading.Thread]
    files: frozenset[str]

    @classmethod
    def now(cls) -> Resources:
        """Return what there is now."""
        folder, files = Path("/proc/self/fd"), set[str]()
        for link in folder.iterdir() if folder.is_dir() else ():
            with suppress(OSError):  # the one by which the folder is read is closed
                files.add(f"{link.name} {link.readlink()}")
        return cls(frozenset(threading.enumerate()), frozenset(files))

    def left_behind(self, within_s: float) -> str:
        """Return what there is beside these, in words, when threads have had time to end; empty: nothing."""
        until_s = time.monotonic() + within_s
        while (more := self._more()) and time.monotonic() < until_s:
            time.sleep(0.02)
        return more

    def _more(self) -> str:
        now = Resources.now()
        threads = [f"thread {thread.name}" for thread in now.threads - self.threads]
        kept = [f"file {name.partition(' ')[2]}" for name in sorted(now.files - self.files) if "/proc/" not in name]
        return ", ".join((*threads, *kept))


class Trial:
    """One opening of the fleet.

    Parameters
    ----------
    stand : Stand
        Where it is tested.
    fleet : Fleet
        The open fleet.

    Attributes
    ----------
    late_s : float
        By how many seconds `advance` returned too late at most.
    """

    def __init__(self, stand: Stand, fleet: Fleet) -> None:
        self.stand, self.fleet, self.late_s = stand, fleet, 0.0
        self.robots = [robot.id for robot in stand.mission.robots]
        self._bodies = {robot.id: robot for robot in stand.mission.robots}
        self._newest: dict[str, float] = {}

    def said(self, robot: str, within_s: float = 10.0) -> Telemetry:
        """Return what a robot last reported; wait for its first report."""
        port = self.fleet.ports.get(robot)
        if port is None:
            raise LackingError(f"no port for robot {robot}")
        if not self.wait(within_s, lambda: port.telemetry() is not None):
            raise LackingError(f"{robot}: no telemetry within {within_s:g} s")
        said = port.telemetry()
        assert said is not None
        return said

    def wait(self, limit_s: float, until: Callable[[], bool]) -> bool:
        """Let time go by until something holds; returns whether it does before a limit in seconds of the fleet."""
        end_s, wall_s = self.fleet.time_s + limit_s, self.stand.watch() + 2 * limit_s + 10
        while not until():
            if self.fleet.time_s + TIME_ROUNDING_S >= end_s or self.stand.watch() >= wall_s:
                return False
            self.advance(min(end_s, self.fleet.time_s + _STEP_S))
        return True

    def advance(self, until_s: float) -> None:
        """Let the fleet receive and send; what a robot reports of failing is a fault here."""
        from_s, due_s = self.stand.watch(), max(0.0, until_s - self.fleet.time_s)
        events = self.fleet.advance(until_s)
        self.late_s = max(self.late_s, self.stand.watch() - from_s - due_s)
        for event in events:
            if event.robot_fails is not None:
                why = reason_of(event) or "no reason"
                raise LackingError(f"{event.robot_fails}: reported as failed ({why}), so it is out for good")
        self._check_times()

    def send(self, robot: str, *places: Place, hold_s: float = 0.0) -> int:
        """Order a robot to pass places; returns the number of the order when the robot has taken it."""
        ordered = [Waypoint(place, hold_s=hold_s if k == 0 else 0.0) for k, place in enumerate(places)]
        before = self.said(robot)
        order = self.fleet.ports[robot].send(ordered)
        if not isinstance(order, int) or order <= before.order:
            raise LackingError(f"{robot}: order {order!r} after order {before.order}; expected a greater number")
        return order

    def takes(self, robot: str, order: int) -> None:
        """Wait until a robot reports that it has taken an order."""
        if not self.wait(5.0, lambda: self.said(robot).order == order):
            raise LackingError(
                f"{robot}: order {order} not reported as taken within 5 s; telemetry has {self.said(robot).order}"
            )

    def passes(self, robot: str, order: int, count: int, place: Place) -> None:
        """Wait until a robot has passed so many way points of an order, the last of them at a place."""
        self.takes(robot, order)
        limit_s = 10.0 + 3.0 * math.dist(self.said(robot).position, place) / self._bodies[robot].speed_mps
        if not self.wait(limit_s, lambda: self.said(robot).order == order and self.said(robot).passed >= count):
            said = self.said(robot)
            raise LackingError(
                f"{robot}: {said.passed} of {count} way points passed within {limit_s:.0f} s, "
                f"{self.away(robot, place):.2f} m away"
            )
        if self.away(robot, place) > NEAR_M:
            raise LackingError(f"{robot}: arrival reported {self.away(robot, place):.2f} m from the way point")

    def starts_moving(self, robot: str) -> None:
        """Wait until a robot moves."""
        begin = self.said(robot).position
        if not self.wait(10.0, lambda: math.dist(self.said(robot).position, begin) > 2 * STILL_M):
            raise LackingError(f"{robot}: does not move within 10 s")

    def away(self, robot: str, place: Place) -> float:
        """Return how far a robot is from a place, in metres."""
        return math.dist(self.said(robot).position, place)

    def stops(self, robot: str, what: str) -> str:
        """Check that a robot stops that was told to just now; returns how far it went on, in words."""
        said, limits = self.said(robot), limits_of(self._bodies[robot])
        speed_mps = max(math.hypot(*said.velocity), 0.1)
        most_m = speed_mps * LATENCY_S + limits.braking_m(min(speed_mps, limits.speed_mps)) + 0.3
        still_s, at = 0.0, said.position
        end_s = self.fleet.time_s + 10.0
        while still_s < 1.5:
            before_s = self.fleet.time_s
            self.wait(0.5, lambda: False)
            here = self.said(robot).position
            still_s = still_s + self.fleet.time_s - before_s if math.dist(here, at) < STILL_M / 2 else 0.0
            at = here
            gone_m = math.dist(here, said.position)
            if gone_m > most_m or self.fleet.time_s > end_s:
                raise LackingError(f"{robot}: {gone_m:.2f} m farther after {what}; expected at most {most_m:.2f} m")
        return f"{robot} stopped after {math.dist(at, said.position):.2f} m"

    def lease_target(self, robot: str) -> Place:
        """Return the far end of the room in which leases are tested."""
        x, y, z = self.start(robot)
        return (x + self.stand.lease_room_m, y, z)

    def target(self, robot: str) -> Place:
        """Return where a robot is sent next: east of its start, or back, whichever is farther."""
        x, y, z = self.start(robot)
        home, there = (x, y, z), (x + self.stand.reach_m, y, z)
        here = self.said(robot).position
        return there if math.dist(here, home) < math.dist(here, there) else home

    def other(self, robot: str, place: Place) -> Place:
        """Return the other of the two places to which a robot is sent."""
        x, y, z = self.start(robot)
        return (x, y, z) if place != (x, y, z) else (x + self.stand.reach_m, y, z)

    def where_robots_stand(self, mission: Mission) -> Mission:
        """Return a mission whose robots are where they report to be."""
        robots = []
        for robot in mission.robots:
            said = self.fleet.ports[robot.id].telemetry()
            place = robot.position if said is None else said.position[: mission.dimensions]
            robots.append(replace(robot, position=place))
        return replace(mission, robots=tuple(robots))

    def start(self, robot: str) -> Place:
        """Return where a robot stands in the mission; if it flies, so far up as it is sent."""
        body = self._bodies[robot]
        position = body.position
        up_m = self.stand.reach_m if body.kind == "air" and len(position) > 2 else 0.0
        return (position[0], position[1], (position[2] if len(position) > 2 else 0.0) + up_m)

    def _check_times(self) -> None:
        """Check that reports are not of the future, and go back never."""
        now = self.fleet.time_s
        for name in self.robots:
            said = self.fleet.ports[name].telemetry() if name in self.fleet.ports else None
            if said is None:
                continue
            if said.time_s > now + 0.05:
                raise LackingError(
                    f"{name}: telemetry of {said.time_s:.2f} s, while the fleet's clock says {now:.2f} s"
                )
            if said.time_s < self._newest.get(name, -math.inf):
                raise LackingError(
                    f"{name}: telemetry went back from {self._newest[name]:.2f} s to {said.time_s:.2f} s"
                )
            self._newest[name] = said.time_s


def told(error: BaseException) -> str:
    """Return an error in one line, with its type where it is none of Muster's."""
    line = " ".join(str(error).split())
    return line if isinstance(error, MusterError | LackingError) else f"{type(error).__name__}: {line}"
