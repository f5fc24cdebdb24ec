"""A process as a node of ROS: there is one a process."""

from __future__ import annotations

import logging
import os
import socket
import time
from collections.abc import Callable
from urllib.parse import urlparse

from muster.bridges.ros1.clock import Forward
from muster.bridges.ros1.ros import rosgraph, rospy
from muster.mission.errors import NetworkError

_USUAL = "http://localhost:11311"


def become_node(name: str, master: str | None = None) -> None:
    """Register with the ROS master; signals stay the program's own.

    Parameters
    ----------
    master
        its address, such as http://localhost:11311; None: that of ROS_MASTER_URI, or this one.

    Raises
    ------
    NetworkError
        if no ROS master answers there.
    """
    address = master or os.environ.get("ROS_MASTER_URI") or _USUAL
    _require_master(address)
    os.environ["ROS_MASTER_URI"] = address
    logging.getLogger("rosout").setLevel(logging.WARNING)
    rospy.init_node(name, disable_signals=True, log_level=rospy.WARN)


def time_of_ros() -> Callable[[], float]:
    """Seconds that never go back: of /clock where `/use_sim_time` is set (a `Forward`), else of this computer."""
    return time.monotonic if rospy.rostime.is_wallclock() else Forward(rospy.get_time)


def _require_master(address: str) -> None:
    try:
        parts = urlparse(address)
        if parts.scheme != "http" or parts.hostname is None or parts.port is None:
            raise NetworkError(f"ROS master: {address}; expected http://HOST:PORT")
        socket.create_connection((parts.hostname, parts.port), timeout=3.0).close()
        rosgraph.Master("/muster_looks", master_uri=address).getPid()
    except ValueError:
        raise NetworkError(f"ROS master: {address}; expected http://HOST:PORT") from None
    except Exception as error:
        if isinstance(error, NetworkError):
            raise
        told = "expected a running one (rosmaster --core, roscore), or --master URI"
        raise NetworkError(f"ROS master: {address}: it does not answer; {told}") from None


def leave() -> None:
    """Say goodbye to the ROS master; what was said last has time to arrive."""
    time.sleep(0.2)
    rospy.signal_shutdown("done")
