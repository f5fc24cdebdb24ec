"""Robots that the mission does not name: found by their topics, they join once they have said where they are.

Steps 2 to 4 of the dynamic instantiation of [tcf-thesis], Figure 5.7. What such a robot can do it says on
`<robot>/muster`, a String in JSON with a robot's keys of a mission file; one that does not has their defaults.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from muster.bridges.descriptions import robot_as_said
from muster.bridges.discovery import robots_in, topics_in
from muster.bridges.ros2.message_types import String
from muster.bridges.ros2.middleware import Reader, Wire
from muster.bridges.ros2.port import Ros2Port
from muster.mission.errors import MissionError
from muster.mission.model import Robot

_LOOK_S = 0.5
_SAYS_WITHIN_S = 2.0
"""A robot that was found has so long to say what it can do."""
_log = logging.getLogger(__name__)


@dataclass
class _Stranger:
    words: Reader[String]
    until_s: float
    port: Ros2Port | None = None  # once it is known what it can do


class Newcomers:
    """Looks for robots that nobody knows.

    Parameters
    ----------
    namespace
        in which the robots' own are; "" for the root.
    known
        names of those that are not looked for.
    flat
        whether the mission is in the plane.
    reach
        makes the port of a robot.
    """

    def __init__(
        self, wire: Wire, namespace: str, known: Iterable[str], reach: Callable[[Robot], Ros2Port], *, flat: bool
    ) -> None:
        self._wire, self._namespace, self._topics, self._reach = wire, namespace, topics_in(namespace), reach
        self._nowhere = (0.0, 0.0) if flat else (0.0, 0.0, 0.0)
        self._known = set(known)
        self._strangers: dict[str, _Stranger] = {}
        self._look_s = 0.0

    def look(self, now: float) -> list[Ros2Port]:
        """The ports of those who have said where they are since; `body` is who they are."""
        if now >= self._look_s:
            self._look_s = now + _LOOK_S
            for name in robots_in(self._wire.topics(), self._namespace):
                self._find(name, now)
        return [port for name in list(self._strangers) if (port := self._met(name, now)) is not None]

    def _find(self, name: str, now: float) -> None:
        if name not in self._known:
            self._known.add(name)
            words = self._wire.reader(self._words_of(name), String)
            self._strangers[name] = _Stranger(words, now + _SAYS_WITHIN_S)

    def _words_of(self, name: str) -> str:
        """The topic on which it says what it can do."""
        return f"{self._topics(name)}/muster"

    def _met(self, name: str, now: float) -> Ros2Port | None:
        stranger = self._strangers[name]
        if stranger.port is None:
            said = [word.data for word in stranger.words.take()]
            if not said and now < stranger.until_s:
                return None
            try:
                robot = robot_as_said(_as_data(said), Robot(id=name, position=self._nowhere), self._words_of(name))
            except MissionError as error:
                _log.warning("%s does not join: %s", name, error)
                del self._strangers[name]
                return None
            stranger.port = self._reach(robot)
        stranger.port.hear()
        there = stranger.port.telemetry()
        if there is None:
            return None
        stranger.port.body = replace(stranger.port.body, position=there.position[: len(self._nowhere)])
        return self._strangers.pop(name).port


def _as_data(said: list[str]) -> object:
    if not said:
        return {}
    try:
        return json.loads(said[-1])
    except ValueError:
        return said[-1]
