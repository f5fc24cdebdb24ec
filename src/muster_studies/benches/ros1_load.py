"""Processes of the ROS 1 bench: many small robots, and the bridge that is measured.

`robots COUNT HZ` forks a process a robot, which knows nothing of Muster; `bridge COUNT WINDOWS SECONDS` steers them
around squares and prints, for each window of time, what it heard as a line of JSON.
"""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any, NoReturn

from muster_robots.ros1.extra import require_rospy

SIDE_M, APART_M, SPEED_MPS = 2.0, 4.0, 0.5


def starts(count: int) -> Iterator[tuple[str, tuple[float, float]]]:
    """Robots in rows, so far apart that their squares do not touch."""
    columns = math.ceil(math.sqrt(count))
    for k in range(count):
        yield f"r_{k}", (APART_M * (k % columns), APART_M * (k // columns))


def robots(count: int, rate_hz: float) -> None:
    """Fork them; all end with this process."""
    require_rospy()
    import nav_msgs.msg
    import rospy

    children = []
    for k, (name, place) in enumerate(starts(count)):
        child = os.fork()
        if child == 0:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            _drive(rospy, nav_msgs.msg.Odometry, name, place, 1 / rate_hz, k / count)
        children.append(child)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    try:
        signal.pause()
    finally:
        for child in children:
            os.kill(child, signal.SIGKILL)


def _drive(
    rospy: Any, odometry: Any, name: str, place: tuple[float, float], interval_s: float, phase: float
) -> NoReturn:
    """A differential drive that follows commands exactly; its messages are staggered within the interval."""
    from geometry_msgs.msg import Twist

    rospy.init_node(f"load_{name}", disable_signals=True)
    poses = rospy.Publisher(f"/{name}/odom", odometry, queue_size=10, tcp_nodelay=True)
    told = deque([Twist()], maxlen=1)
    rospy.Subscriber(f"/{name}/cmd_vel", Twist, told.append, queue_size=1, tcp_nodelay=True)
    (x, y), heading = place, 0.0
    due = (time.monotonic() // interval_s + phase) * interval_s
    while True:
        due += interval_s
        time.sleep(max(0.0, due - time.monotonic()))
        twist = told[-1]
        heading += twist.angular.z * interval_s
        x += math.cos(heading) * twist.linear.x * interval_s
        y += math.sin(heading) * twist.linear.x * interval_s
        message = odometry()
        message.header.frame_id = "map"
        message.pose.pose.position.x, message.pose.pose.position.y = x, y
        message.pose.pose.orientation.z, message.pose.pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)
        message.twist.twist = twist
        message.header.stamp = rospy.Time.now()
        poses.publish(message)


class Heard:
    """The stamps and numbers of poses as they arrive, by robot."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._latencies: list[float] = []
        self._numbers: dict[str, list[int]] = {}

    def note(self, robot: str, message: Any) -> None:
        """A pose of a robot has just become its telemetry."""
        late = time.time() - message.header.stamp.to_sec()
        with self._lock:
            self._latencies.append(late)
            self._numbers.setdefault(robot, []).append(message.header.seq)

    def taken(self) -> tuple[list[float], int]:
        """Sorted latencies, and how many numbers are missing; then start a new window."""
        with self._lock:
            latencies, numbers = sorted(self._latencies), self._numbers
            self._latencies, self._numbers = [], {}
        return latencies, sum(max(own) - min(own) + 1 - len(own) for own in numbers.values())


def bridge(count: int, windows: int, window_s: float) -> None:
    """Measure."""
    from muster.mission.model import Mission, Robot
    from muster.motion.port import Waypoint
    from muster_robots.ros1.fleet import Ros1Fleet
    from muster_robots.ros1.node import become_node, leave

    body = {"kinematics": "differential-drive", "radius_m": 0.2, "speed_mps": SPEED_MPS}
    team = tuple(Robot(id=name, position=place, **body) for name, place in starts(count))  # type: ignore[arg-type]
    become_node("muster")
    heard = Heard()
    fleet = Ros1Fleet(Mission(robots=team, tasks=()), on_pose=heard.note)
    while fleet.robots_not_ready():
        time.sleep(0.05)
    rounds = math.ceil((windows + 1) * (window_s + 1) * SPEED_MPS / (4 * SIDE_M)) + 1
    corners = ((SIDE_M, 0.0), (SIDE_M, SIDE_M), (0.0, SIDE_M), (0.0, 0.0))
    for robot in team:
        x, y = robot.position[:2]
        fleet.ports[robot.id].send([Waypoint((x + a, y + b, 0.0)) for _ in range(rounds) for a, b in corners])
    time.sleep(2.0)  # all have set out
    for _ in range(windows):
        heard.taken()
        steered, cpu, begun = _driven(fleet), time.process_time(), time.monotonic()
        time.sleep(window_s)
        took, cpu = time.monotonic() - begun, time.process_time() - cpu
        latencies, lost = heard.taken()
        found = {
            "arrived_hz": len(latencies) / took,
            "lost": lost,
            "median_ms": 1000 * latencies[len(latencies) // 2],
            "late_ms": 1000 * latencies[len(latencies) * 99 // 100],
            "processor": cpu / took,
            "driven_m": (_driven(fleet) - steered) / count,
        }
        sys.stdout.write(json.dumps(found) + "\n")
        sys.stdout.flush()
    fleet.stop()
    fleet.close()
    leave()


def _driven(fleet: Any) -> float:
    return float(sum(port.telemetry().odometry_m for port in fleet.ports.values()))


def main(arguments: Sequence[str]) -> None:
    """Be the one or the other."""
    what, *numbers = arguments
    if what == "robots":
        robots(int(numbers[0]), float(numbers[1]))
    else:
        bridge(int(numbers[0]), int(numbers[1]), float(numbers[2]))


if __name__ == "__main__":
    main(sys.argv[1:])
