"""The bridge's system packages: rospy and the standard messages, which come with the system, not from PyPI."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

from muster.mission.errors import MissingExtraError

PACKAGES = "python3-rospy python3-nav-msgs python3-std-srvs python3-tf2-msgs"
"""Of Debian 12; other message packages come with them."""
_PLACES = ("/opt/ros/noetic/lib/python3/dist-packages", "/usr/lib/python3/dist-packages")
_NEEDED = ("rospy", "geometry_msgs", "nav_msgs", "std_msgs", "std_srvs", "tf2_msgs")


def require_rospy() -> None:
    """Let rospy be imported, from a virtual environment too: its folder comes last, and shadows nothing.

    Raises
    ------
    MissingExtraError
        if it is not there.
    """
    for place in _PLACES:
        if _absent() and place not in sys.path and Path(place, "rospy").is_dir():
            sys.path.append(place)
    absent = _absent()
    if absent:
        raise MissingExtraError("ros1", f"ROS 1 ({', '.join(absent)})", how=f"apt-get install {PACKAGES}")


def _absent() -> list[str]:
    return [name for name in _NEEDED if find_spec(name) is None]
