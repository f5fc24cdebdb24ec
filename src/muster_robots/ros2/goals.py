"""Goals of a robot, one at a time: by a pose on a topic, or by Nav2's action (`navigation.NavigationGoals`)."""

from __future__ import annotations

import math
from typing import Protocol

from muster_robots.navigation import PURSUED_S, Ended, NavigationGoals, Navigator
from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import Reader, Writer


class Goals(Protocol):
    """One robot's."""

    expected: str
    """Who is to receive them, in words."""
    feedback: str
    """Where `poses` come from, in words."""
    reports: bool
    """Whether the robot's navigation says when a goal has ended."""

    @property
    def unfit(self) -> str:
        """Why goals must not be given to who is there, and what is expected; empty if they may."""
        ...

    @property
    def ready(self) -> bool:
        """Whether there is somebody to whom goals can be given."""
        ...

    @property
    def at_rest(self) -> bool:
        """Whether nothing that was given is under way, as far as that is said."""
        ...

    @property
    def foreign(self) -> str:
        """Whose goal the robot pursues, if that is not Muster's, in words; empty if none is known."""
        ...

    def leave(self) -> None:
        """Give up the goal for that of somebody else, which stays as it is."""
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
    """Goals on a topic. They have no result: poses show when they are reached.

    Parameters
    ----------
    writer : Writer
        Publishes them.
    topic : str
        The topic's name.
    others : Reader, optional
        Hears the goals of others on it; by default these are not known.
    """

    at_rest, reports = True, False
    unfit = feedback = ""

    def __init__(self, writer: Writer[PoseStamped], topic: str, others: Reader[PoseStamped] | None = None) -> None:
        self.foreign = ""
        self._topic, self._others, self._foreign_s = topic, others, -math.inf
        self.expected = f"a subscriber of {topic} (geometry_msgs/PoseStamped)"
        self._writer = writer

    @property
    def ready(self) -> bool:
        """Whether somebody subscribes."""
        return self._writer.listeners > 0

    def leave(self) -> None:
        """Nothing that was given is under way, as far as that is said."""

    def give(self, goal: PoseStamped) -> None:
        self._writer.write(goal)

    def withdraw(self, here: PoseStamped | None) -> bool:
        """Its goal becomes where it is. One whose pose is not known keeps the goal that it has."""
        if here is not None:
            self._writer.write(here)
        return here is not None

    def hear(self, now: float, *, under_way: bool) -> Ended | None:
        self._foreign_s = now if self._others is not None and self._others.take() else self._foreign_s
        self.foreign = f"a goal on {self._topic} is not Muster's" if now < self._foreign_s + PURSUED_S else ""
        return None

    def poses(self) -> list[PoseStamped]:
        return []


class Nav2Goals(NavigationGoals[PoseStamped]):
    """Goals of the action `nav2_msgs/NavigateToPose`."""

    def __init__(self, navigator: Navigator[PoseStamped], action: str) -> None:
        super().__init__(navigator, "navigate_to_pose")
        self.expected = f"an action server of {action} (nav2_msgs/NavigateToPose)"
        self.feedback = f"{action}/_action/feedback"

    @property
    def unfit(self) -> str:
        """See `Goals`."""
        return self._navigator.unfit
