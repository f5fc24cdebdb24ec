"""The node `/mission_planner`: allocates tasks, and publishes each robot's task sequence ([tcf-thesis], Table 5.1, 3).

It plans for the controller, and for whoever calls the service `mission_planner/plan` (std_srvs/Trigger). Latched topics
`mission_planner/plan` and `<robot>/task_sequence` (std_msgs/String with JSON) hold the plan that was made last, those
of re-allocation included, which the controller makes.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.mission.value_types import shown
from muster_robots.ros1.heard_robots import robots_heard
from muster_robots.ros1.message_conversion import text_of
from muster_robots.ros1.mission_transfer import Load, in_lines, mission_on, unpacked
from muster_robots.ros1.node import hear, publish
from muster_robots.ros1.requests import PLANNING, Data, RequestServer
from muster_robots.ros1.ros import String, Trigger, TriggerResponse, rospy

MISSION = "/mission_planner/mission"
_UNDER_WAY = ("gathering", "planning", "carrying-out", "paused")

OPTIONS = "/mission_planner/planning"
Solve = Callable[[Mission, Mapping[str, Any]], Plan]
"""Muster's own planner: of a mission, with planning options as plain data."""


class MissionPlanner:
    """Plans from when it is made; this process is a node by then.

    Parameters
    ----------
    load, solve
        Muster's loader of mission files, and its planner.
    topics
        the namespace of a robot's topics.
    options
        of the plans that users ask for; those of the parameter `/mission_planner/planning` come before them.
    """

    def __init__(self, load: Load, solve: Solve, *, topics: Callable[[str], str], options: Mapping[str, Any]) -> None:
        self._load, self._solve, self._topics, self._options = load, solve, topics, options
        self._heard: dict[str, Any] = {}  # what other nodes said last, by topic
        self._lock = threading.Lock()
        self._publishers: dict[str, Any] = {}  # by full name (TCF, Figure 5.7, step 5)
        self._say("/mission_planner/plan", None)
        self._subscribers = [
            hear(topic, String, self._hear, callback_args=topic, queue_size=10)
            for topic in ("/muster/mission", "/muster/status", "/system_monitor/robots", "/muster/plan")
        ]
        self._answers = RequestServer(PLANNING, self._answer)
        self._service = rospy.Service("/mission_planner/plan", Trigger, self._plan_for_user)

    def _hear(self, message: Any, topic: str) -> None:
        self._heard[topic] = said = json.loads(message.data)
        if topic == "/muster/plan":
            self._publish(plan_from(said["plan"], "/muster"), said["time_s"])

    def _answer(self, question: Data) -> Data:
        """To the controller, which lets robots know of the plan when they begin it."""
        try:
            mission = unpacked(question["mission"])
            plan = self._solve(mission, _with_parameter(question["options"]))
        except MusterError as error:
            return {"fault": str(error)}
        return {"plan": plan.as_dict()}

    def _plan_for_user(self, request: Any) -> Any:
        state = self._heard.get("/muster/status", {}).get("state")
        if state in _UNDER_WAY:
            told = f"a mission is {state}; expected none under way: its plan is the one that robots have"
            return TriggerResponse(success=False, message=told)
        try:
            mission, placed = self._from_where_they_stand(self._asked_for())
            plan = self._solve(mission, _with_parameter(self._options))
        except MusterError as error:
            return TriggerResponse(success=False, message=in_lines(error))
        self._publish(plan, 0.0)
        tasks = sum(len(route.tasks) for route in plan.routes)
        told = f"mission {mission.name}: {tasks} of {len(mission.tasks)} tasks by {len(plan.routes)} robots"
        where = f"{', '.join(placed)} from where they stand" if placed else "from where the mission says"
        return TriggerResponse(success=True, message=f"{told}, {where}")

    def _asked_for(self) -> Mission:
        """That of the parameter; without one, the one that the controller has."""
        if rospy.get_param(MISSION, None) is None and "/muster/mission" in self._heard:
            return unpacked(self._heard["/muster/mission"])
        rows = self._heard.get("/system_monitor/robots", [])
        return mission_on(MISSION, self._load, lambda size: robots_heard(rows, self._topics, size))

    def _from_where_they_stand(self, mission: Mission) -> tuple[Mission, list[str]]:
        """The mission with the poses that the system monitor knows, and the robots that have one."""
        rows = self._heard.get("/system_monitor/robots", [])
        stands = {row["robot"]: row["position"] for row in rows if row["position"] is not None}
        robots = [
            replace(robot, position=tuple(stands[robot.id][: mission.dimensions])) if robot.id in stands else robot
            for robot in mission.robots
        ]
        placed = [robot.id for robot in mission.robots if robot.id in stands]
        return replace(mission, robots=tuple(robots)), placed

    def _publish(self, plan: Plan, time_s: float) -> None:
        sequences = {route.robot: list(route.tasks) for route in plan.routes}
        said = {"mission": plan.mission, "time_s": time_s, "task_sequences": sequences}
        self._say("/mission_planner/plan", said)
        for robot, tasks in sequences.items():
            self._say(f"{self._topics(robot)}/task_sequence", tasks)

    def _say(self, topic: str, data: Any) -> None:
        with self._lock:
            if topic not in self._publishers:
                self._publishers[topic] = rospy.Publisher(topic, String, queue_size=100, latch=True)
            if data is not None:
                publish(self._publishers[topic], text_of(data))


def _with_parameter(options: Mapping[str, Any]) -> dict[str, Any]:
    """Planning options with those of the parameter in place of theirs.

    Raises
    ------
    ParameterError
        if the parameter is no mapping.
    """
    own = rospy.get_param(OPTIONS, {})
    if not isinstance(own, dict):
        raise ParameterError(f"{OPTIONS}: {shown(own)}; expected a mapping such as {{allocator: greedy}}")
    if "iterations" in own and "time_limit" not in own:
        options = {**options, "time_limit": None}
    return {**options, **own}
