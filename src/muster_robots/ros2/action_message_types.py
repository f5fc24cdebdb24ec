"""The messages of the action `nav2_msgs/NavigateToPose` as they are on the wire of DDS.

Requests and replies begin with the header of rmw_cyclonedds: 8 bytes that name the client and 8 that number its
requests. Definitions are those of action_msgs, unique_identifier_msgs and nav2_msgs (Humble and Jazzy).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Annotated, ClassVar

from muster_robots.ros2.description import (
    Flag,
    Float32,
    Int8,
    Int16,
    Int64,
    Length,
    Message,
    Text,
    UInt8,
    UInt64,
)
from muster_robots.ros2.message_types import Duration, PoseStamped, Time

Identity = Annotated[bytes, "uint8", Length(16)]
_NONE = bytes(16)


@dataclass(frozen=True)
class UUID(Message):
    NAME: ClassVar = "unique_identifier_msgs/UUID"
    uuid: Identity = _NONE


@dataclass(frozen=True)
class GoalInfo(Message):
    NAME: ClassVar = "action_msgs/GoalInfo"
    goal_id: UUID = UUID()
    stamp: Time = Time()


@dataclass(frozen=True)
class GoalStatus(Message):
    NAME: ClassVar = "action_msgs/GoalStatus"
    goal_info: GoalInfo = GoalInfo()
    status: Int8 = 0


@dataclass(frozen=True)
class GoalStatusArray(Message):
    NAME: ClassVar = "action_msgs/GoalStatusArray"
    status_list: tuple[GoalStatus, ...] = ()


@dataclass(frozen=True)
class Goal(Message):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_Goal"
    pose: PoseStamped = PoseStamped()
    behavior_tree: Text = ""


@dataclass(frozen=True)
class Feedback(Message):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_Feedback"
    current_pose: PoseStamped = PoseStamped()
    navigation_time: Duration = Duration()
    estimated_time_remaining: Duration = Duration()
    number_of_recoveries: Int16 = 0
    distance_remaining: Float32 = 0.0


@dataclass(frozen=True)
class FeedbackMessage(Message):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_FeedbackMessage"
    goal_id: UUID = UUID()
    feedback: Feedback = Feedback()


@dataclass(frozen=True)
class Call(Message):
    """Base of requests and replies."""

    client: UInt64 = 0
    number: Int64 = 0


@dataclass(frozen=True)
class SendGoalRequest(Call):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_SendGoal_Request"
    goal_id: UUID = UUID()
    goal: Goal = Goal()


@dataclass(frozen=True)
class SendGoalReply(Call):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_SendGoal_Response"
    accepted: Flag = False
    stamp: Time = Time()


@dataclass(frozen=True)
class GetResultRequest(Call):
    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_GetResult_Request"
    goal_id: UUID = UUID()


@dataclass(frozen=True)
class GetResultReply(Call):
    """The reply of Humble, whose result is empty; what later versions say behind it `words_of` reads."""

    NAME: ClassVar = "nav2_msgs/action/NavigateToPose_GetResult_Response"
    status: Int8 = 0
    structure_needs_at_least_one_member: UInt8 = 0


@dataclass(frozen=True)
class CancelGoalRequest(Call):
    NAME: ClassVar = "action_msgs/srv/CancelGoal_Request"
    goal_info: GoalInfo = GoalInfo()


@dataclass(frozen=True)
class CancelGoalReply(Call):
    NAME: ClassVar = "action_msgs/srv/CancelGoal_Response"
    return_code: Int8 = 0
    goals_canceling: tuple[GoalInfo, ...] = ()


_CODE_AT, _TEXT_AT = 22, 24
"""Where the number and the text of an error are in the bytes of a `GetResultReply`, the four of CDR included."""


def words_of(reply: bytes) -> str:
    """Return why navigation failed by the bytes of a reply: a text since Kilted, a number since Iron; else empty."""
    order = "<" if reply[1] & 1 else ">"
    if len(reply) >= _TEXT_AT + 4:
        (count,) = struct.unpack_from(f"{order}I", reply, _TEXT_AT)
        text = reply[_TEXT_AT + 4 : _TEXT_AT + 4 + count].rstrip(b"\0").decode("utf-8", "replace")
        if text:
            return text
    code = struct.unpack_from(f"{order}H", reply, _CODE_AT)[0] if len(reply) >= _CODE_AT + 2 else 0
    return f"error {code}" if code else ""
