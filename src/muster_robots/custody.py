"""Custody of one robot: the state that is wanted and the state that is seen, compared until it is down. Sans-I/O.

A bridge reports what it sees at every heartbeat and at every tick, and gives the command that it gets back. Troubles
are states that are kept, and not edges that are reacted to once: a robot that is silent, that its own failsafe, a pilot
or another station has, stays in custody, and takes part again when that is over.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from enum import Enum


class Wants(Enum):
    """What a robot is to do, or does."""

    IDLE = "idle"
    ORDER = "carry out its order"
    HOLD = "hold"
    RETURN = "return"
    LAND = "land"


class Holder(Enum):
    """Who decides what a robot does."""

    MUSTER = "muster"
    FAILSAFE = "failsafe"
    PILOT = "pilot"
    STATION = "another station"


class Standing(Enum):
    """The relation of a robot to Muster."""

    OURS = "ours"
    SILENT = "silent"
    SUSPECT = "suspect"
    FAILSAFE = "failsafe"
    PILOT = "pilot"
    STATION = "another station"


_STANDING_UNDER = {
    Holder.FAILSAFE: Standing.FAILSAFE,
    Holder.PILOT: Standing.PILOT,
    Holder.STATION: Standing.STATION,
}


@dataclass(frozen=True)
class Seen:
    """What a bridge sees of a robot.

    Parameters
    ----------
    heard_s : float
        When any message of the robot arrived last, in seconds of the bridge's clock.
    state_s : float
        When the robot reported its state last: its mode, and whether it is armed.
    does : Wants or None
        What the robot does by that report; IDLE: it stands, disarmed; None: nothing that Muster commands.
    holder : Holder
        Who decides about it by that report.
    unfit : str
        Why the robot can do no tasks for now, such as an unknown position; empty if it can.
    sticks : bool
        Whether a pilot has an input device that works.
    """

    heard_s: float
    state_s: float
    does: Wants | None
    holder: Holder
    unfit: str = ""
    sticks: bool = False


@dataclass(frozen=True, kw_only=True)
class CustodyLimits:
    """How long what may last, in seconds.

    Parameters
    ----------
    silent_after_s : float
        Time without any message after which a robot is silent.
    settled_s : float
        Time for which a robot must do what is wanted before it takes part again.
    released_s : float
        The same after a pilot: a mode switch passes the hold mode on its way to others.
    troubles : int
        Number of silences and unanswered commands within `troubles_within_s` after which a robot is put out.
    troubles_within_s : float
        See `troubles`.
    again_s : float
        Time after which a command that has no effect is given again; an order each time after twice as long.
    """

    silent_after_s: float = 10.0
    settled_s: float = 3.0
    released_s: float = 5.0
    troubles: int = 5
    troubles_within_s: float = 120.0
    again_s: float = 2.0


_SEEN_TWICE = 2
"""Reports in a row that count: one may be older than the last command."""
_MOST_DOUBLED = 4
"""Times that the time after which an order is given again doubles: a robot that is blocked plans anew each time."""


@dataclass
class Custody:
    """Working state of the custody of one robot.

    Attributes
    ----------
    limits : CustodyLimits
        How long what may last.
    repeats_orders : bool
        Whether an order is given again that the robot does not carry out, as other commands are.
    wanted : Wants
        What the robot is to do.
    standing : Standing
        The relation of the robot to Muster now.
    was_piloted : bool
        Whether a pilot with sticks has had the robot: it gets no tasks any more, and the command at the end.
    repeated : int
        Times that what is wanted was said again, without effect.
    """

    limits: CustodyLimits
    repeats_orders: bool = False
    wanted: Wants = Wants.IDLE
    standing: Standing = Standing.OURS
    was_piloted: bool = False
    repeated: int = 0
    _troubles_s: deque[float] = field(default_factory=deque)
    _state_s: float = -math.inf  # of the last report that was counted
    _astray: int = 0  # reports in a row that show another holder
    _misfits: int = 0  # reports in a row that do not show what is wanted
    _heard_again_s: float = -math.inf  # when a silence ended
    _fits_since_s: float | None = None
    _said_s: float = -math.inf
    _is_paused: bool = False  # whether another station lets the robot hold

    def want(self, what: Wants, said_s: float | None = None) -> None:
        """Set what the robot is to do; the bridge gives the command itself the first time, at `said_s`."""
        self.wanted = what
        self._misfits, self._fits_since_s, self.repeated = 0, None, 0
        self._said_s = self._said_s if said_s is None else said_s

    def said(self, now: float) -> None:
        """Note that what is wanted was said only now: before, it could not be."""
        self._said_s, self._misfits = now, 0

    def suspect(self, now: float) -> None:
        """Let the robot take no part until it has done for a while what is wanted: it did not obey."""
        if self.standing is not Standing.SUSPECT:
            self._troubles_s.append(now)
            self.standing, self._fits_since_s = Standing.SUSPECT, None

    def is_worn_out(self, now: float) -> bool:
        """Return whether the robot was in trouble too often lately."""
        while self._troubles_s and self._troubles_s[0] < now - self.limits.troubles_within_s:
            self._troubles_s.popleft()
        return len(self._troubles_s) > self.limits.troubles

    @property
    def worn_out_words(self) -> str:
        """Why a robot is put out that was in trouble too often."""
        limits = self.limits
        return f"silent, or without an answer, more than {limits.troubles} times in {limits.troubles_within_s:g} s"

    @property
    def is_heard(self) -> bool:
        """Whether the robot has reported its state since the last silence."""
        return self.standing is not Standing.SILENT and self._state_s >= self._heard_again_s

    def does_what_is_wanted(self, seen: Seen) -> bool:
        """Return whether a robot does what it is to do; one that stands, disarmed, holds and has landed."""
        return seen.does is self.wanted or (seen.does is Wants.IDLE and self.wanted is not Wants.ORDER)

    def look(self, seen: Seen, now: float) -> Wants | None:
        """Update the standing; return the command that the robot is to get now, None: it gets none."""
        if self._is_silent(seen, now):
            return None
        is_new = seen.state_s > self._state_s
        self._state_s = seen.state_s
        if not self.is_heard:
            return None
        fits = self.does_what_is_wanted(seen)
        elsewhere = self._is_elsewhere(seen, fits=fits)
        if is_new:
            self._astray = self._astray + 1 if elsewhere else 0
            self._misfits = 0 if fits or elsewhere else self._misfits + 1
        if elsewhere and self._astray >= _SEEN_TWICE:
            self.let_go(seen)
        elif seen.unfit and self.standing is Standing.OURS:
            self.standing = Standing.SUSPECT
        self._settle(seen, now, fits=fits and not elsewhere and not seen.unfit)
        self.repeated = 0 if fits else self.repeated
        is_order = self.wanted is Wants.ORDER
        again_s = self.limits.again_s * 2 ** (min(self.repeated, _MOST_DOUBLED) if is_order else 0)
        if elsewhere or self._misfits < _SEEN_TWICE or now < self._said_s + again_s:
            return None
        if self.wanted is Wants.IDLE or (is_order and not self.repeats_orders):
            return None
        self._said_s, self.repeated = now, self.repeated + 1
        return self.wanted

    def _is_silent(self, seen: Seen, now: float) -> bool:
        if now - seen.heard_s > self.limits.silent_after_s:
            if self.standing is not Standing.SILENT:
                self._troubles_s.append(now)
            self.standing = Standing.SILENT
            return True
        if self.standing is Standing.SILENT:
            self.standing, self._heard_again_s = Standing.SUSPECT, seen.heard_s
            self._misfits, self._astray, self._fits_since_s = _SEEN_TWICE - 1, 0, None
            self._said_s = -math.inf  # what was said meanwhile was not heard
        return False

    def _is_elsewhere(self, seen: Seen, *, fits: bool) -> bool:
        """Whether somebody else decides; a failsafe that does what is wanted disturbs nobody."""
        self._is_paused = self._is_paused and seen.does is Wants.HOLD
        if seen.holder is Holder.FAILSAFE:
            return not fits
        return seen.holder is not Holder.MUSTER

    def let_go(self, seen: Seen) -> None:
        """Leave the robot to whoever has it."""
        self.standing, self._fits_since_s = _STANDING_UNDER[seen.holder], None
        self.was_piloted = self.was_piloted or (self.standing is Standing.PILOT and seen.sticks)
        self._is_paused = self.standing is Standing.STATION and seen.does is Wants.HOLD

    def _settle(self, seen: Seen, now: float, *, fits: bool) -> None:
        """Let a robot take part again that has done for a while what is wanted."""
        if self.standing is Standing.OURS:
            return
        if not fits or self._is_paused or self.was_piloted:
            self._fits_since_s = None
            return
        self._fits_since_s = now if self._fits_since_s is None else self._fits_since_s
        piloted = self.standing is Standing.PILOT
        if now >= self._fits_since_s + (self.limits.released_s if piloted else self.limits.settled_s):
            self.standing = Standing.OURS
