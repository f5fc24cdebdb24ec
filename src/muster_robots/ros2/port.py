"""The port of a robot on ROS 2: receives its poses and sends one goal after the other.

| topic | type | |
|---|---|---|
| `<robot>/pose` | PoseStamped | where it is |
| `<robot>/odom` | Odometry | where it is, or where it went since the last pose |
| `<robot>/amcl_pose` | PoseWithCovarianceStamped | ties odometry to the map; its navigation's feedback does so too |
| `/tf`, `<robot>/tf` | TFMessage | where its body is, if nothing else says so |

Which of them counts `localisation` decides. In pose topics of others both types of poses count.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.mission.model import Robot
from muster.mission.values.ranges import require_positive
from muster.motion.frames import Floats, angles, flu_to_enu, pose_of, pose_transform, quaternion_rotation
from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.custody import CustodyLimits, Holder, Wants
from muster_robots.follower import Follower
from muster_robots.localisation import Localisation
from muster_robots.pose_custody import PoseCustody
from muster_robots.pose_port import goal_heading, require_finite, velocity_by
from muster_robots.ros2.goals import Goals
from muster_robots.ros2.map_frame import MAP_FRAME, RobotFrames
from muster_robots.ros2.message_types import (
    Header,
    Odometry,
    Point,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    Time,
    Vector3,
)
from muster_robots.ros2.middleware import Middleware
from muster_robots.tied_frames import TiedFrames

_OTHERS = ("odom", "amcl_pose")
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
    pose_topic
        where its pose is published, if not on `<robot>/pose`: by a motion capture system.
    stamp
        seconds of ROS' time, for the stamps of goals.
    limits
        those of its custody.
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
        pose_topic: str | None = None,
        stamp: Callable[[], float] = time.time,
        limits: CustodyLimits | None = None,
    ) -> None:
        self.body, self.topics, self.goals, self._flat, self._clock = robot, topics, goals, flat, clock
        self._stamp = stamp
        near = {"arrival_m": arrival.near_m, "turned_rad": arrival.turned_rad}
        self._follower = Follower(**near, flat=flat or robot.kind == "ground")
        self._where = {"pose": pose_topic or f"{topics}/pose"} | {name: f"{topics}/{name}" for name in _OTHERS}
        self._poses = middleware.reader(self._where["pose"], PoseStamped)
        self._unsure = {
            name: middleware.reader(self._where[name], PoseWithCovarianceStamped) for name in ("pose", "amcl_pose")
        }
        self._odometry = middleware.reader(self._where["odom"], Odometry)
        self._said: Telemetry | None = None
        shared = TiedFrames(MAP_FRAME) if frames is None else frames
        self._frames = RobotFrames(middleware, topics, shared)
        self._localisation = Localisation(self._frames)
        self.custody = PoseCustody(robot.id, limits or CustodyLimits(), goals.expected, lambda: goals.ready)
        self._withheld = False  # whether a goal waits for that
        self._height = 0.0
        self._refused = ""
        self.is_to_stay = False  # and was not told yet

    @property
    def robot(self) -> str:
        return self.body.id

    @property
    def missing(self) -> str:
        """What is missing of what it takes to drive it, and what is expected; empty if nothing is."""
        if self._said is None:
            return self._localisation.untied or f"nothing on {' or '.join(self._where.values())}"
        return self.goals.unfit or self.custody.missing

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
        may_be_told = self.custody.want(self._clock(), goes=bool(waypoints))
        self._refused, self.is_to_stay = "", may_be_told and not waypoints
        if waypoints:
            self._speak()
        elif may_be_told:
            self._take_in(self._clock())
            self._let_stay()
        return order

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self.custody.judged(self._said)

    def hear(self) -> bool:
        """Take in what has come, and give the next goal where one is reached; returns whether one was passed."""
        now = self._clock()
        if foreign := self.goals.foreign:
            self._leave(foreign)
        under_way = self._follower.aim is not None and not self._follower.stays
        ended = self.goals.hear(now, under_way=under_way)
        if ended is not None and under_way:
            if ended.by_others:
                self._leave(ended.reason)
            elif ended.reason:
                self._refused = ended.reason
            else:
                self._follower.arrive(now)
        heard = self._take_in(now)
        passed = self._follower.wait(now) or heard
        if self._said is not None and (passed or ended is not None):
            order, count = self._follower.order, self._follower.passed
            self._said = replace(self._said, order=order, passed=count, refused=self._refused)
        again = self._look(now)
        if passed or again is Wants.ORDER or (self._withheld and self._said is not None):
            self._speak()
        if self.goals.reports and self.goals.at_rest and self.custody.moves_by_others:
            self._leave("it moves by no goal of Muster's")
        elif self.is_to_stay or again is Wants.HOLD:
            self._let_stay()
        return passed

    def _look(self, now: float) -> Wants | None:
        """What it is to be told again, by its poses, and by what its navigation says."""
        follower = self._follower
        is_done = follower.aim is None or follower.stays or bool(self._refused)
        return self.custody.look(now, is_carried_out=is_done or not self.goals.at_rest)

    def _leave(self, why: str) -> None:
        """Leave it to somebody else, who has it, and note that again for as long as it is so."""
        if not self.custody.is_taken:
            self.goals.leave()
        self.custody.take(self._clock(), Holder.STATION, why)
        self.is_to_stay = False

    def _let_stay(self) -> None:
        """Make its position its goal; a silent robot keeps its goal until a pose arrives."""
        said = self._said
        lost = said is None or self._clock() - said.time_s > _FRESH_S
        here = None if said is None or lost else self._stamped(said.position, said.heading)
        self.is_to_stay = not self.goals.withdraw(here)
        if not self.is_to_stay:
            self.custody.told(self._clock())

    def _take_in(self, now: float) -> bool:
        """Where it has said that it is; returns whether it has passed a way point with that."""
        moved = self._frames.bodies(now)
        passed = [self._take_odometry(odometry, now) for odometry in self._odometry.take()]
        where, fixes = self._where["pose"], self._where["amcl_pose"]
        pose, fix = self._localisation.pose, self._localisation.fix
        found = [(pose, where, said.header, said.pose) for said in self._poses.take()]
        found += [(pose, where, said.header, said.pose.pose) for said in self._unsure["pose"].take()]
        found += [(fix, fixes, said.header, said.pose.pose) for said in self._unsure["amcl_pose"].take()]
        found += [(fix, self.goals.feedback, said.header, said.pose) for said in self.goals.poses()]
        for judge, topic, header, told in found:
            matrix = _matrix(told)
            if matrix is not None:
                passed.append(self._count(judge(now, topic, header.frame_id, matrix), now))
        passed += [self._count(self._localisation.body(now, *body), now) for body in moved]
        return any(passed)

    def _take_odometry(self, odometry: Odometry, now: float) -> bool:
        """Who is localised does not go by odometry, as long as that lasts."""
        matrix = _matrix(odometry.pose.pose)
        if matrix is None:
            return False
        there = self._localisation.odometry(now, self._where["odom"], odometry.header.frame_id, matrix)
        return self._count(there, now, odometry.twist.twist.linear)

    def _count(self, there: Floats | None, now: float, ahead: Vector3 | None = None) -> bool:
        """Take in a pose on the map, with the body's velocity where that is said."""
        if there is None:
            return False
        x, y, z, _, _, heading = map(float, pose_of(there))
        if ahead is None:
            return self._is_at((x, y, z), heading, now, None)
        east, north, up = flu_to_enu([ahead.x, ahead.y, ahead.z], heading).tolist()
        return self._is_at((x, y, z), heading, now, (east, north, up))

    def _is_at(self, place: Place, heading: float, now: float, velocity: Place | None) -> bool:
        """It is there; returns whether it has passed a way point with that."""
        follower = self._follower
        self._height = place[2]
        place = (*place[:2], 0.0) if self._flat else place
        passed = follower.hear(now, place, heading)
        self.custody.hear(now, place, heading)
        speed = velocity_by(self._said, place, now) if velocity is None else velocity
        counted = follower.odometry_m, follower.order, follower.passed
        self._said = Telemetry(now, place, heading, speed, *counted, refused=self._refused)
        return passed

    def _speak(self) -> None:
        """Give the way point to which it is to go; its heading, where none is wanted, is that of the way there.

        A robot that says where it is in a frame that is not tied to the map gets none until it is tied.
        """
        aim = self._follower.aim
        self._withheld = self._said is None and bool(self._localisation.untied)
        if aim is None or self._withheld or self.custody.is_taken:
            return
        self.goals.give(self._stamped(aim.position, goal_heading(aim, self._said)))

    def _stamped(self, place: Place, heading: float) -> PoseStamped:
        x, y, z = map(float, place)
        turn = Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))
        header = Header(stamp=Time.of(self._stamp()), frame_id=self._frames.name)
        return PoseStamped(header, Pose(Point(x, y, self._height if self._flat else z), turn))


def _matrix(pose: Pose) -> Floats | None:
    """A level pose (4, 4); None where it is no numbers."""
    place, heading = (pose.position.x, pose.position.y, pose.position.z), yaw_of(pose.orientation)
    return pose_transform((*place, 0.0, 0.0, heading)) if all(map(math.isfinite, (*place, heading))) else None


def yaw_of(turn: Quaternion) -> float:
    """The heading that a rotation has, radians; 0 of one that is none."""
    values = np.array([turn.x, turn.y, turn.z, turn.w])
    return float(angles(quaternion_rotation(values))[2]) if np.linalg.norm(values) > 0 else 0.0
