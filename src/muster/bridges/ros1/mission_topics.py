"""What the controller says to other nodes while a mission is carried out: all of it JSON in std_msgs/String.

`/muster/status`, `/muster/mission`, `/muster/plan` and `/muster/robots` are latched, for nodes that come late.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.bridges.ros1.message_conversion import text_of
from muster.bridges.ros1.mission_transfer import packed
from muster.bridges.ros1.node import publish
from muster.bridges.ros1.ros import String, rospy
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.motion.port import Telemetry

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
    "robot_stuck": "out",
    "robot_returns": "idle",
    "robot_joins": "idle",
    "task_refused": "idle",
}
"""What a robot does after an event of this kind."""


class Board:
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
        self._robots: dict[str, dict[str, str]] = {}

    def show_mission(self, mission: Mission) -> None:
        """Tell which is to be carried out next."""
        self._say("mission", packed(mission))
        self.now_s, self._done = 0.0, 0
        self._robots = {robot.id: {"activity": "idle"} for robot in mission.robots}
        self._say("robots", self._robots)

    def show_status(self, state: str, mission: str, time_s: float | None, reason: str = "") -> None:
        """What the whole is doing, since when on the mission's clock, and why if something is wrong."""
        status: dict[str, Any] = {"state": state, "mission": mission, "tasks_done": self._done}
        if time_s is not None:
            status["time_s"] = round(time_s, 3)
        if reason:
            status["reason"] = reason
        self._say("status", status)

    def refuse(self, reason: str) -> None:
        """Tell whoever hears events that something asked for was refused."""
        self._say("events", {"kind": "event_refused", "reason": reason})

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Observer`: the mission planner publishes it."""
        self._say("plan", {"time_s": round(now, 3), "plan": plan.as_dict()})

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Observer`: what happened, and what a robot does from then on."""
        self._say("events", {"time_s": round(now, 3), "kind": kind, **data})
        robot = data.get("robot")
        robot = robot.get("id") if isinstance(robot, Mapping) else robot
        if robot is not None and kind in _ACTIVITIES:
            task = {"task": str(data["task"])} if kind in ("sets_out", "arrives", "starts") and "task" in data else {}
            self._robots[robot] = {"activity": _ACTIVITIES[kind], **task}
            self._say("robots", self._robots)
        self._done += kind == "ends"

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """See `Observer`: the system monitor hears robots itself."""

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """See `Recorder`: where robots are is in what they say."""
        self.now_s = now

    def on_report(self, report: Mapping[str, Any]) -> None:
        """See `Recorder`: the figures are printed."""

    def _say(self, topic: str, data: Any) -> None:
        publish(self._topics[topic], text_of(data))
