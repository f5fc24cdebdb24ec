"""Robots that are discovered while a mission goes on: steps 2 to 4 of [tcf-thesis], Figure 5.7, on ROS 1."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from muster.bridges.discovery import robots_in, topics_in
from muster.bridges.ros1.parameter_descriptions import described
from muster.bridges.ros1.port import Ros1Port
from muster.bridges.ros1.ros import rospy
from muster.mission.errors import MissionError
from muster.mission.model import Robot


class Newcomers:
    """Looks for robots that nobody knows.

    Parameters
    ----------
    namespace
        in which the robots' own are; "" for the root.
    known
        names of those that are not looked for.
    reach
        makes the port of a robot.
    flat
        whether the mission is in the plane.
    """

    def __init__(self, namespace: str, known: Iterable[str], reach: Callable[[Robot], Ros1Port], *, flat: bool) -> None:
        self._namespace, self._topics, self._reach = namespace, topics_in(namespace), reach
        self._nowhere = (0.0, 0.0) if flat else (0.0, 0.0, 0.0)
        self._known = set(known)
        self._strangers: dict[str, Ros1Port] = {}  # discovered, and not yet heard

    def look(self) -> list[Ros1Port]:
        """The ports of those who have said where they are since; `body` is who they are.

        Where the master does not answer, in the middle even, nobody is lost: they are looked for again.
        """
        try:
            for name in robots_in(rospy.get_published_topics(), self._namespace):
                if name not in self._known:
                    self._meet(name)
        except Exception as error:  # rospy raises whatever the network does; who watches the master tells of it
            rospy.logdebug(f"the ROS master does not answer: {error}")
        return [port for name in list(self._strangers) if (port := self._heard(name)) is not None]

    def close(self) -> None:
        """Forget those that were not yet heard."""
        for port in self._strangers.values():
            port.close()

    def _meet(self, name: str) -> None:
        """Listen to a robot; where it is, it says next."""
        try:
            self._strangers[name] = self._reach(described(self._topics(name), Robot(id=name, position=self._nowhere)))
        except MissionError as error:
            rospy.logwarn(f"{name} does not join: {error}")
        self._known.add(name)

    def _heard(self, name: str) -> Ros1Port | None:
        port = self._strangers[name]
        said = port.telemetry()
        if said is None:
            return None
        port.body = replace(port.body, position=said.position[: len(self._nowhere)])
        return self._strangers.pop(name)
