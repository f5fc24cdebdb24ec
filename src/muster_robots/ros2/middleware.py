"""The interface of a middleware of ROS 2: DDS without ROS (`dds`), or rclpy (`rclpy_middleware`). Both are polled."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Literal, Protocol, TypeVar

from muster.mission.errors import ParameterError
from muster_robots.navigation import Navigator
from muster_robots.ros2.description import Message
from muster_robots.ros2.message_types import PoseStamped

M = TypeVar("M", bound=Message)
Sent = TypeVar("Sent", bound=Message, contravariant=True)

By = Literal["dds", "rclpy"]
KEPT = 100
"""Messages that are kept until they are taken."""
_LAST_DOMAIN = 232  # beyond it there are no ports


class Writer(Protocol[Sent]):
    """Publishes messages of a type on a topic, reliably."""

    def write(self, message: Sent) -> None:
        """Publish it.

        Raises
        ------
        NetworkError
            if it cannot be sent.
        """
        ...

    @property
    def listeners(self) -> int:
        """The number of subscribers."""
        ...


class Reader(Protocol[M]):
    """Hears messages of a type on a topic, whether they are published reliably or not."""

    def take(self) -> list[M]:
        """What has come since, oldest first; does not wait."""
        ...


class Middleware(Protocol):
    """Takes part in a domain of ROS 2 until it is closed. What has come is to be had after `wait`."""

    def writer(self, topic: str, message: type[M]) -> Writer[M]:
        """Who publishes on a topic (`/r_0/goal_pose`)."""
        ...

    def reader(self, topic: str, message: type[M], *, latched: bool = False) -> Reader[M]:
        """A subscriber of a topic; `latched`: of publishers alone that keep their last messages, and of these too."""
        ...

    def others(self, topic: str, message: type[M]) -> Reader[M] | None:
        """Return what hears the messages of others alone on a topic; None where they are not told from Muster's."""
        ...

    def navigator(self, action: str) -> Navigator[PoseStamped]:
        """Who gives goals to an action (`/r_0/navigate_to_pose`).

        Raises
        ------
        MissingExtraError
            where Nav2's messages are not there.
        """
        ...

    def topics(self) -> Iterable[tuple[str, str]]:
        """What is published: topics and types (`geometry_msgs/PoseStamped`)."""
        ...

    def wait(self, seconds: float) -> None:
        """Wait, and receive messages meanwhile."""
        ...

    def close(self) -> None:
        """Leave; writers and readers end with it."""
        ...


def is_latched(topic: str) -> bool:
    """Whether those who listen later get a topic's last messages, too: `/tf_static`, and that of a robot."""
    return topic.rpartition("/")[2] == "tf_static"


def domain_or_own(domain: int | None) -> int:
    """A domain, or that of the environment.

    Raises
    ------
    ParameterError
        if it is no number from 0 to 232.
    """
    text = (os.environ.get("ROS_DOMAIN_ID") or "0") if domain is None else str(domain)
    if not (text.isascii() and text.isdigit()) or int(text) > _LAST_DOMAIN:
        name = "ROS_DOMAIN_ID" if domain is None else "domain"
        raise ParameterError(f"{name}: {text!r}; expected a number from 0 to {_LAST_DOMAIN}")
    return int(text)


def line_of(error: Exception) -> str:
    """The message of an error of DDS or rclpy, in one line."""
    return " ".join(str(error).split()) or type(error).__name__
