"""The settings of the fleets that ship: how robots are reached, and what they may do.

The command, mission control and Python read them alike. Imported by the command: no heavy module is imported.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from muster.mission.records import Settings, record, spec
from muster.mission.value_types import (
    Choice,
    Fault,
    Flag,
    JsonSchema,
    Number,
    Path,
    Share,
    Table,
    Text,
    Whole,
    refuse,
)
from muster.motion.avoidance_names import AUTO, AVOIDANCE
from muster_robots.custody_settings import CustodySettings
from muster_robots.profiles import PROFILES, profile_help, profiles_of

_POSES = r"(?=.*\{robot\})(?!.*\{robot\}.*\{robot\})/?(\{robot\}|[A-Za-z])(\w|\{robot\})*(/(\w|\{robot\})+)*"
_USUAL = {"frame": "map", "odometry": "map", "poses": ""}
_WAIT = Number(minimum=0.0, maximum=1e6)


@dataclass(frozen=True)
class _Name:
    """A text of a pattern, or an empty one."""

    filler: ClassVar[str] = ""
    pattern: str
    expected: str

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`."""
        fits = isinstance(value, str) and (not value or re.fullmatch(self.pattern, value, re.ASCII))
        return value if fits else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "string"}


class _Profiled(Settings):
    """Settings whose values a profile may give: a field that is not given has its profile's value, or the usual one."""

    ros: ClassVar[Literal["ros1", "ros2"]]
    usual: ClassVar[Mapping[str, Any]]

    @classmethod
    def settled(cls, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """See `Checked`."""
        profile = PROFILES.get(values.get("profile") or "")
        given = {**cls.usual, **({} if profile is None else profile.sets(cls.ros))}
        return {name: value for name, value in given.items() if values.get(name) is None}


@record
class RosSettings(_Profiled, CustodySettings):
    """Where robots on ROS are, and when they are waited for no longer."""

    namespace: str = spec(
        _Name(r"/*([A-Za-z]\w*(/\w+)*)?/*", "names such as team or lab/team: letters, digits, _"),
        "namespace that holds those of the robots; empty: the root",
        default="",
        metavar="NAME",
    )
    frame: str = spec(Text(), "the mission's frame, for tf; map without it", default=None, metavar="FRAME")
    odometry: Literal["map", "start"] = spec(
        Choice(("map", "start")),
        "odometry is in a frame that tf ties to the map, or in <robot>/odom, from the robot's start in the mission; "
        "map without it",
        default=None,
    )
    poses: str = spec(
        _Name(_POSES, "a topic such as /vrpn_client_node/{robot}/pose"),
        "where motion capture publishes poses, such as /vrpn_client_node/{robot}/pose; <robot>/pose without it",
        default=None,
        metavar="TOPIC",
    )
    wait_s: float = spec(_WAIT, "how long the mission's robots are waited for", default=10.0)
    known_only: bool = spec(Flag(), "robots that the mission does not name do not join", default=False)


@record
class Ros1Settings(RosSettings):
    """How robots on ROS 1 are reached and steered."""

    ros: ClassVar = "ros1"
    usual: ClassVar = {**_USUAL, "drive": "cmd_vel"}
    profile: str | None = spec(Choice(profiles_of("ros1")), profile_help("ros1"), default=None)
    master: str | None = spec(
        Text(), "the ROS master; ROS_MASTER_URI, or localhost, without it", default=None, metavar="URI"
    )
    drive: Literal["cmd_vel", "goals", "move_base", "move_base_simple"] = spec(
        Choice(("cmd_vel", "goals", "move_base", "move_base_simple")),
        "what robots take: velocities, or goals to which they find their way themselves: on WP, of the action "
        "move_base, or on move_base_simple/goal; cmd_vel without it",
        default=None,
    )
    arrival_m: float = spec(
        Number(minimum=0.001, maximum=100.0), "distance to a way point at which it counts as reached", default=0.1
    )
    rate_hz: float = spec(Number(minimum=1.0, maximum=200.0), "rate at which velocities are sent", default=20.0)
    avoidance: str = spec(
        Choice(AVOIDANCE),
        "how robots that take velocities pass each other; auto: by orca; rvo, hrvo and avo in the plane",
        default=AUTO,
    )

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> list[Fault]:
        """Refuse avoidance for robots that find their way themselves."""
        avoidance = values.get("avoidance", AUTO)
        drive = values.get("drive") or "cmd_vel"
        if drive != "cmd_vel" and avoidance not in (AUTO, "orca"):
            return [Fault(("avoidance",), avoidance, f"auto with drive {drive}: robots find their way themselves")]
        return []


@record
class Ros2Settings(RosSettings):
    """How robots on ROS 2 are reached."""

    ros: ClassVar = "ros2"
    usual: ClassVar = {**_USUAL, "give": "goals"}
    profile: str | None = spec(Choice(profiles_of("ros2")), profile_help("ros2"), default=None)
    domain: int | None = spec(
        Whole(maximum=232), "domain of ROS 2; ROS_DOMAIN_ID, or 0, without it", default=None, metavar="N"
    )
    give: Literal["goals", "nav2"] = spec(
        Choice(("goals", "nav2")),
        "how goals are sent: on goal_pose, or by Nav2's action navigate_to_pose; goals without it",
        default=None,
    )
    use_sim_time: bool = spec(
        Flag(), "the mission goes by /clock, as the robots' nodes with this parameter do", default=False
    )
    by: Literal["dds", "rclpy"] | None = spec(
        Choice(("dds", "rclpy")), "the middleware; rclpy if it can be imported, or dds, without it", default=None
    )
    arrival_m: float = spec(
        Number(minimum=0.001, maximum=100.0), "distance to a way point at which it counts as reached", default=0.25
    )


@record
class FlightSettings(CustodySettings):
    """What Muster may command drones over MAVLink, and its limits."""

    arm: bool = spec(
        Flag(), "arm and fly; without it nothing is sent but heartbeats and requests for telemetry", default=False
    )
    offboard: bool = spec(
        Flag(),
        "send way points one by one (PX4: offboard, ArduPilot: guided) instead of uploading missions",
        default=False,
    )
    local_frame: Literal["north", "forward"] = spec(
        Choice(("north", "forward")),
        "with offboard and no origin: what a drone calls north is north, or forward at power-up (no compass)",
        default="north",
    )
    lowest_m: float = spec(
        Number(above=0.0),
        "height above home below which no way point is flown; lower ones are flown there",
        default=2.0,
        option="",
    )
    accept_m: float = spec(
        Number(above=0.0), "distance to a way point at which it counts as reached", default=1.0, option=""
    )
    low_battery: float = spec(
        Share(above=0.0, below=1.0), "battery level below which a drone returns", unit="share", default=0.25
    )
    link_lost_s: float = spec(  # PX4 itself does nothing before (COM_DL_LOSS_T)
        Number(above=0.0),
        "time without any message after which a drone is silent; shorter gaps change nothing",
        default=10.0,
    )
    settled_s: float = spec(  # heartbeats come once a second
        Number(above=0.0), "how long a drone that was silent, or in other hands, must do what is wanted", default=3.0
    )
    far_m: float = spec(
        Number(above=0.0), "how far from its start in the mission a drone may stand", default=20.0, option=""
    )


@record
class MavlinkSettings(FlightSettings):
    """How drones are reached over MAVLink, and how they fly."""

    endpoints: Mapping[str, str] = spec(
        Table(Text(), "a mapping from each robot to its endpoint, such as udp:0.0.0.0:14550"),
        "how each robot is reached: udp:HOST:PORT (listens), udpout:HOST:PORT or tcp:HOST:PORT (call), "
        "serial:DEVICE[:BAUD]; #SYSTEM "
        "after it, of several on it",
        option="--endpoint",
        metavar="ROBOT=ENDPOINT",
    )
    height_m: float | None = spec(
        Number(minimum=0.5, maximum=500.0), "height of flight above home, for a mission in the plane", default=None
    )
    wait_s: float = spec(_WAIT, "how long answers of drones are waited for", default=10.0)
    at_end: Literal["hold", "return", "land"] = spec(
        Choice(("hold", "return", "land")),
        "what drones do when all is done; return and land wait until they have landed",
        default="hold",
    )
