"""The ways in which a robot on ROS 1 takes orders: velocities, goals on a topic, or goals of the action move_base."""

from __future__ import annotations

import math
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.navigation import PURSUED_S, Ended, NavigationGoals
from muster_robots.pose_port import goal_heading
from muster_robots.ros1.message_conversion import pose_stamped, twist_of
from muster_robots.ros1.node import hear, listeners, publish
from muster_robots.ros1.ros import PoseStamped, Twist, rospy
from muster_robots.steering import STILL, Velocity

Drive = Literal["cmd_vel", "goals", "move_base", "move_base_simple"]
_TOLD_STILL_S = 1.0
"""Seconds for which a robot without way points gets zero velocities; after that a person may drive it."""
_SIMPLE = "move_base_simple/goal"


@dataclass(frozen=True)
class Course:
    """What a robot is to do now.

    Parameters
    ----------
    now_s : float
        Seconds of a clock that goes on in pauses.
    at : tuple[int, int]
        The next way point, by its order and its number there.
    aim : Waypoint | None
        Where it is to go; None: it stands.
    place : Place
        The aim's place, or where it stands, with the height that a goal has.
    velocity : Velocity
        By which it gets there around others.
    said : Telemetry
        What it said last.
    waits : bool
        Whether it has passed all its way points.
    under_way : bool
        Whether it is on its way to a way point.
    """

    now_s: float
    at: tuple[int, int]
    aim: Waypoint | None
    place: Place
    velocity: Velocity
    said: Telemetry
    waits: bool
    under_way: bool


class Orders(Protocol):
    """One robot's."""

    expected: str
    """Who is to receive them, in words."""
    reports: bool
    """Whether the robot's navigation says when a goal has ended."""

    @property
    def at_rest(self) -> bool:
        """Whether no goal is known to be under way."""
        ...

    @property
    def received(self) -> bool:
        """Whether somebody receives them."""
        ...

    @property
    def foreign(self) -> str:
        """Whose goal the robot pursues, if that is not Muster's, in words; empty if none is known."""
        ...

    def leave(self) -> None:
        """Give up the goal for that of somebody else, which stays as it is."""
        ...

    def begin(self, now_s: float) -> None:
        """Note that the robot was sent somewhere."""
        ...

    def speak(self, course: Course) -> Ended | None:
        """Say what is due; return how the robot's own navigation ended, once, where it says so."""
        ...

    def repeat(self) -> None:
        """Let the next `speak` give the goal once more."""
        ...

    def stand(self, now_s: float, place: Place, said: Telemetry | None) -> None:
        """Let it stand at its place, at once."""
        ...

    def poses(self) -> list[Any]:
        """Where its navigation said that it was (PoseStamped), since the last call."""
        ...

    def close(self) -> None:
        """Say and hear no more."""
        ...


def orders_for(drive: Drive, topics: str, frame: str, now: Callable[[], float], lock: threading.RLock) -> Orders:
    """Return the orders of a robot by how it is driven.

    Parameters
    ----------
    topics : str
        Its namespace, such as `/r_0`.
    frame : str
        Frame of its goals.
    now : Callable
        Seconds of a clock that goes on in pauses.
    """
    if drive == "cmd_vel":
        return VelocityOrders(topics)
    if drive == "goals":
        return GoalOrders(f"{topics}/WP", frame)
    if drive == "move_base_simple":
        return GoalOrders(f"{topics}/{_SIMPLE}", frame)
    from muster_robots.ros1.move_base import MoveBaseNavigator

    return ActionOrders(MoveBaseNavigator(f"{topics}/move_base", now, lock), f"{topics}/move_base", frame)


class VelocityOrders:
    """Velocities on `<robot>/cmd_vel`, which are said all the time."""

    at_rest, reports, foreign = True, False, ""

    def __init__(self, topics: str) -> None:
        self.expected = f"a subscriber of {topics}/cmd_vel (geometry_msgs/Twist)"
        self._publisher = rospy.Publisher(f"{topics}/cmd_vel", Twist, queue_size=1)
        self._stood_s = -math.inf

    @property
    def received(self) -> bool:
        return bool(self._publisher.get_num_connections() > 0)

    def begin(self, now_s: float) -> None:
        self._stood_s = now_s

    def speak(self, course: Course) -> None:
        if course.aim is not None:
            self._stood_s = course.now_s
        if course.now_s - self._stood_s <= _TOLD_STILL_S:
            publish(self._publisher, twist_of(course.velocity))

    def leave(self) -> None:
        """There is no goal."""

    def repeat(self) -> None:
        """The next velocity comes anyway."""

    def stand(self, now_s: float, place: Place, said: Telemetry | None) -> None:
        self._stood_s = now_s
        publish(self._publisher, twist_of(STILL))

    def poses(self) -> list[Any]:
        return []

    def close(self) -> None:
        self._publisher.unregister()


