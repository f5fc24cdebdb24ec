"""The lifetime of a node that the controller starts: it ends with its standard input, so never after the controller."""

from __future__ import annotations

import os
import select
from collections.abc import Callable
from typing import NoReturn

from muster_robots.ros1.node import become_node, leave
from muster_robots.ros1.ros import rospy

_LOOK_S = 0.5


def live(name: str, duty: Callable[[], object]) -> NoReturn:
    """Be the node of this name, and do its duty in ROS' threads; the process ends with it.

    Raises
    ------
    NetworkError
        if no ROS master answers.
    """
    become_node(name)
    duty()
    while not rospy.is_shutdown():
        readable, _, _ = select.select([0], [], [], _LOOK_S)
        if readable and not os.read(0, 1024):
            break
    leave()
    os._exit(0)  # a plan that is half made is not waited for
