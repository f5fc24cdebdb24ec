"""The rest of the team, where each robot has an executor of its own."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class Gathering:
    """What the robots have agreed on that begin a task, or several that are tied, at the same moment.

    Parameters
    ----------
    absent
        robots that are not there yet, each with its task.
    begin_s
        when all begin; inf: that is not agreed yet.
    lasts_s
        how long the task takes: as long as for the slowest robot.
    team
        the robots of the task.
    """

    absent: Sequence[tuple[str, str]] = ()
    begin_s: float = math.inf
    lasts_s: float = 0.0
    team: tuple[str, ...] = ()


class Peers(Protocol):
    """The other robots' say."""

    def may_begin(self, task: str) -> bool:
        """Whether this executor's robot may begin a task at which it stands; asked until it may."""
        ...

    def gather(
        self, task: str, unit: Sequence[str], earliest_s: float, lasts_s: float, next_begin: Callable[[float], float]
    ) -> Gathering:
        """Tell that this executor's robot is at a task that several robots begin; asked until they begin.

        Parameters
        ----------
        unit
            the tasks that begin together, this one included.
        earliest_s, lasts_s
            when the robot could begin at the earliest, and how long its part takes.
        next_begin
            the earliest time, not before a given one, at which all these tasks may begin.
        """
        ...

    def hold_until_s(self, task: str, now: float) -> float:
        """When a task should begin so that others can begin in time after it; `now` if it need not wait."""
        ...

    def begin_together(self, task: str) -> None:
        """The executor's robot begins, as agreed by `gather`."""
        ...

    def end_together(self, task: str) -> bool:
        """Tell that this executor's robot has done its part; whether all have; asked until they have."""
        ...
