"""Nav2's action over DDS without ROS: its three services, its feedback and its states, as rmw_cyclonedds has them.

A service `/r_0/x` has the topics `rq/r_0/xRequest` and `rr/r_0/xReply` (design.ros2.org, "Topic and Service name
mapping to DDS"); how a reply is matched to its request is each make's own affair: rmw_cyclonedds begins both with the
same 16 bytes. Other makes put that elsewhere, where Cyclone DDS has no access to it: their servers are named and not
called.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol, TypeVar

from muster.mission.errors import NetworkError
from muster_robots.navigation import Navigation, Outcome
from muster_robots.ros2.action_message_types import (
    UUID,
    Call,
    CancelGoalReply,
    CancelGoalRequest,
    FeedbackMessage,
    GetResultReply,
    GetResultRequest,
    Goal,
    GoalInfo,
    GoalStatusArray,
    SendGoalReply,
    SendGoalRequest,
    words_of,
)
from muster_robots.ros2.dds_endpoints import Endpoint, Endpoints
from muster_robots.ros2.description import Message
from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import Reader, line_of

M = TypeVar("M", bound=Message)
_STATUS: dict[int, Any] = {4: "succeeded", 5: "canceled", 6: "aborted"}
"""By action_msgs/GoalStatus."""
_UNDER_WAY = (1, 2, 3)
"""Accepted, executing, cancelling: by action_msgs/GoalStatus."""
_OWN = b"muster"
"""Begins the ids of goals, so that those of an earlier run are known, too."""
_FEEDBACK_LASTS_S = 1.0
"""Seconds after feedback in which its goal counts as under way; Nav2 sends feedback several times a second."""
_ANSWERS_WITHIN_S = 5.0
"""Seconds within which a server accepts or rejects a goal, or it was lost on the way."""
_RESULT_WITHIN_S = 1.0
"""Seconds for which the result of a goal that has ended is waited for, as it has the reason."""


class Participant(Protocol):
    """What a client of an action needs of a `DdsMiddleware`."""

    error: Any
    publications: Endpoints
    subscriptions: Endpoints

    def reader(self, topic: str, message: type[M]) -> Reader[M]:
        """See `Middleware`."""
        ...

    def client(
        self, topics: tuple[str, str], messages: tuple[type[Message], type[Message]], theirs: tuple[Endpoint, Endpoint]
    ) -> tuple[Any, Any] | None:
        """Make the writer of requests and the reader of replies of a service; None while their types are not known."""
        ...

    def encoded(self, message: Message, kind: Any) -> Any:
        """Return a message as a sample of the type that a writer has."""
        ...

    def decoded(self, message: type[M], reader: Any) -> list[tuple[M, bytes]]:
        """Return what a reader has received, as messages and as bytes."""
        ...


class DdsNavigator:
    """A client of an action `nav2_msgs/NavigateToPose`: a `Navigator`. Polled, in the thread that asks.

    Parameters
    ----------
    action : str
        The action's name, such as `/r_0/navigate_to_pose`.
    """

    def __init__(self, middleware: Participant, action: str) -> None:
        self._action = f"{action}/_action"
        self.sends = _Service(middleware, f"{self._action}/send_goal", SendGoalRequest, SendGoalReply)
        self.results = _Service(middleware, f"{self._action}/get_result", GetResultRequest, GetResultReply)
        self.cancels = _Service(middleware, f"{self._action}/cancel_goal", CancelGoalRequest, CancelGoalReply)
        self._feedback = middleware.reader(f"{self._action}/feedback", FeedbackMessage)
        self._states = middleware.reader(f"{self._action}/status", GoalStatusArray)
        self._goal: _DdsNavigation | None = None
        self._foreign: UUID | None = None  # by the states of goals
        self._foreign_fed: tuple[UUID, float] | None = None  # by feedback, and when that was heard

    @property
    def foreign(self) -> str:
        """See `navigation.Navigator`."""
        self.hear()
        if not self.sends.servers:
            self._foreign = self._foreign_fed = None
        if self._foreign_fed is not None and time.monotonic() > self._foreign_fed[1] + _FEEDBACK_LASTS_S:
            self._foreign_fed = None
        found = self._foreign or (self._foreign_fed and self._foreign_fed[0])
        return "" if found is None else found.uuid.hex()

    @property
    def unfit(self) -> str:
        """See `navigation.Navigator`."""
        return self.sends.unfit

    @property
    def ready(self) -> bool:
        """See `navigation.Navigator`."""
        return all(service.is_there() for service in (self.sends, self.results, self.cancels))

    def go(self, goal: PoseStamped) -> Navigation[PoseStamped]:
        """See `navigation.Navigator`."""
        self._goal = _DdsNavigation(self, goal)
        return self._goal

    def hear(self) -> None:
        """Take in feedback and states."""
        feedback, states = self._feedback.take(), self._states.take()
        for array in states:
            under_way = (one.goal_info.goal_id for one in array.status_list if one.status in _UNDER_WAY)
            self._foreign = next((one for one in under_way if not _is_own(one)), None)
            self._foreign_fed = None
        for one in feedback:
            if not _is_own(one.goal_id):
                self._foreign_fed = one.goal_id, time.monotonic()
        if self._goal is not None:
            self._goal.hear(feedback, states)


class _DdsNavigation:
    """See `navigation.Navigation`."""

    def __init__(self, navigator: DdsNavigator, goal: PoseStamped) -> None:
        self._navigator = navigator
        self._id = UUID(_OWN + os.urandom(16 - len(_OWN)))
        self._poses: list[PoseStamped] = []
        self._outcome: Outcome | None = None
        self._accepted = self._cancelled = False
        self._ended: tuple[str, float] | None = None  # by the states of goals, and when that was heard
        self._servers = navigator.sends.servers
        self._until_s = time.monotonic() + _ANSWERS_WITHIN_S
        self._result: int | None = None
        self._sent = self._asked(lambda: navigator.sends.call(SendGoalRequest(goal_id=self._id, goal=Goal(goal))))

    @property
    def outcome(self) -> Outcome | None:
        """See `navigation.Navigation`."""
        self._navigator.hear()
        if self._outcome is None:
            self._outcome = self._answer() if self._accepted else self._acceptance()
        if self._outcome is None and not self._servers & self._navigator.sends.servers:
            self._outcome = Outcome("lost", "its server has gone")
        return self._outcome

    def take(self) -> list[PoseStamped]:
        """See `navigation.Navigation`."""
        self._navigator.hear()
        poses, self._poses = self._poses, []
        return poses

    def cancel(self) -> None:
        """See `navigation.Navigation`."""
        self._cancelled = True
        if self._accepted and self._outcome is None:
            self._navigator.cancels.call(CancelGoalRequest(goal_info=GoalInfo(self._id)))

    def hear(self, feedback: list[FeedbackMessage], states: list[GoalStatusArray]) -> None:
        """Take in what is said of this goal among others."""
        self._poses += [one.feedback.current_pose for one in feedback if one.goal_id == self._id]
        for status in (one for some in states for one in some.status_list):
            if status.goal_info.goal_id == self._id and status.status in _STATUS and self._ended is None:
                self._ended = _STATUS[status.status], time.monotonic()

    def _acceptance(self) -> Outcome | None:
        """Take in whether the goal is accepted, and ask for its result."""
        reply = None if self._sent is None else self._navigator.sends.reply(self._sent)
        if reply is None:
            return Outcome("lost", "no answer") if time.monotonic() > self._until_s else None
        if not reply[0].accepted:
            return Outcome("rejected")
        self._accepted = True
        self._result = self._asked(lambda: self._navigator.results.call(GetResultRequest(goal_id=self._id)))
        if self._cancelled:  # before it was accepted
            self.cancel()
        return None

    def _answer(self) -> Outcome | None:
        """Return how the goal has ended, with the reason where that comes in time."""
        reply = None if self._result is None else self._navigator.results.reply(self._result)
        if reply is not None:
            return Outcome(_STATUS.get(reply[0].status, "aborted"), words_of(reply[1]))
        if self._ended is not None and time.monotonic() - self._ended[1] > _RESULT_WITHIN_S:
            return Outcome(self._ended[0])  # type: ignore[arg-type]
        return None

    def _asked(self, call: Callable[[], int]) -> int | None:
        """Call; what fails on the way to the server ends the goal and nothing else."""
        try:
            return call()
        except NetworkError as error:
            self._outcome = Outcome("aborted", str(error))
            return None


def _is_own(goal: UUID) -> bool:
    return goal.uuid.startswith(_OWN)


class _Service:
    """A client of one service. Its writer and reader are made when a server is there, with the types that it tells."""

    def __init__(self, middleware: Participant, name: str, request: type[Call], reply: type[Call]) -> None:
        self._middleware, self._name, self._request, self._reply = middleware, name, request, reply
        path = name.strip("/")
        self._topics = f"rq/{path}Request", f"rr/{path}Reply"
        self._client, self._number = int.from_bytes(os.urandom(8), "little"), 0
        self._writer: Any = None
        self._reader: Any = None
        self._met: frozenset[str] = frozenset()  # the servers for which they were made
        self._replies: dict[int, tuple[Any, bytes]] = {}

    @property
    def servers(self) -> frozenset[str]:
        """The keys of the servers that are there."""
        return frozenset(one.key for one in self._middleware.subscriptions.of_topic(self._topics[0]))

    @property
    def unfit(self) -> str:
        """Why a server that is there cannot be called, and what is expected; empty if it can, or there is none."""
        foreign = [one for one in self._middleware.subscriptions.of_topic(self._topics[0]) if not one.is_cyclone]
        if not foreign:
            return ""
        expected = "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot, or --by rclpy"
        make = f"another make of DDS than Cyclone DDS (vendor {foreign[0].vendor})"
        return f"{self._name} is served by {make}, whose calls have another header; expected {expected}"

    def is_there(self) -> bool:
        """Whether a server takes requests, and answers."""
        if not self._is_matched() and self.servers != self._met:
            self._meet()
        return self._is_matched()

    def call(self, request: Call) -> int:
        """Send a request; returns its number.

        Raises
        ------
        NetworkError
            if it cannot be sent.
        """
        self._number += 1
        if self._writer is None:
            raise NetworkError(f"{self._name}: DDS: no server; expected one")
        message = replace(request, client=self._client, number=self._number)
        try:
            self._writer.write(self._middleware.encoded(message, self._writer.data_type))
        except self._middleware.error as error:
            raise NetworkError(f"{self._name}: DDS: {line_of(error)}") from None
        return self._number

    def reply(self, number: int) -> tuple[Any, bytes] | None:
        """Return the reply to a request, once, with its bytes; None while there is none."""
        for reply, data in () if self._reader is None else self._middleware.decoded(self._reply, self._reader):
            if reply.client == self._client:
                self._replies[reply.number] = reply, data
        return self._replies.pop(number, None)

    def _is_matched(self) -> bool:
        ends = self._writer, self._reader
        return None not in ends and bool(ends[0].get_matched_subscriptions() and ends[1].get_matched_publications())

    def _meet(self) -> None:
        """Make writer and reader, if a server has its ends of both topics: with the types of the one that came last."""
        requests = self._middleware.subscriptions.of_topic(self._topics[0])
        replies = self._middleware.publications.of_topic(self._topics[1])
        if not (requests and replies) or self.unfit:
            return
        made = self._middleware.client(self._topics, (self._request, self._reply), (requests[-1], replies[-1]))
        if made is not None:
            self._writer, self._reader = made
            self._met = frozenset(one.key for one in requests)
