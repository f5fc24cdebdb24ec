"""Robots on ROS 1 that the mission does not name: found by the master, described on the parameter server."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from muster.mission.model import Robot
from muster_robots.discovery import topics_in
from muster_robots.joining import Newcomers
from muster_robots.ros1.parameter_descriptions import robot_from_parameters
from muster_robots.ros1.port import Ros1Port
from muster_robots.ros1.ros import rospy


class Ros1Newcomers(Newcomers[Ros1Port]):
    """See `Newcomers`."""

    def __init__(self, namespace: str, known: Iterable[str], reach: Callable[[Robot], Ros1Port], *, flat: bool) -> None:
        topics_of = topics_in(namespace)
        super().__init__(
            namespace,
            known,
            topics=lambda: rospy.get_published_topics(),
            describe=lambda robot: robot_from_parameters(topics_of(robot.id), robot),
            reach=reach,
            warn=rospy.logwarn,
            flat=flat,
        )

    def look(self) -> list[Ros1Port]:
        """The ports of robots whose position is known by now; while the master does not answer, none is found."""
        try:
            self.discover()
        except Exception as error:  # rospy raises whatever the network does; who watches the master tells of it
            rospy.logdebug(f"the ROS master does not answer: {error}")
        return self.located()

    def close(self) -> None:
        """Close the ports of robots that have not joined."""
        for port in self.ports.values():
            port.close()
