"""Requests from one node to another, one at a time, with answers: JSON on two latched topics.

A service cannot be asked before it is there, nor left in the middle. A latched question waits for whoever starts late,
and who asked may stop waiting.
"""

from __future__ import annotations

import json
import threading
import time
import uuid
from collections.abc import Callable, Mapping
from typing import Any

from muster_robots.ros1.message_conversion import text_of
from muster_robots.ros1.node import hear, publish
from muster_robots.ros1.ros import String, rospy

COMMANDS = "/muster/commands"
PLANNING = "/muster/planning"
"""Questions to the controller, and of the controller to the mission planner."""

Data = Mapping[str, Any]
_LOOK_S = 0.1


class RequestClient:
    """Sends requests on `<name>/question`, and receives answers on `<name>/answer`."""

    def __init__(self, name: str) -> None:
        self._one_at_a_time = threading.Lock()
        self._heard = threading.Condition()
        self._answers: dict[str, Data] = {}
        self._question = rospy.Publisher(f"{name}/question", String, queue_size=10, latch=True)
        self._subscriber = hear(f"{name}/answer", String, self._hear, queue_size=10)

    def ask(self, question: Data, *, wait_s: float, halted: Callable[[], bool] = lambda: False) -> Data | None:
        """The answer; None if there was none in time, or waiting was halted."""
        with self._one_at_a_time:
            number, until = uuid.uuid4().hex, time.monotonic() + wait_s
            publish(self._question, text_of({**question, "question": number}))
            with self._heard:
                while number not in self._answers and time.monotonic() < until and not halted():
                    self._heard.wait(_LOOK_S)
                answer = self._answers.get(number)
                self._answers.clear()
            return answer

    def _hear(self, message: Any) -> None:
        answer = json.loads(message.data)
        with self._heard:
            self._answers[answer.pop("question")] = answer
            self._heard.notify_all()


class RequestServer:
    """Answers the requests of a `RequestClient` of the same name; a repeated one is answered once.

    Parameters
    ----------
    answer
        is called in a thread of ROS, for one question after the other.
    """

    def __init__(self, name: str, answer: Callable[[Data], Data]) -> None:
        self._do = answer
        self._last = ""
        self._answer = rospy.Publisher(f"{name}/answer", String, queue_size=10, latch=True)
        self._subscriber = hear(f"{name}/question", String, self._hear, queue_size=10)

    def _hear(self, message: Any) -> None:
        question = json.loads(message.data)
        number = question.pop("question")
        if number != self._last:
            self._last = number
            publish(self._answer, text_of({**self._do(question), "question": number}))
