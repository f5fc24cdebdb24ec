"""The high-level controller of [tcf-thesis]: its requests, and its state; it carries out one mission after the other.

It answers the node `/command_interface` with the truth: an answer says whether what was asked for happens, or why not.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any, Literal

from muster.mission.errors import MusterError, NetworkError, ParameterError
from muster.mission.model import Event, Mission, MovedTask, Task
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.mission.value_types import shown
from muster_robots.discovery import NAME
from muster_robots.ros1.fleet import Ros1Fleet
from muster_robots.ros1.mission_topics import MissionTopics
from muster_robots.ros1.mission_transfer import packed, unpacked
from muster_robots.ros1.parameter_descriptions import task_of
from muster_robots.ros1.requests import COMMANDS, PLANNING, Data, RequestClient, RequestServer
from muster_robots.ros1.ros import rospy

State = Literal["empty", "waiting", "gathering", "planning", "carrying-out", "paused", "ended"]
_BUSY = ("gathering", "planning", "carrying-out", "paused")
_LOOK_S = 0.05
_ARRIVES_S = 0.2
_PLANS_WITHIN_S = 600.0
"""Beside the time limit: to start the planner, to read maps and to finish what was begun."""


class Controller:
    """The state of the whole. The main thread carries missions out; a thread of ROS answers meanwhile.

    Attributes
    ----------
    board
        on which it says what it does; the executor's observer.
    halt
        set when the present mission is to end.
    ending
        set when no other mission may begin.
    """

    def __init__(self) -> None:
        self.mission_topics = MissionTopics()
        self.halt = threading.Event()
        self.ending = threading.Event()
        self._lock = threading.RLock()
        self._state: State = "empty"
        self._mission: Mission | None = None
        self._fleet: Ros1Fleet | None = None
        self._extra: list[Task] = []  # that were added before the mission begins
        self._become("empty")
        rospy.on_shutdown(self._stand)
        self._planning = RequestClient(PLANNING)
        self._answers = RequestServer(COMMANDS, self._answer)

    def load(self, mission: Mission) -> str:
        """Have a mission wait for its start.

        Raises
        ------
        MusterError
            if another is under way, or a robot's id is no name for ROS.
        """
        with self._lock:
            if self._state in _BUSY:
                raise MusterError(f"{self._what}; expected none under way: cancel it first")
            for robot in mission.robots:
                if not NAME.fullmatch(robot.id):
                    expected = "a name for ROS: a letter, then letters, digits, _"
                    raise ParameterError(f"robot {shown(robot.id)}; expected {expected}")
            self._mission, self._extra = mission, []
            self.mission_topics.publish_mission(mission)
            self._become("waiting")
        return f"mission {mission.name}: {len(mission.robots)} robots, {len(mission.tasks)} tasks; start begins it"

    def start(self) -> str:
        """Begin, or go on after a pause.

        Raises
        ------
        MusterError
            if there is nothing to start.
        """
        with self._lock:
            if self._state == "paused" and self._fleet is not None:
                self._fleet.resume()
                self._become("carrying-out")
                return f"mission {self._name} goes on"
            if self._state != "waiting":
                raise MusterError(f"{self._what}; expected one that was loaded and waits, or is paused")
            self._become("gathering")
            return f"mission {self._name} begins"

    def await_start(self) -> Mission | None:
        """The mission that is to begin, once it is; None if it was cancelled, or all is to end."""
        while not (self.halt.wait(_LOOK_S) or self.ending.is_set()):
            with self._lock:
                if self._state == "gathering":
                    return self._mission
        return None

    def plan(self, mission: Mission, options: Mapping[str, Any]) -> Plan | None:
        """Ask the mission planner, with planning options as plain data; None if that was halted.

        Raises
        ------
        NetworkError
            if there is no answer.
        MusterError
            with what the planner says is wrong.
        """
        self._become("planning")
        question = {"mission": packed(mission), "options": dict(options)}
        within = _PLANS_WITHIN_S + (options["time_limit"] or 0.0)
        answer = self._planning.ask(question, wait_s=within, halted=self.halt.is_set)
        if self.halt.is_set():
            return None
        if answer is None:
            raise NetworkError(f"node /mission_planner: no plan within {within:g} s; expected one")
        if "fault" in answer:
            raise MusterError(answer["fault"])
        return plan_from(answer["plan"], "/mission_planner")

    def carry_out(self, fleet: Ros1Fleet) -> None:
        """From now on the mission is under way."""
        with self._lock:
            self._fleet = fleet
            for task in self._extra:
                fleet.report(Event(at_s=fleet.time_s, new_task=task))
            self._extra = []
            self._become("carrying-out")

    def end_all(self) -> None:
        """The present mission ends, and no other begins."""
        self.ending.set()
        self.halt.set()

    def end(self, reason: str = "") -> None:
        """The mission is over, or never was; the next may be loaded."""
        with self._lock:
            self.halt.clear()
            self._become("ended", reason)
            self._fleet = None

    def _answer(self, question: Data) -> Mapping[str, Any]:
        asked: dict[str, Callable[[], str]] = {
            "load": lambda: self.load(unpacked(question["mission"])),
            "start": self.start,
            "pause": self._pause,
            "cancel": self._cancel,
            "add_task": lambda: self._add_task(question["task"]),
            "move_task": lambda: self._move_task(question["move"]),
        }
        try:
            return {"success": True, "message": asked[question["verb"]]()}
        except MusterError as error:
            return {"success": False, "message": str(error)}

    def _pause(self) -> str:
        with self._lock:
            if self._state != "carrying-out" or self._fleet is None:
                raise MusterError(f"{self._what}; expected one that is carried out")
            try:
                self._fleet.pause()
            finally:  # all that could be told stand, whatever the answer says of the others
                self._become("paused")
            return f"mission {self._name} is paused; the robots were told to stand"

    def _cancel(self) -> str:
        with self._lock:
            if self._state not in (*_BUSY, "waiting") or self.halt.is_set():
                raise MusterError(f"{self._what}; expected one that waits or is under way")
            self.halt.set()
            if self._fleet is None:
                return f"mission {self._name} is cancelled before it began"
            self._fleet.stop()
            return f"mission {self._name} is cancelled; the robots were told to stand"

    def _add_task(self, text: str) -> str:
        with self._lock:
            try:
                task = task_of(text)
                if self._state not in (*_BUSY, "waiting"):
                    raise MusterError(f"add_task: task {shown(task.id)}: {self._what}; expected one for it")
            except MusterError as error:
                self.mission_topics.refuse(str(error))
                raise
            if self._fleet is None:
                self._extra.append(task)
            else:
                self._fleet.report(Event(at_s=self._fleet.time_s, new_task=task))
            return f"task {task.id}"

    def _move_task(self, move: Mapping[str, Any]) -> str:
        """A task lies elsewhere than was thought: of what cameras have found."""
        with self._lock:
            if self._fleet is None:
                raise MusterError(f"{self._what}; expected one that is carried out")
            moved = MovedTask(task=move["task"], position=tuple(move["position"]))
            self._fleet.report(Event(at_s=self._fleet.time_s, move_task=moved))
            return f"task {moved.task}"

    def _stand(self) -> None:
        """Where somebody else shuts the node down."""
        fleet = self._fleet
        if fleet is not None:
            fleet.stop()
            time.sleep(_ARRIVES_S)

    @property
    def _name(self) -> str:
        return "" if self._mission is None else self._mission.name

    @property
    def _what(self) -> str:
        return "no mission" if self._mission is None else f"mission {self._name} is {self._state}"

    def _become(self, state: State, reason: str = "") -> None:
        with self._lock:
            self._state = state
            now = None if self._fleet is None else self.mission_topics.now_s
            self.mission_topics.publish_status(state, self._name, now, reason)
