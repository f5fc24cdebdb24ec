"""Robots that the mission does not name: discovered by their topics, they join once their position is known.

Steps 2 to 4 of the dynamic instantiation of [tcf-thesis], Figure 5.7. How such a robot describes itself is the
middleware's affair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Generic, Protocol, TypeVar

from muster.mission.errors import MissionError
from muster.mission.model import Robot
from muster.motion.port import Telemetry
from muster_robots.discovery import robots_in


class _Port(Protocol):
    body: Robot

    @property
    def missing(self) -> str: ...

    def telemetry(self) -> Telemetry | None: ...


P = TypeVar("P", bound=_Port)


class Newcomers(Generic[P]):
    """Looks for robots that the mission does not name.

    Parameters
    ----------
    namespace
        in which the robots' own are; "" for the root.
    known
        names of robots that are not looked for.
    topics
        gives names and types of all topics that are published.
    describe
        gives a robot as it describes itself, from one with its name alone; None while that is not known yet. A
        MissionError says that the description is wrong: then the robot does not join.
    reach
        makes the port of a robot.
    warn
        receives a line about a robot that does not join.
    flat
        whether the mission is in the plane.
    """

    def __init__(
        self,
        namespace: str,
        known: Iterable[str],
        *,
        topics: Callable[[], Iterable[tuple[str, str]]],
        describe: Callable[[Robot], Robot | None],
        reach: Callable[[Robot], P],
        warn: Callable[[str], None],
        flat: bool,
    ) -> None:
        self._namespace, self._known = namespace, set(known)
        self._topics, self._describe, self._reach, self._warn = topics, describe, reach, warn
        self._origin = (0.0, 0.0) if flat else (0.0, 0.0, 0.0)
        self.ports: dict[str, P] = {}
        """Of robots that were found and whose position is not known yet."""

    def discover(self) -> None:
        """Look for robots on topics; an error that is no MissionError leaves the rest to the next call."""
        for name in robots_in(self._topics(), self._namespace):
            if name not in self._known:
                self._meet(Robot(id=name, position=self._origin))

    def located(self) -> list[P]:
        """The ports of robots that can be driven by now; `body` has their position."""
        ready = [(name, port) for name, port in self.ports.items() if not port.missing]
        found = [(name, said) for name, port in ready if (said := port.telemetry()) is not None]
        for name, said in found:
            body = self.ports[name].body
            self.ports[name].body = replace(body, position=said.position[: len(self._origin)])
        return [self.ports.pop(name) for name, _ in found]

    def _meet(self, robot: Robot) -> None:
        try:
            described = self._describe(robot)
        except MissionError as error:
            self._known.add(robot.id)
            self._warn(f"{robot.id} does not join: {error}")
            return
        if described is not None:
            self._known.add(robot.id)
            self.ports[robot.id] = self._reach(described)
