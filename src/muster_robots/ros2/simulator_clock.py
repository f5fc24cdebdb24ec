"""The clock of a simulator on ROS 2: what `/clock` says, by which nodes go whose parameter `use_sim_time` is set."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from muster_robots.ros2.description import Message
from muster_robots.ros2.message_types import Time
from muster_robots.ros2.middleware import Middleware
from muster_robots.simulated_time import Forward


@dataclass(frozen=True)
class ClockMessage(Message):
    NAME: ClassVar = "rosgraph_msgs/Clock"
    clock: Time = Time()


class SimulatorClock:
    """A `Clock` that never goes back; read in the thread that asks."""

    def __init__(self, middleware: Middleware) -> None:
        self._reader = middleware.reader("/clock", ClockMessage)
        self._said_s = 0.0
        self._forward = Forward(self.stamp)

    @property
    def has_begun(self) -> bool:
        """Whether a message has come."""
        return self._forward.has_begun

    def now(self) -> float:
        """See `Clock`: seconds since the first message."""
        return self._forward()

    def stamp(self) -> float:
        """Return what the clock says, seconds."""
        for message in self._reader.take():
            self._said_s = message.clock.seconds
        return self._said_s
