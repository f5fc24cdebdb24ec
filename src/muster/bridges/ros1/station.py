"""The thesis' high-level controller on ROS: command_interface, system_monitor, mission_planner (TCF, Table 5.1).

Three duties of one node, each a namespace of its own: rospy has one node a process. All messages are std_msgs/String
with JSON, all services std_srvs/Trigger. It watches the executor as its observer.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

from muster.bridges.ros1.described import task_of
from muster.bridges.ros1.fleet import Ros1Fleet
from muster.bridges.ros1.messages import text_of
from muster.bridges.ros1.ros import String, Trigger, TriggerResponse, rospy
from muster.mission.errors import MissionError
from muster.mission.model import Event, Mission
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
_MONITOR_S = 0.5


class Station:
    """Topics and services beside a fleet.

    Parameters
    ----------
    halt
        set by `command_interface/cancel`.
    started
        set by `command_interface/start`.
    """

    def __init__(self, mission: Mission, fleet: Ros1Fleet, *, halt: threading.Event, started: threading.Event) -> None:
        self._mission, self._fleet, self._halt, self._started = mission, fleet, halt, started
        self._activities = {robot.id: ("idle", "") for robot in mission.robots}
        self._said: dict[str, Telemetry] = {}
        self._done = 0
        self._monitored_s = -_MONITOR_S
        self._publishers: dict[str, Any] = {}  # by full name (TCF, Figure 5.7, step 5)
        self._lock = threading.Lock()
        self._state = "waiting"
        self._asked = [
            rospy.Service("/command_interface/start", Trigger, self._service(self._start)),
            rospy.Service("/command_interface/pause", Trigger, self._service(self._pause)),
            rospy.Service("/command_interface/cancel", Trigger, self._service(self._cancel)),
            rospy.Subscriber("/command_interface/add_task", String, self._add_task, queue_size=100),
        ]
        self.become("waiting")

    def become(self, state: str) -> None:
        """Say what the whole is doing: waiting, carrying-out, paused, ended."""
        self._state = state
        status = {"state": state, "mission": self._mission.name, "time_s": round(self._fleet.time_s, 3)}
        self._say("/muster/status", status | {"tasks_done": self._done})

    def on_plan(self, now: float, plan: Plan) -> None:
        """mission_planner: the task sequence of each robot."""
        routes = {route.robot: list(route.tasks) for route in plan.routes}
        self._say("/mission_planner/plan", {"time_s": round(now, 3), "task_sequences": routes})
        for robot, tasks in routes.items():
            self._say(self._fleet.topics(robot) + "/task_sequence", tasks)

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """What happened, and what a robot does from then on."""
        self._say("/muster/events", {"time_s": round(now, 3), "kind": kind, **data}, latch=False)
        self._done += kind == "ends"
        robot = data.get("robot")
        robot = robot.get("id") if isinstance(robot, Mapping) else robot
        if robot is not None and kind in _ACTIVITIES:
            task = str(data.get("task", "")) if kind in ("sets_out", "arrives", "starts") else ""
            self._activities[robot] = (_ACTIVITIES[kind], task)
            self._say(self._fleet.topics(robot) + "/status", self._row(robot))
        if kind in ("ends", "mission_ended"):
            self.become("ended" if kind == "mission_ended" else self._state)

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """system_monitor: pose, usage and availability, now and then."""
        self._said[robot] = telemetry
        if now - self._monitored_s >= _MONITOR_S:
            self._monitored_s = now
            rows = [self._row(name) for name in self._activities]
            self._say("/system_monitor/robots", rows)
            for row in rows:
                self._say(self._fleet.topics(row["robot"]) + "/status", row)

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """Where robots are is in what they say."""

    def on_report(self, report: Mapping[str, Any]) -> None:
        """The figures are printed."""

    def close(self) -> None:
        """Take services and topics back."""
        self._asked[-1].unregister()
        for service in self._asked[:-1]:
            service.shutdown()

    def _row(self, robot: str) -> dict[str, Any]:
        activity, task = self._activities[robot]
        said = self._said.get(robot)
        row: dict[str, Any] = {"robot": robot, "available": activity in ("idle", "returning"), "activity": activity}
        if task:
            row["task"] = task
        if said is not None:
            row |= {"position": [round(c, 4) for c in said.position], "heading": round(said.heading, 4)}
            row |= {"odometry_m": round(said.odometry_m, 3), "heard_s": round(said.time_s, 3)}
        return row

    def _say(self, topic: str, data: Any, *, latch: bool = True) -> None:
        with self._lock:
            if topic not in self._publishers:
                self._publishers[topic] = rospy.Publisher(topic, String, queue_size=100, latch=latch)
            self._publishers[topic].publish(text_of(data))

    def _service(self, do: Callable[[], str]) -> Callable[[Any], Any]:
        return lambda request: TriggerResponse(success=True, message=do())

    def _start(self) -> str:
        """Begin, or go on after a pause."""
        self._started.set()
        if self._fleet.clock.paused:
            self._fleet.resume()
            self.become("carrying-out")
        return self._state

    def _pause(self) -> str:
        self._fleet.pause()
        self.become("paused")
        return self._state

    def _cancel(self) -> str:
        self._halt.set()
        self._started.set()
        return "cancelled"

    def _add_task(self, message: Any) -> None:
        try:
            self._fleet.report(Event(at_s=self._fleet.time_s, new_task=task_of(message.data)))
        except MissionError as error:
            self._say("/muster/events", {"kind": "event_refused", "reason": str(error)}, latch=False)
