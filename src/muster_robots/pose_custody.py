"""Custody of a robot that reports poses and finds its way to goals itself: one layer for ROS 1, ROS 2 and plug-ins.

Poses show what such a robot does: it moves, or it stands. A robot that stands short of its goal has lost it, as after a
restart; one that moves though it is to hold was not reached. Both are told again. What the robot tells of itself counts
as its standing has it: of one that is silent, and has not shown since that it obeys, the time stands still.
"""

from __future__ import annotations

import logging
import math
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import replace

from muster.execution.fleet import Failure
from muster.mission.model import Event
from muster.motion.port import Place, Telemetry
from muster_robots.custody import Custody, CustodyLimits, Holder, Seen, Standing, Wants

_MOVED_M, _TURNED_RAD = 0.2, 0.35
"""A robot whose poses differ by less within a while stands: localisation trembles."""
_WHILE = 0.75
"""That while as a share of `again_s`: a robot that has obeyed is not told again for how it moved before."""
_KEPT = 8
"""Poses that are kept of that while, however often they come."""
_TAKEN = (Standing.PILOT, Standing.STATION, Standing.FAILSAFE)
_log = logging.getLogger(__name__)


class PoseCustody:
    """The custody of one robot.

    Parameters
    ----------
    robot : str
        Its id.
    limits : CustodyLimits
        How long what may last.
    expected : str
        Who is to receive its orders, such as "a subscriber of /r_0/cmd_vel (geometry_msgs/Twist)".
    is_received : callable
        Returns whether somebody does. Where nobody does the robot cannot be driven, whatever it says of its place: it
        counts as not heard.
    lets_go : bool
        Whether a robot that has held is anybody's: it is not told again when it moves, as a person may drive it.
    """

    def __init__(
        self,
        robot: str,
        limits: CustodyLimits,
        expected: str = "",
        is_received: Callable[[], bool] = lambda: True,
        *,
        lets_go: bool = False,
    ) -> None:
        self._lets_go = lets_go
        self.robot, self._expected, self._is_received = robot, expected, is_received
        self._custody = Custody(limits, repeats_orders=True)
        self._while_s = _WHILE * limits.again_s
        self._here: tuple[Place, float] = ((0.0, 0.0, 0.0), 0.0)
        self._track: deque[tuple[float, Place, float]] = deque()  # when and where it was lately
        self._heard_s = self._told_s = -math.inf  # of the last pose, by the clocks of custody and of telemetry
        self._unreceived: tuple[float, float] | None = None  # the same of the last one whose orders were received
        self._silent_since_s = -math.inf  # by the clock of telemetry
        self._taken_s, self._taken_by, self._why = -math.inf, Holder.MUSTER, ""  # the last command beside Muster's
        self._has_failed = False

    @property
    def missing(self) -> str:
        """What is missing, and what is expected; empty if somebody receives its orders."""
        return "" if self._is_received() else f"nobody receives its orders; expected {self._expected}"

    @property
    def is_taken(self) -> bool:
        """Whether somebody else has it now: it is told nothing."""
        return self._taken_by is not Holder.MUSTER

    @property
    def moves_by_others(self) -> bool:
        """Whether it moves on though it was told twice to hold: if it knows no goal of Muster's, somebody moves it."""
        return self._custody.wanted is Wants.HOLD and self._custody.repeated > 1 and self._does is Wants.ORDER

    def want(self, now: float, *, goes: bool) -> bool:
        """Note an order, to go or to hold; returns whether the robot may be told."""
        self._custody.want(Wants.ORDER if goes else Wants.HOLD, now)
        return not self.is_taken

    def told(self, now: float) -> None:
        """Note that the robot was told only now what it is to do: before, it was not reached."""
        self._custody.said(now)

    def hear(self, now: float, place: Place, heading: float, told_s: float | None = None) -> None:
        """Take in a pose.

        Parameters
        ----------
        now, told_s : float
            When it was reported, by the clock of custody, and by that of telemetry; by default that is the same clock.
        """
        self._heard_s, self._told_s = now, now if told_s is None else told_s
        self._here = place, heading
        if not self._track or now >= self._track[-1][0] + self._while_s / _KEPT:
            self._track.append((now, place, heading))
        while len(self._track) > 1 and self._track[1][0] <= now - self._while_s:
            self._track.popleft()

    def take(self, now: float, who: Holder, why: str) -> None:
        """Note that somebody else commands the robot now: it keeps no order, and takes part again when it has stood.

        What it is sent after that it is told when it is given back, however often this is noted meanwhile.
        """
        if not self.is_taken:
            _log.warning("robot %s: %s: %s; it takes no part", self.robot, who.value, why)
            if self._custody.wanted is Wants.ORDER:
                self._custody.want(Wants.HOLD, now)
        self._taken_s, self._taken_by, self._why = now, who, why
        self._custody.let_go(Seen(now, now, None, who))

    def look(self, now: float, *, is_carried_out: bool) -> Wants | None:
        """Compare what is wanted with what is seen; return what the robot is to be told again.

        Parameters
        ----------
        is_carried_out : bool
            Whether its order is carried out though it may stand: it is where it was sent, or its navigation is at it.
        """
        if self._heard_s == -math.inf:
            return None
        custody, was_silent = self._custody, self._custody.standing is Standing.SILENT
        heard_s, told_s = self._heard
        does = self._does
        if self._taken_by is not Holder.MUSTER and does is Wants.IDLE and now >= self._taken_s + self._while_s:
            self._taken_by = Holder.MUSTER
        if self._taken_by is not Holder.MUSTER:
            does = None
        elif is_carried_out and custody.wanted is Wants.ORDER:
            does = Wants.ORDER
        command = custody.look(Seen(heard_s, heard_s, does, self._taken_by), now)
        if self._lets_go and does is Wants.IDLE and custody.wanted is Wants.HOLD and custody.standing is Standing.OURS:
            custody.want(Wants.IDLE)
        if custody.standing is Standing.SILENT and not was_silent:
            self._silent_since_s = told_s
            self._track.clear()
        return command

    def judged(self, said: Telemetry | None) -> Telemetry | None:
        """Return telemetry as it counts by the standing of the robot."""
        if said is None:
            return None
        if self._custody.standing in _TAKEN:
            return replace(said, suspended=f"{self._custody.standing.value}: {self._why}")
        is_absent = self._custody.standing in (Standing.SILENT, Standing.SUSPECT)
        until_s = self._silent_since_s if is_absent else self._heard[1]
        return replace(said, time_s=until_s) if until_s < said.time_s else said

    def failure(self, now: float) -> str:
        """Why the robot is put out for good, once; empty: it is not."""
        if self._has_failed or not self._custody.is_worn_out(now):
            return ""
        self._has_failed = True
        return self._custody.worn_out_words

    @property
    def _does(self) -> Wants | None:
        """IDLE: it stands; ORDER: it moves, wherever to; None: that is not known yet."""
        if not self._track:
            return None
        place, heading = self._here
        for _, before, faced in self._track:
            if math.dist(place, before) > _MOVED_M or abs(math.remainder(heading - faced, math.tau)) > _TURNED_RAD:
                return Wants.ORDER
        return Wants.IDLE if self._heard_s - self._track[0][0] >= self._while_s else None

    @property
    def _heard(self) -> tuple[float, float]:
        """When the robot was heard last, as it counts, by the clocks of custody and of telemetry."""
        if self._is_received():
            self._unreceived = None
        elif self._unreceived is None:
            self._unreceived = self._heard_s, self._told_s
            _log.warning("robot %s: %s; it counts as silent", self.robot, self.missing)
        return self._unreceived or (self._heard_s, self._told_s)


def failures(robots: Iterable[PoseCustody], now: float, at_s: float) -> list[Event]:
    """Return for each robot that is put out now the event that says so.

    Parameters
    ----------
    now, at_s : float
        The time by the clock of custody, and by that of the mission.
    """
    return [Failure(at_s=at_s, robot_fails=one.robot, reason=why) for one in robots if (why := one.failure(now))]
