"""A client of a robot's `move_base`, as actionlib's simple client is, on the five topics of the action.

The action's server sends the states of its goals several times a second; where that ceases, the server has gone.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from typing import Any

from muster_robots.navigation import Navigation, Outcome
from muster_robots.ros1.action_types import move_base_types
from muster_robots.ros1.node import hear, publish
from muster_robots.ros1.ros import GoalID, GoalStatus, GoalStatusArray, rospy

_STATES_LAST_S = 3.0
"""Seconds without the states of goals after which the server counts as gone; actionlib sends them 5 times a second."""
_ACCEPTS_WITHIN_S = 5.0
"""Seconds within which a goal appears among the server's, or it was lost on the way."""
_ENDS: dict[int, Any] = {
    GoalStatus.PREEMPTED: "canceled",
    GoalStatus.RECALLED: "canceled",
    GoalStatus.SUCCEEDED: "succeeded",
    GoalStatus.ABORTED: "aborted",
    GoalStatus.REJECTED: "rejected",
    GoalStatus.LOST: "lost",
}
_UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE, GoalStatus.PREEMPTING, GoalStatus.RECALLING)
_number = itertools.count(1)


class MoveBaseNavigator:
    """A `Navigator` of geometry_msgs/PoseStamped.

    Parameters
    ----------
    action : str
        The action's name, such as `/r_0/move_base`.
    now : Callable
        Seconds of a clock that never goes back, by which states are fresh.
    lock : threading.RLock
        Held wherever what is known is read or changed: ROS calls from threads of its own.
    """

    unfit = ""

    def __init__(self, action: str, now: Callable[[], float], lock: threading.RLock) -> None:
        self._now, self._lock = now, lock
        self._heard_s: float | None = None
        self._goal: _MoveBaseNavigation | None = None
        self._own = f"{rospy.get_name()}-"  # begins the ids of goals, those of an earlier run too
        self._foreign = ""
        kinds = move_base_types()
        self._kind = kinds.goal
        self._goals = rospy.Publisher(f"{action}/goal", kinds.goal, queue_size=10)
        self._cancels = rospy.Publisher(f"{action}/cancel", GoalID, queue_size=10)
        self._links = [
            hear(f"{action}/status", GoalStatusArray, self._hear_states, queue_size=10),
            hear(f"{action}/feedback", kinds.feedback, self._hear_feedback, queue_size=1),
            hear(f"{action}/result", kinds.result, self._hear_result, queue_size=10),
        ]

    @property
    def ready(self) -> bool:
        """Whether a server takes goals, and says how they are."""
        with self._lock:
            fresh = self._heard_s is not None and self._now() - self._heard_s < _STATES_LAST_S
        return fresh and all(link.get_num_connections() > 0 for link in (self._goals, self._cancels))

    @property
    def foreign(self) -> str:
        """See `navigation.Navigator`."""
        return self._foreign if self.ready else ""

    def go(self, goal: Any) -> Navigation[Any]:
        """See `navigation.Navigator`."""
        stamp = rospy.Time.now()
        message = self._kind()
        message.header.stamp = message.goal_id.stamp = stamp
        message.goal_id.id = f"{self._own}{next(_number)}-{stamp.to_sec():.3f}"
        message.goal.target_pose = goal
        with self._lock:
            self._goal = _MoveBaseNavigation(message.goal_id.id, self._cancels, self._now() + _ACCEPTS_WITHIN_S)
        publish(self._goals, message)
        return self._goal

    def close(self) -> None:
        """Say and hear no more."""
        for link in (*self._links, self._goals, self._cancels):
            link.unregister()

    def _hear_states(self, message: Any) -> None:
        with self._lock:
            self._heard_s = self._now()
            under_way = (one.goal_id.id for one in message.status_list if one.status in _UNDER_WAY)
            self._foreign = next((name for name in under_way if not name.startswith(self._own)), "")
            if self._goal is not None:
                self._goal.hear_states({one.goal_id.id: one for one in message.status_list}, self._heard_s)

    def _hear_result(self, message: Any) -> None:
        with self._lock:
            if self._goal is not None:
                self._goal.hear_state(message.status)

    def _hear_feedback(self, message: Any) -> None:
        with self._lock:
            if self._goal is not None and message.status.goal_id.id == self._goal.id:
                self._goal.poses.append(message.feedback.base_position)


class _MoveBaseNavigation:
    """See `navigation.Navigation`."""

    def __init__(self, goal_id: str, cancels: Any, accepted_until_s: float) -> None:
        self.id, self._cancels, self._accepted_until_s = goal_id, cancels, accepted_until_s
        self.outcome: Outcome | None = None
        self.poses: list[Any] = []
        self._known = False  # to the server

    def take(self) -> list[Any]:
        poses, self.poses = self.poses, []
        return poses

    def cancel(self) -> None:
        publish(self._cancels, GoalID(id=self.id))

    def hear_states(self, states: dict[str, Any], now_s: float) -> None:
        """Take in the states of all of the server's goals; one that a server knew and knows no more is lost."""
        if self.id in states:
            self.hear_state(states[self.id])
        elif self.outcome is None and (self._known or now_s > self._accepted_until_s):
            self.outcome = Outcome("lost", "its server does not know it")

    def hear_state(self, state: Any) -> None:
        if state.goal_id.id == self.id and self.outcome is None:
            self._known = True
            if state.status in _ENDS:
                self.outcome = Outcome(_ENDS[state.status], state.text)
