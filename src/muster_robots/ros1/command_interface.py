"""The node `/command_interface`: users' requests to the team ([tcf-thesis], Table 5.1, 1).

Services (std_srvs/Trigger) `load`, `start`, `pause`, `cancel`; topic `add_task` (std_msgs/String with JSON). What
is asked for goes to the controller, and its answer back to the user.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from muster.mission.errors import MusterError
from muster_robots.ros1.heard_robots import robots_heard
from muster_robots.ros1.mission_transfer import Load, in_lines, mission_on, packed
from muster_robots.ros1.node import hear
from muster_robots.ros1.requests import COMMANDS, RequestClient
from muster_robots.ros1.ros import String, Trigger, TriggerResponse, rospy

MISSION = "/command_interface/mission"
_ANSWERS_WITHIN_S = 20.0


class CommandInterface:
    """Serves from when it is made; this process is a node by then.

    Parameters
    ----------
    load
        Muster's loader of mission files.
    topics
        the namespace of a robot's topics.
    """

    def __init__(self, load: Load, *, topics: Callable[[str], str]) -> None:
        self._load, self._topics = load, topics
        self._rows: list[dict[str, Any]] = []  # of the system monitor
        self._monitor = hear("/system_monitor/robots", String, self._hear_monitor, queue_size=10)
        self._controller = RequestClient(COMMANDS)
        self._tasks = hear("/command_interface/add_task", String, self._add_task, queue_size=100)
        self._services = [
            rospy.Service(f"/command_interface/{verb}", Trigger, self._service(do))
            for verb, do in (
                ("load", self._load_mission),
                ("start", lambda: self._ask("start")),
                ("pause", lambda: self._ask("pause")),
                ("cancel", lambda: self._ask("cancel")),
            )
        ]

    def _hear_monitor(self, message: Any) -> None:
        self._rows = json.loads(message.data)

    def _load_mission(self) -> Any:
        """The mission is read here, so that one that is wrong never reaches the controller."""
        try:
            mission = mission_on(MISSION, self._load, lambda size: robots_heard(self._rows, self._topics, size))
        except MusterError as error:
            return TriggerResponse(success=False, message=in_lines(error))
        return self._ask("load", mission=packed(mission))

    def _ask(self, verb: str, **more: Any) -> Any:
        answer = self._controller.ask({"verb": verb, **more}, wait_s=_ANSWERS_WITHIN_S, halted=rospy.is_shutdown)
        if answer is None:
            told = f"node /muster: no answer within {_ANSWERS_WITHIN_S:g} s; whether it did it is not known"
            return TriggerResponse(success=False, message=told)
        return TriggerResponse(success=answer["success"], message=answer["message"])

    def _add_task(self, message: Any) -> None:
        """What is refused is an event on /muster/events, and a warning."""
        answer = self._ask("add_task", task=message.data)
        if not answer.success:
            rospy.logwarn(answer.message)

    def _service(self, do: Callable[[], Any]) -> Callable[[Any], Any]:
        return lambda request: do()
