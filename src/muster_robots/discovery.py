"""Robots by their namespaces and topics: steps 2 to 4 of the dynamic instantiation of [tcf-thesis], Figure 5.7."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from muster.mission.errors import ParameterError

SHARED = {
    "odom": "nav_msgs/Odometry",
    "pose": "geometry_msgs/PoseStamped",
    "amcl_pose": "geometry_msgs/PoseWithCovarianceStamped",
}
"""Topics that say where a robot is, and their types."""
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
"""What ROS takes for one part of a name."""


def robots_in(topics: Iterable[tuple[str, str]], namespace: str = "") -> list[str]:
    """The robots' names, in code-point order.

    Parameters
    ----------
    topics
        all that are published: full names and types.
    namespace
        in which robots are; "" for the root.
    """
    prefix = f"/{namespace.strip('/')}/" if namespace.strip("/") else "/"
    found = set()
    for topic, kind in topics:
        robot, _, shared = topic.removeprefix(prefix).partition("/")
        if topic.startswith(prefix) and SHARED.get(shared) == kind and NAME.fullmatch(robot):
            found.add(robot)
    return sorted(found)


def pose_topics(template: str) -> Callable[[str], str | None]:
    """What gives the topic of a robot's pose, by its name, where others publish it: a motion capture system.

    Parameters
    ----------
    template
        such as `/vrpn_client_node/{robot}/pose`; empty: `<robot>/pose`, which needs no word (None).

    Raises
    ------
    ParameterError
        if there is no `{robot}` in it, or it is no name of ROS.
    """
    if template and (template.count(_ROBOT) != 1 or not _TOPIC.fullmatch(template.replace(_ROBOT, "robot"))):
        raise ParameterError(f"poses: {template}; expected a topic such as /vrpn_client_node/{_ROBOT}/pose")
    return lambda robot: template.replace(_ROBOT, robot) if template else None


_ROBOT = "{robot}"
_TOPIC = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z0-9_]+)*")


def topics_in(namespace: str) -> Callable[[str], str]:
    """What gives the namespace of a robot's topics, such as `/r_0`, by its name."""
    within = [part for part in [namespace.strip("/")] if part]
    return lambda robot: "/".join(["", *within, robot])