class _Goals(ABC):
    """Base of orders that are goals: which way point was given, and with which heading."""

    def __init__(self, frame: str) -> None:
        self._frame = frame
        self._given: tuple[int, int] | None = None
        self._aim: Place | None = None

    def begin(self, now_s: float) -> None:  # noqa: B027 - nothing is said before
        """Goals are given by `speak`."""

    def _follow(self, course: Course) -> None:
        """Give the goal of a course where it is new; let the robot stand where it has none."""
        aim = course.aim
        if aim is None:
            if self._given is not None and (not course.waits or self._given == course.at):
                self.stand(course.now_s, course.place, course.said)  # paused, not heard, or back from making room
            return
        if (self._given, self._aim) != (course.at, aim.position):
            self._give(pose_stamped(self._frame, course.place, goal_heading(aim, course.said)))
            self._given, self._aim = course.at, aim.position

    def leave(self) -> None:
        self._given = None

    def repeat(self) -> None:
        self._given = None

    def stand(self, now_s: float, place: Place, said: Telemetry | None) -> None:
        self._given = None
        self._stay(None if said is None else pose_stamped(self._frame, place, said.heading))

    @abstractmethod
    def _give(self, goal: Any) -> None:
        """Give a goal, a PoseStamped."""

    @abstractmethod
    def _stay(self, here: Any | None) -> None:
        """Let the robot stay where it is; None: that is not known."""


class GoalOrders(_Goals):
    """Goals as geometry_msgs/PoseStamped on a topic, latched; to stand, the robot's goal becomes where it is."""

    at_rest, reports = True, False

    def __init__(self, topic: str, frame: str) -> None:
        super().__init__(frame)
        self.foreign = ""
        self._topic, self._is_foreign, self._foreign_s = topic, False, -math.inf
        self.expected = f"a subscriber of {topic} (geometry_msgs/PoseStamped)"
        self._publisher = rospy.Publisher(topic, PoseStamped, queue_size=1, latch=True)
        self._others = hear(topic, PoseStamped, self._hear_goal, queue_size=10)

    @property
    def received(self) -> bool:
        return listeners(self._publisher) > 0

    def speak(self, course: Course) -> None:
        if self._is_foreign:
            self._is_foreign, self._foreign_s = False, course.now_s
        self.foreign = f"a goal on {self._topic} is not Muster's" if course.now_s < self._foreign_s + PURSUED_S else ""
        self._follow(course)

    def poses(self) -> list[Any]:
        return []

    def close(self) -> None:
        self._others.unregister()
        self._publisher.unregister()

    def _hear_goal(self, goal: Any) -> None:
        """Take in a goal on the topic, which may be one of Muster's."""
        if goal._connection_header["callerid"] != rospy.get_name():
            self._is_foreign = True

    def _give(self, goal: Any) -> None:
        publish(self._publisher, goal)

    def _stay(self, here: Any | None) -> None:
        if here is not None:
            publish(self._publisher, here)


class ActionOrders(_Goals):
    """Goals of the action `move_base`, which are cancelled where the robot is to stand."""

    reports = True

    def __init__(self, navigator: Any, action: str, frame: str) -> None:
        super().__init__(frame)
        self.expected = f"an action server of {action} (move_base_msgs/MoveBaseAction)"
        self._navigator = navigator
        self._goals: NavigationGoals[Any] = NavigationGoals(navigator, "move_base")

    @property
    def at_rest(self) -> bool:
        return self._goals.at_rest

    @property
    def received(self) -> bool:
        return self._goals.ready

    @property
    def foreign(self) -> str:
        return self._goals.foreign

    def leave(self) -> None:
        super().leave()
        self._goals.leave()

    def speak(self, course: Course) -> Ended | None:
        ended = self._goals.hear(course.now_s, under_way=course.under_way)
        self._follow(course)
        return ended

    def poses(self) -> list[Any]:
        return self._goals.poses()

    def close(self) -> None:
        self._navigator.close()

    def _give(self, goal: Any) -> None:
        self._goals.give(goal)

    def _stay(self, here: Any | None) -> None:
        self._goals.withdraw(None)
