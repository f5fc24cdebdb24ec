"""Goals of a robot, one at a time: by a pose on a topic, or by Nav2's action."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import Navigation, Navigator, Outcome, Writer

_TRIES = 2
"""Times that a goal is given which the robot's navigation gives up."""
_PATIENCE_S = 5.0
"""For how long a goal that was cancelled may take to end."""


@dataclass(frozen=True)
class Ended:
    """The end of a goal; `reason` why the robot does not get there, empty where it did."""

    reason: str = ""


class Goals(Protocol):
    """One robot's."""

    @property
    def ready(self) -> bool:
        """Whether there is somebody to whom goals can be given."""
        ...

    @property
    def at_rest(self) -> bool:
        """Whether nothing that was given is under way, as far as that is said."""
        ...

    def give(self, goal: PoseStamped) -> None:
        """Let it go there, in place of where it goes now."""
        ...

    def withdraw(self, here: PoseStamped | None) -> bool:
        """Withdraw the goal: the robot stays at its position (None: unknown); returns whether that was sent."""
        ...

    def hear(self, now: float, *, under_way: bool) -> Ended | None:
        """Send what is due; return the end of the last goal once, where the robot reports it.

        Parameters
        ----------
        under_way
            whether that goal still matters.
        """
        ...

    def poses(self) -> list[PoseStamped]:
        """Where the robot said that it was, on its way."""
        ...


class PoseGoals:
    """Goals on a topic. They have no result: poses show when they are reached."""

    ready = at_rest = True

    def __init__(self, writer: Writer[PoseStamped]) -> None:
        self._writer = writer
        self._goal: PoseStamped | None = None
        self._listeners = 0

    def give(self, goal: PoseStamped) -> None:
        self._goal = goal
        self._writer.write(goal)

    def withdraw(self, here: PoseStamped | None) -> bool:
        """Its goal becomes where it is. One whose pose is not known keeps the goal that it has."""
        self._goal = None
        if here is not None:
            self._writer.write(here)
        return here is not None

    def hear(self, now: float, *, under_way: bool) -> Ended | None:
        """A new subscriber gets the goal, too."""
        listeners = self._writer.listeners
        if listeners > self._listeners and under_way and self._goal is not None:
            self._writer.write(self._goal)
        self._listeners = listeners
        return None

    def poses(self) -> list[PoseStamped]:
        return []


class Nav2Goals:
    """Goals of `nav2_msgs/NavigateToPose`.

    A goal is sent when the one before has ended, which is cancelled for that: two at once, of which one is being
    cancelled, may end together in Nav2. One that Nav2 gives up is given once more; then the robot refuses it.
    """

    def __init__(self, navigator: Navigator) -> None:
        self._navigator = navigator
        self._wanted: PoseStamped | None = None
        self._sent: PoseStamped | None = None
        self._navigation: Navigation | None = None
        self._tries = 0
        self._cancelled = False
        self._cancelled_s: float | None = None

    @property
    def ready(self) -> bool:
        return self._navigator.ready

    @property
    def at_rest(self) -> bool:
        return self._navigation is None

    def give(self, goal: PoseStamped) -> None:
        self._cancel()
        self._wanted, self._tries = goal, 0
        self._send()

    def withdraw(self, here: PoseStamped | None) -> bool:
        """It brakes by itself where its goal is cancelled."""
        self._wanted = None
        self._cancel()
        return True

    def hear(self, now: float, *, under_way: bool) -> Ended | None:
        outcome, ended = self._outcome(now), None
        if outcome is not None:
            ended = None if self._cancelled else self._judged(outcome, under_way=under_way)
            self._navigation, self._cancelled, self._cancelled_s = None, False, None
        self._send()
        return ended

    def poses(self) -> list[PoseStamped]:
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
            return Outcome("aborted", "its server has gone")
        if self._cancelled and self._cancelled_s is None:
            self._cancelled_s = now
        late = self._cancelled_s is not None and now - self._cancelled_s > _PATIENCE_S
        return Outcome("canceled", "no answer") if late else None

    def _judged(self, outcome: Outcome, *, under_way: bool) -> Ended | None:
        if outcome.status == "succeeded":
            return Ended()
        if outcome.status != "canceled" and under_way and self._tries < _TRIES:
            self._wanted = self._sent
            return None
        by = " by somebody else" if outcome.status == "canceled" else ""
        detail = f" ({outcome.detail})" if outcome.detail else ""
        return Ended(f"navigate_to_pose: {outcome.status}{by}{detail}")
