"""The ROS node of this process; a process has one."""

from __future__ import annotations

import logging
import os
import threading
import time
import xmlrpc.client
from collections.abc import Callable
from http.client import HTTPConnection, HTTPException
from typing import Any
from urllib.parse import urlparse
from xml.parsers.expat import ExpatError

from muster.mission.errors import NetworkError
from muster_robots.ros1.ros import rospy
from muster_robots.simulated_time import Forward

SHUT_DOWN = "node /muster: it was shut down, or another took its name; expected it to stay"
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
    address = master_address(master)
    _require_master(address)
    os.environ["ROS_MASTER_URI"] = address
    logging.getLogger("rosout").setLevel(logging.WARNING)
    rospy.init_node(name, disable_signals=True, log_level=rospy.WARN)
    _show_warnings()


def _show_warnings() -> None:
    """Let Muster's own warnings go to standard error, as rospy's do: it has configured logging for itself alone."""
    shown = logging.StreamHandler()
    shown.setFormatter(logging.Formatter("[WARN] %(message)s"))
    for room in ("muster", "muster_robots"):
        logging.getLogger(room).addHandler(shown)
    for name, logger in logging.root.manager.loggerDict.items():
        if name.partition(".")[0] in ("muster", "muster_robots") and isinstance(logger, logging.Logger):
            logger.disabled = False


def time_of_ros() -> Callable[[], float]:
    """Seconds that never go back: of /clock where `/use_sim_time` is set (a `Forward`), else of this computer."""
    return time.monotonic if rospy.rostime.is_wallclock() else Forward(rospy.get_time)


def master_address(master: str | None) -> str:
    """The one that is given, or that of ROS_MASTER_URI, or this computer's."""
    return master or os.environ.get("ROS_MASTER_URI") or _USUAL


def master_answers(address: str, within_s: float = 3.0) -> bool:
    """Whether a ROS master answers there.

    Raises
    ------
    ValueError
        if that is no address.
    """
    parts = urlparse(address)
    if parts.scheme != "http" or parts.hostname is None or parts.port is None:
        raise ValueError(address)
    connection = HTTPConnection(parts.hostname, parts.port, timeout=within_s)
    question = xmlrpc.client.dumps(("/muster_looks",), "getPid")
    try:
        connection.request("POST", "/RPC2", question, {"Content-Type": "text/xml"})
        answer: Any = xmlrpc.client.loads(connection.getresponse().read())[0][0]
        return bool(answer[0] == 1)
    except (OSError, HTTPException, ExpatError, xmlrpc.client.Error, ValueError, TypeError, LookupError):
        return False
    finally:
        connection.close()


def _require_master(address: str) -> None:
    try:
        answers = master_answers(address)
    except ValueError:
        raise NetworkError(f"ROS master: {address}; expected http://HOST:PORT") from None
    if not answers:
        told = "expected a running one (rosmaster --core, roscore), or --master URI"
        raise NetworkError(f"ROS master: {address}: it does not answer; {told}")


def is_ending() -> bool:
    """Whether ROS shuts this node down, or has done so: topics are closed a while before `rospy.is_shutdown`."""
    return bool(rospy.core.is_shutdown_requested())


def publish(publisher: Any, message: Any) -> None:
    """Say something, if this node still is one: ROS may shut it down while a message is being made."""
    try:
        publisher.publish(message)
    except rospy.ROSException:
        if not is_ending():
            raise


def hear(topic: str, kind: Any, do: Callable[..., None], **how: Any) -> Any:
    """Subscribe to a topic, until the node ends: errors because ROS has shut it down are ignored."""

    def heard(message: Any, *more: Any) -> None:
        try:
            do(message, *more)
        except Exception:
            if not is_ending():
                raise

    return rospy.Subscriber(topic, kind, heard, **how)


def listeners(publisher: Any) -> int:
    """Return how many subscribers in other nodes a publisher has: a node that hears its own topic is one of its own."""
    own = rospy.get_name()
    return sum(receiver != own for _, receiver, *_ in publisher.impl.get_stats_info())


def leave(within_s: float = 2.0) -> None:
    """Unregister at the ROS master, after time for the last messages to arrive; does not wait for a hanging master."""
    time.sleep(0.2)
    goodbye = threading.Thread(target=rospy.signal_shutdown, args=("done",), daemon=True)
    goodbye.start()
    goodbye.join(within_s)
