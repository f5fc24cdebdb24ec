"""Topics that the controller publishes for other nodes: all of it JSON in std_msgs/String.

`/muster/status`, `/muster/mission`, `/muster/plan` and `/muster/robots` are latched, for nodes that come late.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry
from muster_robots.ros1.message_conversion import text_of
from muster_robots.ros1.mission_transfer import packed
from muster_robots.ros1.node import publish
from muster_robots.ros1.ros import String, rospy

_ACTIVITIES = {
    "sets_out": "driving",
    "arrives": "waiting",
    "starts": "working",
    "ends": "idle",
    "returns": "returning",
    "robot_at_end": "idle",
    "no_way_to_end": "idle",
    "robot_fails": "out",
    "robot_silent": "out",
    "robot_suspended": "out",
    "robot_stuck": "out",
    "robot_removed": "out",
    "robot_moved": "idle",
    "robot_returns": "idle",
    "robot_joins": "idle",
    "task_refused": "idle",
}
"""What a robot does after an event of this kind."""
_STATUS_EVERY_S = 1.0
"""Seconds of the mission's clock after which the status is published again."""


class MissionTopics:
    """A `Recorder`, and the place of the latched topics.

    Attributes
    ----------
    now_s
        the mission's clock when it was told last.
    """

    def __init__(self) -> None:
        self._topics = {
            name: rospy.Publisher(f"/muster/{name}", String, queue_size=100, latch=name != "events")
            for name in ("status", "mission", "plan", "robots", "events")
        }
        self.now_s, self._done = 0.0, 0
        self._status: dict[str, Any] = {}
        self._status_s = -math.inf  # when it was published last, by the mission's clock
        self._robots: dict[str, dict[str, str]] = {}

    def publish_mission(self, mission: Mission) -> None:
        """Tell which is to be carried out next."""
        self._say("mission", packed(mission))
        self.now_s, self._done, self._status_s = 0.0, 0, -math.inf
        self._robots = {robot.id: {"activity": "idle"} for robot in mission.robots}
        self._say("robots", self._robots)

    def publish_status(self, state: str, mission: str, time_s: float | None, reason: str = "") -> None:
        """What the whole is doing, since when on the mission's clock, and why if something is wrong."""
        self._status = {"state": state, "mission": mission}
        if time_s is not None:
            self._status["time_s"] = time_s
        if reason:
            self._status["reason"] = reason
        self._publish_status()

    def refuse(self, reason: str) -> None:
        """Publish the event that a request was refused."""
        self._say("events", {"kind": "event_refused", "reason": reason})

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Observer`: the mission planner publishes it."""
        self._say("plan", {"time_s": round(now, 3), "plan": plan.as_dict()})

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Observer`: what happened, and what a robot does from then on."""
        self._say("events", {"time_s": round(now, 3), "kind": kind, **data})
        robot = data.get("robot")
        robot = robot.get("id") if isinstance(robot, Mapping) else robot
        stays_out = kind == "robot_moved" and self._robots.get(str(robot), {}).get("activity") == "out"
        if robot is not None and kind in _ACTIVITIES and not stays_out:
            task = {"task": str(data["task"])} if kind in ("sets_out", "arrives", "starts") and "task" in data else {}
            for name in data.get("team") or [robot]:
                self._robots[name] = {"activity": _ACTIVITIES[kind], **task}
            self._say("robots", self._robots)
        elif kind == "waits_in_traffic":
            self._robots[str(robot)]["held_up_by"] = str(data["waits_for"])
            self._say("robots", self._robots)
        elif kind == "goes_on" and self._robots[str(robot)].pop("held_up_by", ""):
            self._say("robots", self._robots)
        if kind == "ends":
            self._done += 1
            self._advance_status(now)

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """See `Observer`: the system monitor subscribes to robots itself."""

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """See `Recorder`: where robots are is in what they say."""
        self.now_s = now
        if now >= self._status_s + _STATUS_EVERY_S:
            self._advance_status(now)

    def on_report(self, report: Mapping[str, Any]) -> None:
        """See `Recorder`: the figures are printed."""

    def _advance_status(self, now: float) -> None:
        """Publish the status with the time that has come and the tasks that are done by now."""
        self.now_s = now
        if "time_s" in self._status:
            self._status["time_s"] = now
            self._publish_status()

    def _publish_status(self) -> None:
        status = self._status | {"tasks_done": self._done}
        if "time_s" in status:
            self._status_s, status["time_s"] = status["time_s"], round(status["time_s"], 3)
        self._say("status", status)

    def _say(self, topic: str, data: Any) -> None:
        publish(self._topics[topic], text_of(data))
