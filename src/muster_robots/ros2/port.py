"""The port of a robot on ROS 2: receives its poses and sends one goal after the other.

| topic | type | |
|---|---|---|
| `<robot>/pose` | PoseStamped | where it is; its navigation's feedback says so too |
| `<robot>/odom` | Odometry | where it went from there, once poses have stopped; without any, where it is |

A pose counts if its frame is tied to the map (`tied_frames`); odometry counts also if a pose that counts has tied it.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.mission.model import Robot
from muster.mission.values.ranges import require_positive
from muster.motion.frames import angles, flu_to_enu, pose_of, pose_transform, quaternion_rotation
from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.follower import Follower
from muster_robots.pose_port import goal_heading, require_finite, velocity_by
from muster_robots.ros2.goals import Goals
from muster_robots.ros2.map_frame import MAP_FRAME
from muster_robots.ros2.message_types import Header, Odometry, Point, Pose, PoseStamped, Quaternion, Time
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.odometry_tracking import OdometryTracking
from muster_robots.tied_frames import TiedFrames

_FRESH_S = 0.5
"""Who said for longer not where it is, is elsewhere by now: that place is none to stay at."""


@dataclass(frozen=True, kw_only=True)
class Arrival:
    """When a robot is where it was sent: so near, metres, and where a heading was wanted, so well turned, radians.

    Raises
    ------
    ParameterError
        if one of them is not above 0.
    """

    near_m: float = 0.25
    turned_rad: float = 0.35

    def __post_init__(self) -> None:
        require_positive(near_m=self.near_m, turned_rad=self.turned_rad)


class Ros2Port:
    """One robot: a `RobotPort`.

    Parameters
    ----------
    topics
        its namespace, such as `/r_0`.
    goals
        how it is told where to go.
    flat
        whether the mission is in the plane: heights are then the robot's own affair.
    clock
        seconds of the mission's.
    frames
        which frames are tied to the map; None: the map's alone.
    """

    def __init__(
        self,
        robot: Robot,
        middleware: Middleware,
        topics: str,
        goals: Goals,
        arrival: Arrival,
        *,
        flat: bool,
        clock: Callable[[], float],
        frames: TiedFrames | None = None,
    ) -> None:
        self.body, self.topics, self.goals, self._flat, self._clock = robot, topics, goals, flat, clock
        near = {"arrival_m": arrival.near_m, "turned_rad": arrival.turned_rad}
        self._follower = Follower(**near, flat=flat or robot.kind == "ground")
        self._poses = middleware.reader(f"{topics}/pose", PoseStamped)
        self._odometry = middleware.reader(f"{topics}/odom", Odometry)
        self._said: Telemetry | None = None
        self._odometry_tracking = OdometryTracking()
        self._frames = TiedFrames(MAP_FRAME) if frames is None else frames
        self._untied = ""  # a frame in which poses are given that nothing ties to the map
        self._withheld = False  # whether a goal waits for that
        self._height = 0.0
        self._refused = ""
        self.is_to_stay = False  # and was not told yet

    @property
    def robot(self) -> str:
        return self.body.id

    @property
    def missing(self) -> str:
        """What is not there of what it needs; empty if all is."""
        if self._said is None and self._untied:
            return self._frames.untied(self._untied)
        if self._said is None:
            return f"nothing on {self.topics}/pose or {self.topics}/odom"
        return "" if self.goals.ready else f"no server of {self.topics}/navigate_to_pose"

    @property
    def at_rest(self) -> bool:
        """Whether all was sent, and no goal is known to be under way."""
        return self.goals.at_rest and not self.is_to_stay

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`.

        Raises
        ------
        ParameterError
            if a number of a way point is not finite.
        """
        require_finite(self.robot, waypoints)
        order = self._follower.take(waypoints)
        self._refused, self.is_to_stay = "", not waypoints
        if waypoints:
            self._speak()
        else:
            self._take_in(self._clock())
            self._let_stay()
        return order

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self._said

    def hear(self) -> bool:
        """Take in what has come, and give the next goal where one is reached; returns whether one was passed."""
        now = self._clock()
        under_way = self._follower.aim is not None and not self._follower.stays
        ended = self.goals.hear(now, under_way=under_way)
        if ended is not None and under_way:
            self._refused = ended.reason
            if not ended.reason:
                self._follower.arrive(now)
        heard = self._take_in(now)
        passed = self._follower.wait(now) or heard
        if self._said is not None and (passed or ended is not None):
            order, count = self._follower.order, self._follower.passed
            self._said = replace(self._said, order=order, passed=count, refused=self._refused)
        if passed or (self._withheld and self._said is not None):
            self._speak()
        if self.is_to_stay:
            self._let_stay()
        return passed

    def _let_stay(self) -> None:
        """Make its position its goal; a silent robot keeps its goal until a pose arrives."""
        said = self._said
        lost = said is None or self._clock() - said.time_s > _FRESH_S
        here = None if said is None or lost else self._stamped(said.position, said.heading)
        self.is_to_stay = not self.goals.withdraw(here)

    def _take_in(self, now: float) -> bool:
        """Where it has said that it is; returns whether it has passed a way point with that."""
        passed = [self._take_odometry(odometry, now) for odometry in self._odometry.take()]
        passed += [self._take_pose(pose, now) for pose in (*self._poses.take(), *self.goals.poses())]
        return any(passed)

    def _take_pose(self, pose: PoseStamped, now: float) -> bool:
        found = self._on_map(pose.header, pose.pose)
        if found is None:
            return False
        self._odometry_tracking.tie(now, *found)
        return self._is_at(*found, now, None)

    def _take_odometry(self, odometry: Odometry, now: float) -> bool:
        """Who is localised does not go by odometry, as long as that lasts."""
        found = _place_and_heading(odometry.pose.pose)
        if found is None:
            return False
        there = self._odometry_tracking.reckon(now, *found)
        if not self._odometry_tracking.is_tied:
            there = self._on_map(odometry.header, odometry.pose.pose)
        if there is None:
            return False
        linear = odometry.twist.twist.linear
        x, y, z = flu_to_enu([linear.x, linear.y, linear.z], there[1]).tolist()
        return self._is_at(*there, now, (x, y, z))

    def _on_map(self, header: Header, pose: Pose) -> tuple[Place, float] | None:
        """Return place and heading on the map; None if they are no numbers, or nothing ties their frame to the map."""
        found = _place_and_heading(pose)
        if found is None:
            return None
        place, heading = found
        matrix = self._frames.to_map(header.frame_id, pose_transform((*place, 0.0, 0.0, heading)))
        self._untied = header.frame_id if matrix is None else ""
        if matrix is None:
            return None
        x, y, z, _, _, turned = map(float, pose_of(matrix))
        return (x, y, z), turned

    def _is_at(self, place: Place, heading: float, now: float, velocity: Place | None) -> bool:
        """It is there; returns whether it has passed a way point with that."""
        follower = self._follower
        self._height = place[2]
        place = (*place[:2], 0.0) if self._flat else place
        passed = follower.hear(now, place, heading)
        speed = velocity_by(self._said, place, now) if velocity is None else velocity
        counted = follower.odometry_m, follower.order, follower.passed
        self._said = Telemetry(now, place, heading, speed, *counted, refused=self._refused)
        return passed

    def _speak(self) -> None:
        """Give the way point to which it is to go; its heading, where none is wanted, is that of the way there.

        A robot that says where it is in a frame that is not tied to the map gets none until it is tied.
        """
        aim = self._follower.aim
        self._withheld = self._said is None and bool(self._untied)
        if aim is None or self._withheld:
            return
        self.goals.give(self._stamped(aim.position, goal_heading(aim, self._said)))

    def _stamped(self, place: Place, heading: float) -> PoseStamped:
        x, y, z = map(float, place)
        turn = Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))
        header = Header(stamp=Time.of(time.time()), frame_id=MAP_FRAME)
        return PoseStamped(header, Pose(Point(x, y, self._height if self._flat else z), turn))


def _place_and_heading(pose: Pose) -> tuple[Place, float] | None:
    """Metres and radians; None where they are no numbers."""
    place, heading = (pose.position.x, pose.position.y, pose.position.z), yaw_of(pose.orientation)
    return (place, heading) if all(map(math.isfinite, (*place, heading))) else None


def yaw_of(turn: Quaternion) -> float:
    """The heading that a rotation has, radians; 0 of one that is none."""
    values = np.array([turn.x, turn.y, turn.z, turn.w])
    return float(angles(quaternion_rotation(values))[2]) if np.linalg.norm(values) > 0 else 0.0
