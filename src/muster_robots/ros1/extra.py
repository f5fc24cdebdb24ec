"""The bridge's system packages: rospy and the standard messages, which come with the system, not from PyPI."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from muster.mission.errors import MissingExtraError

PACKAGES = "python3-rospy python3-nav-msgs python3-std-srvs python3-tf2-msgs"
"""Of Debian 12; other message packages come with them."""
_PLACES = ("/opt/ros/noetic/lib/python3/dist-packages", "/usr/lib/python3/dist-packages")
_NEEDED = ("rospy", "genpy", "actionlib_msgs", "geometry_msgs", "nav_msgs", "std_msgs", "std_srvs", "tf2_msgs")


def require_rospy(more: Sequence[str] = ()) -> None:
    """Let rospy be imported, from a virtual environment too: its folder comes last, and shadows nothing.

    Parameters
    ----------
    more
        message packages that are needed besides.

    Raises
    ------
    MissingExtraError
        if it is not there.
    """
    needed = (*_NEEDED, *more)
    for place in _PLACES:
        if _absent(needed) and place not in sys.path and Path(place, "rospy").is_dir():
            sys.path.append(place)
    absent = _absent(needed)
    if absent:
        packages = " ".join([PACKAGES, *(f"python3-{name.replace('_', '-')}" for name in more)])
        raise MissingExtraError("ros1", f"ROS 1 ({', '.join(absent)})", how=f"apt-get install {packages}")


def _absent(needed: Sequence[str]) -> list[str]:
    return [name for name in needed if find_spec(name) is None]
