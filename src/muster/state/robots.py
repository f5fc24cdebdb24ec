"""What is known of one robot of a mission under way, but for what telemetry tells from moment to moment."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

from muster.mission.model import Robot

OUT = {
    "robot_fails": "failed",
    "robot_silent": "fell silent",
    "robot_suspended": "was suspended",
    "robot_stuck": "did not get on",
    "robot_removed": "was taken away",
}
"""By kind of the event after which a robot takes no part: why, in words."""


@dataclass
class KnownRobot:
    """One robot.

    Parameters
    ----------
    robot
        as the mission, or the event with which it joined, has it.
    out, out_s
        the kind of the event after which it takes no part, empty if it does; and since when.
    done, stops
        the tasks that it did; and the same with the stations between them.
    planned
        the usage of these tasks as planned, in the mission's unit.
    left_s
        when it left its start; None: it has not.
    used
        its usage when it last told of that; None: it has not.
    charge
        the share that its battery held last, and its usage then.
    came_to, began_s
        by task: when it came to it, and its usage then; when it began it. Until it ends one.
    """

    robot: Robot
    out: str = ""
    out_s: float = 0.0
    done: list[str] = field(default_factory=list)
    stops: list[str] = field(default_factory=list)
    planned: float = 0.0
    left_s: float | None = None
    used: float | None = None
    charge: tuple[float, float] | None = None
    came_to: dict[str, tuple[float, float]] = field(default_factory=dict)
    began_s: dict[str, float] = field(default_factory=dict)

    def begin_at(self, position: tuple[float, ...], heading_deg: float) -> None:
        """It begins elsewhere than the mission says: metres in the map frame, degrees."""
        self.robot = replace(self.robot, position=position, heading_deg=heading_deg)

    def leave(self, now_s: float) -> None:
        """It sets out, for the first time or again."""
        if self.left_s is None:
            self.left_s = now_s

    def note_used(self, used: float | None, share: float | None = None) -> None:
        """Note its usage, and the share of its energy that it holds, where they are told."""
        if used is not None:
            self.used = used
        if share is not None:
            self.charge = share, self.used or 0.0

    @property
    def energy_left(self) -> tuple[float, float] | None:
        """The share of its energy that it held last, and its usage since; None: it has not told of it."""
        return None if self.charge is None else (self.charge[0], (self.used or self.charge[1]) - self.charge[1])

    def end(self, task: str, planned: float) -> None:
        """It has done a task, or its part of it."""
        self.done.append(task)
        self.stops.append(task)
        self.planned += planned
        self.came_to.clear()
        self.began_s.clear()

    def forget(self, tasks: Collection[str]) -> None:
        """Forget that it did tasks, and the stations before them."""
        self.done = [name for name in self.done if name not in tasks]
        left = [name for name in self.stops if name not in tasks]
        first = left.index(self.done[0]) if self.done else len(left)
        self.stops = left[first:]
