"""Robots on ROS 2 that the mission does not name: each describes itself on `<robot>/muster`.

The description is a String in JSON with a robot's keys of a mission file; a robot that publishes none has the defaults.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Iterable

from muster.mission.model import Robot
from muster_robots.descriptions import robot_from_description
from muster_robots.discovery import topics_in
from muster_robots.joining import Newcomers
from muster_robots.ros2.message_types import String
from muster_robots.ros2.middleware import Middleware, Reader
from muster_robots.ros2.port import Ros2Port

_LOOK_S = 0.1
_SAYS_WITHIN_S = 2.0
"""A robot that was found has this long to describe itself."""
_log = logging.getLogger(__name__)


class Ros2Newcomers(Newcomers[Ros2Port]):
    """See `Newcomers`."""

    def __init__(
        self,
        middleware: Middleware,
        namespace: str,
        known: Iterable[str],
        reach: Callable[[Robot], Ros2Port],
        *,
        flat: bool,
    ) -> None:
        self._middleware, self._topics_of = middleware, topics_in(namespace)
        self._descriptions: dict[str, tuple[Reader[String], float]] = {}  # until when they are waited for
        self._now = self._look_s = 0.0
        super().__init__(
            namespace,
            known,
            topics=middleware.topics,
            describe=self._described,
            reach=reach,
            warn=_log.warning,
            flat=flat,
        )

    def look(self, now: float) -> list[Ros2Port]:
        """The ports of robots whose position is known by now."""
        if now >= self._look_s:
            self._now, self._look_s = now, now + _LOOK_S
            self.discover()
        for port in self.ports.values():
            port.hear()
        return self.located()

    def _described(self, robot: Robot) -> Robot | None:
        topic = f"{self._topics_of(robot.id)}/muster"
        if robot.id not in self._descriptions:
            self._descriptions[robot.id] = self._middleware.reader(topic, String), self._now + _SAYS_WITHIN_S
        reader, until_s = self._descriptions[robot.id]
        said = [message.data for message in reader.take()]
        if not said and self._now < until_s:
            return None
        return robot_from_description(_as_data(said), robot, topic)


def _as_data(said: list[str]) -> object:
    if not said:
        return {}
    try:
        return json.loads(said[-1])
    except ValueError:
        return said[-1]
