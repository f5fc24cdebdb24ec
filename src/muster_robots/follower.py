"""Progress along way points of a robot that reports only poses: the next way point, and how many are passed."""

from __future__ import annotations

from collections.abc import Sequence

from muster.motion.frames import wrapped
from muster.motion.port import Place, Waypoint
from muster_robots.odometer import Odometer, distance


class Follower:
    """Way points of one robot, in order, with headings and holds.

    Parameters
    ----------
    arrival_m, turned_rad
        from a place and from a heading, where a robot counts as there.
    flat
        whether height is of no account: in the plane, and on the ground.
    """

    def __init__(self, *, arrival_m: float, turned_rad: float, flat: bool) -> None:
        self._arrival_m = arrival_m
        self._turned_rad = turned_rad
        self._flat = flat
        self._waypoints: tuple[Waypoint, ...] = ()
        self._held_since: float | None = None
        self._odometer = Odometer(flat=flat)
        self.order = 0
        self.passed = 0

    @property
    def odometry_m(self) -> float:
        """Metres that it has gone."""
        return self._odometer.metres

    @property
    def passed_points(self) -> Sequence[Waypoint]:
        """The way points that it has passed."""
        return self._waypoints[: self.passed]

    @property
    def aim(self) -> Waypoint | None:
        """The way point that it is to pass next, or where it stays; None if it has none."""
        return self._waypoints[self.passed] if self.passed < len(self._waypoints) else None

    @property
    def target(self) -> Waypoint:
        """The way point that it is to pass next, or the last of all, where it stays. There must be one."""
        return self._waypoints[min(self.passed, len(self._waypoints) - 1)]

    @property
    def waits(self) -> bool:
        """Whether it has passed all way points of an order that had some."""
        return self.aim is None and self.passed > 0

    @property
    def stays(self) -> bool:
        """Whether it is at a way point, for its hold."""
        return self._held_since is not None

    def take(self, waypoints: Sequence[Waypoint]) -> int:
        """Follow these from now on; returns the number of this order, from 1."""
        self._waypoints, self.passed, self._held_since = tuple(waypoints), 0, None
        self.order += 1
        return self.order

    def hear(self, now: float, place: Place, heading: float) -> bool:
        """The robot is there now; returns whether it has passed a way point."""
        self._odometer.hear(place)
        before = self.passed
        while self.aim is not None and self._has_passed(self.aim, now, place, heading):
            self.passed += 1
            self._held_since = None
        return self.passed > before

    def wait(self, now: float) -> bool:
        """Let time go on without a new pose; returns whether a hold is over, and its way point passed with that."""
        if self.aim is None or self._held_since is None or now - self._held_since < self.aim.hold_s:
            return False
        self.passed += 1
        self._held_since = None
        return True

    def arrive(self, now: float) -> None:
        """Count it as arrived, by a source other than its poses."""
        if self.aim is not None and self._held_since is None:
            self._held_since = now

    def is_at(self, place: Place, aim: Waypoint) -> bool:
        """Whether a place counts as the way point's."""
        return distance(place, aim.position, flat=self._flat) <= self._arrival_m

    def _has_passed(self, aim: Waypoint, now: float, place: Place, heading: float) -> bool:
        if self._held_since is None:
            turned = aim.heading is None or abs(float(wrapped(aim.heading - heading))) <= self._turned_rad
            if not (self.is_at(place, aim) and turned):
                return False
            self._held_since = now
        return now - self._held_since >= aim.hold_s
