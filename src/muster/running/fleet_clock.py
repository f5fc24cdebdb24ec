"""A fleet whose clock is that of the mission: the wall clock since the mission's start."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from muster.execution.fleet import Fleet, has_simulated_time, is_paused
from muster.mission.model import Event, Mission
from muster.mission.system.clock import Clock, VirtualClock, WallClock
from muster.motion.port import BeforeOrder, RobotPort, Telemetry, TranslatedPort, Waypoint
from muster.running.wall_time import MissionStart

BeforeOrderAt = Callable[[float, str, Sequence[Waypoint]], None]
"""Receives an order before it is sent: the mission's time, whose it is, its way points, none where it is to stay."""
BEHIND_S = 10.0
"""Seconds by which a fleet's clock may fall behind the wall clock: the clock of a machine that slept stood still."""


def clock_of(fleet: Fleet, wall: Clock | None = None) -> Clock:
    """Return the wall clock of a mission: the one that is given, or the machine's; of simulated time 0."""
    return wall or (VirtualClock() if has_simulated_time(fleet) else WallClock())


def start_of(mission: Mission, fleet: Fleet, starts: str, wall: Clock | None = None) -> MissionStart:
    """Return the start of a mission that a fleet begins to carry out now.

    By the clock of a simulator alone there is no time of day: the mission starts now.
    """
    of_day = wall is not None or not has_simulated_time(fleet)
    return MissionStart.of(mission, starts if of_day else "now", clock_of(fleet, wall))


class FleetWithMissionClock:
    """A `Fleet` with the time of the mission; what robots said before the start is of times below 0.

    The mission's clock goes on in pauses, also where the fleet's stands still. Where the fleet's clock falls behind the
    wall clock it is set forward; where somebody sets the wall clock back, it goes on.

    Parameters
    ----------
    fleet : Fleet
        The robots.
    begin_s : float
        Time of the mission's clock now; before the start it is negative.
    wall : Clock, optional
        The wall clock. Without one the fleet's clock alone counts, as that of a simulator.
    before_order : callable, optional
        Receives each order before the robot does: when, whose, and its way points, none where the robot is to stay.
    """

    def __init__(
        self,
        fleet: Fleet,
        begin_s: float = 0.0,
        wall: Clock | None = None,
        before_order: BeforeOrderAt | None = None,
    ) -> None:
        self._fleet, self._off_s = fleet, fleet.time_s - begin_s
        self._wall, self._zero_s = wall, 0.0 if wall is None else wall.now() - begin_s
        self._was_paused = False
        self._orders = None if before_order is None else partial(self._tell_order, before_order)
        self.ports: Mapping[str, RobotPort] = _Ports(fleet, lambda: self._off_s, self._orders)

    @property
    def time_s(self) -> float:
        """Seconds since the mission's start; 0 before it."""
        return max(0.0, self._since_start_s())

    @property
    def waits_s(self) -> float:
        """Seconds until the mission's start; 0 after it."""
        return max(0.0, -self._since_start_s())

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`."""
        return self._fleet.advance(self._fleet.time_s + until_s - self.time_s)

    def stop(self) -> None:
        """See `Fleet`; that each robot is to stay is an order, too."""
        if self._orders is not None:
            for robot in self._fleet.ports:
                self._orders(robot, ())
        self._fleet.stop()

    def close(self) -> None:
        self._fleet.close()

    def _tell_order(self, tell: BeforeOrderAt, robot: str, waypoints: Sequence[Waypoint]) -> None:
        tell(self.time_s, robot, waypoints)

    def _since_start_s(self) -> float:
        now = self._fleet.time_s - self._off_s
        behind_s = 0.0 if self._wall is None else self._wall.now() - self._zero_s - now
        paused = is_paused(self._fleet)
        may_be_behind_s = 0.0 if paused or self._was_paused else BEHIND_S
        self._was_paused = paused
        if behind_s <= may_be_behind_s:
            return now
        self._off_s -= behind_s
        return now + behind_s


class _Ports(Mapping[str, RobotPort]):
    """Those that are discovered later are in it as soon as they are."""

    def __init__(self, fleet: Fleet, off_s: Callable[[], float], before_order: BeforeOrder | None) -> None:
        self._fleet, self._off_s, self._before_order = fleet, off_s, before_order

    def __getitem__(self, robot: str) -> RobotPort:
        return TranslatedPort(self._fleet.ports[robot], self._since_it_began, self._before_order)

    def __iter__(self) -> Iterator[str]:
        return iter(self._fleet.ports)

    def __len__(self) -> int:
        return len(self._fleet.ports)

    def _since_it_began(self, said: Telemetry) -> Telemetry:
        return replace(said, time_s=said.time_s - self._off_s())
