"""A robot's own navigation: goals that it accepts, rejects, reaches or aborts, as actions of ROS 1 and ROS 2 do.

`NavigationGoals` gives one goal at a time through a `Navigator`, a client of `move_base` or of Nav2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Literal, Protocol, TypeVar

G = TypeVar("G")

PURSUED_S = 2.0
"""Seconds after a goal of others on a topic for which a robot counts as theirs: by then it moves, as poses show."""
_TRIES = 2
"""Times that a goal is given which the robot's navigation gives up."""
_PATIENCE_S = 5.0
"""For how long a goal that was cancelled may take to end."""


@dataclass(frozen=True)
class Ended:
    """The end of a goal; `reason` why the robot does not get there, empty where it did; or others have ended it."""

    reason: str = ""
    by_others: bool = False


@dataclass(frozen=True)
class Outcome:
    """How a goal of navigation ended, and the detail that the robot gives; lost: its server knows nothing of it."""

    status: Literal["succeeded", "aborted", "canceled", "rejected", "lost"]
    detail: str = ""


class Navigation(Protocol[G]):
    """A goal that was given to a robot's own navigation."""

    @property
    def outcome(self) -> Outcome | None:
        """None while it is under way."""
        ...

    def take(self) -> list[G]:
        """Where the robot said that it was, since the last call."""
        ...

    def cancel(self) -> None:
        """Request that the goal is cancelled; `outcome` shows whether it was.

        Raises
        ------
        NetworkError
            if it cannot be asked.
        """
        ...


class Navigator(Protocol[G]):
    """A client of an action that takes poses."""

    @property
    def unfit(self) -> str:
        """Why a server that is there cannot be used, and what is expected; empty if it can, or there is none."""
        ...

    @property
    def ready(self) -> bool:
        """Whether somebody serves it."""
        ...

    @property
    def foreign(self) -> str:
        """The id of a goal under way that no Muster has given; empty if none is known."""
        ...

    def go(self, goal: G) -> Navigation[G]:
        """Let the robot go there; where that cannot even be asked, it is aborted."""
        ...


class NavigationGoals(Generic[G]):
    """Goals of an action.

    A goal is sent when the one before has ended, which is cancelled for that: two at once, of which one is being
    cancelled, may end together in Nav2. One that the navigation gives up is given once more; then the robot refuses it.
    One that is lost with its server is given to the next server, as often as that happens.

    Parameters
    ----------
    name : str
        The action's name in reasons, such as "move_base".
    """

    reports = True

    def __init__(self, navigator: Navigator[G], name: str) -> None:
        self._navigator, self._name = navigator, name
        self._wanted: G | None = None
        self._sent: G | None = None
        self._navigation: Navigation[G] | None = None
        self._tries = 0
        self._cancelled = False
        self._cancelled_s: float | None = None

    @property
    def ready(self) -> bool:
        """Whether there is somebody to whom goals can be given."""
        return self._navigator.ready

    @property
    def at_rest(self) -> bool:
        """Whether no goal is under way, as far as is known."""
        return self._navigation is None

    @property
    def foreign(self) -> str:
        """Whose goal the robot's navigation pursues, if that is not Muster's, in words; empty if none is known."""
        found = self._navigator.foreign
        return f"{self._name} has goal {found}, which is not Muster's" if found else ""

    def leave(self) -> None:
        """Give up the goal for that of somebody else, which stays as it is."""
        self._wanted = None
        self._cancel()

    def give(self, goal: G) -> None:
        """Let the robot go there, in place of where it goes now."""
        self._cancel()
        self._wanted, self._tries = goal, 0
        self._send()

    def withdraw(self, here: G | None) -> bool:
        """Cancel the goal, as often as this is called: the robot brakes by itself; returns that this was sent."""
        self._wanted, self._cancelled = None, False
        self._cancel()
        return True

    def hear(self, now: float, *, under_way: bool) -> Ended | None:
        """Send what is due; return the end of the last goal once, where the robot reports it.

        Parameters
        ----------
        under_way : bool
            Whether that goal still matters.
        """
        outcome, ended = self._outcome(now), None
        if outcome is not None:
            ended = None if self._cancelled else self._judged(outcome, under_way=under_way)
            self._navigation, self._cancelled, self._cancelled_s = None, False, None
        self._send()
        return ended

    def poses(self) -> list[G]:
        """Where the robot said that it was, on its way."""
        return [] if self._navigation is None else self._navigation.take()

    def _cancel(self) -> None:
        if self._navigation is not None and not self._cancelled:
            self._navigation.cancel()
            self._cancelled = True

    def _send(self) -> None:
        if self._wanted is not None and self._navigation is None and self._navigator.ready:
            self._navigation, self._sent, self._wanted = self._navigator.go(self._wanted), self._wanted, None
            self._tries += 1

    def _outcome(self, now: float) -> Outcome | None:
        """How the goal under way ended; also where its server is gone."""
        if self._navigation is None or self._navigation.outcome is not None:
            return None if self._navigation is None else self._navigation.outcome
        if not self._navigator.ready:
            return Outcome("lost", "its server has gone")
        if self._cancelled and self._cancelled_s is None:
            self._cancelled_s = now
        late = self._cancelled_s is not None and now - self._cancelled_s > _PATIENCE_S
        return Outcome("canceled", "no answer") if late else None

    def _judged(self, outcome: Outcome, *, under_way: bool) -> Ended | None:
        if outcome.status == "succeeded":
            return Ended()
        lost = outcome.status == "lost"
        if under_way and (lost or (outcome.status != "canceled" and self._tries < _TRIES)):
            self._wanted, self._tries = self._sent, self._tries - lost
            return None
        by_others = outcome.status == "canceled"
        by = " by somebody else" if by_others else ""
        detail = f" ({outcome.detail})" if outcome.detail else ""
        return Ended(f"{self._name}: {outcome.status}{by}{detail}", by_others)
