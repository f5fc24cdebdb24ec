"""The messages of the action `move_base`, made from their definitions: move_base_msgs need not be installed.

Definitions and MD5 sums are those of move_base_msgs 1.14 (Noetic); all that they are made of comes with nav_msgs.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from muster_robots.ros1.ros import GoalStatus, PoseStamped, generate_dynamic

_PACKAGE = "move_base_msgs"
_OWN = {
    "MoveBaseActionGoal": "Header header\nactionlib_msgs/GoalID goal_id\nMoveBaseGoal goal",
    "MoveBaseActionFeedback": "Header header\nactionlib_msgs/GoalStatus status\nMoveBaseFeedback feedback",
    "MoveBaseActionResult": "Header header\nactionlib_msgs/GoalStatus status\nMoveBaseResult result",
    "MoveBaseGoal": "geometry_msgs/PoseStamped target_pose",
    "MoveBaseFeedback": "geometry_msgs/PoseStamped base_position",
    "MoveBaseResult": "",
}
_SEPARATOR = "\n" + "=" * 80 + "\nMSG: "


class MoveBaseTypes(NamedTuple):
    """Classes of rospy messages."""

    goal: Any
    feedback: Any
    result: Any


@cache
def move_base_types() -> MoveBaseTypes:
    """Return the classes of the topics `goal`, `feedback` and `result` of the action."""
    installed: dict[str, str] = {}
    for kind in (PoseStamped, GoalStatus):
        installed |= _definitions(kind)
    own = {f"{_PACKAGE}/{name}": text for name, text in _OWN.items()}

    def made(name: str) -> Any:
        of = f"{_PACKAGE}/{name}"
        others = (f"{_SEPARATOR}{other}\n{text}" for other, text in (own | installed).items() if other != of)
        return generate_dynamic(of, own[of] + "".join(others))[of]

    return MoveBaseTypes(*(made(f"MoveBaseAction{part}") for part in ("Goal", "Feedback", "Result")))


def _definitions(kind: Any) -> dict[str, str]:
    """The definitions of a message and of all that it is made of, by their types."""
    first, *parts = kind._full_text.split(_SEPARATOR)
    return {kind._type: first} | {name: text for name, _, text in (part.partition("\n") for part in parts)}
