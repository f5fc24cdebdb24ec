"""Robots by their namespaces and topics: steps 2 to 4 of the dynamic instantiation of [tcf-thesis], Figure 5.7."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

SHARED = {"odom": "nav_msgs/Odometry", "pose": "geometry_msgs/PoseStamped"}
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


def topics_in(namespace: str) -> Callable[[str], str]:
    """What gives the namespace of a robot's topics, such as `/r_0`, by its name."""
    within = [part for part in [namespace.strip("/")] if part]
    return lambda robot: "/".join(["", *within, robot])
