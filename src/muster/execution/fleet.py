"""The interface of a fleet of real robots: their ports, and a clock in real time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from muster.execution.robots.monitor import Limits
from muster.execution.robots.task_motion import Way
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.motion.port import RobotPort


@dataclass(frozen=True)
class Failure(Event):
    """A robot reports that it cannot go on (`robot_fails`), with the reason; mission files have no key for that."""

    reason: str = ""


def reason_of(event: Event) -> str:
    """Why it has happened; empty where that is not known."""
    return event.reason if isinstance(event, Failure) else ""


def has_simulated_time(fleet: Fleet) -> bool:
    """Return whether a fleet says that its clock is a simulator's, by an attribute `simulated_time` that is true.

    The clock of a mission is the wall clock otherwise.
    """
    return bool(getattr(fleet, "simulated_time", False))


def limits_of(fleet: Fleet) -> Limits:
    """Return how long what may last with a fleet, by its attribute `limits`; the defaults where it has none."""
    return getattr(fleet, "limits", None) or Limits()


def refusals_of(fleet: Fleet, mission: Mission, plan: Plan, way: Way) -> list[tuple[str, str, str]]:
    """Return which robots of a fleet cannot do which tasks, and why, by its method `refusals`, if it has one.

    Parameters
    ----------
    fleet : Fleet
        Robots.
    mission : Mission
        Whose tasks they are to do.
    plan : Plan
        In which order.
    way : callable
        What a robot passes from one place to another.
    """
    refusals = getattr(fleet, "refusals", None)
    return [] if refusals is None else list(refusals(mission, plan, way))


def is_paused(fleet: Fleet) -> bool:
    """Return whether a fleet says that somebody let its robots stand, by an attribute `paused` that is true."""
    return bool(getattr(fleet, "paused", False))


class Fleet(Protocol):
    """Robots that are reached through one bridge. Frames and units are converted in the bridge and nowhere else."""

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """By the robots' ids; those that are discovered later are in it as soon as they are."""
        ...

    @property
    def time_s(self) -> float:
        """Seconds of a clock in real time that never goes back; telemetry is stamped by it."""
        ...

    def advance(self, until_s: float) -> Sequence[Event]:
        """Receive and send until a time of the mission's clock; may return before, where something has arrived.

        Returns
        -------
        what has happened that concerns the plan, as in a mission file: a robot that was discovered (`robot_joins`), one
        that says that it cannot go on (`robot_fails`, or a `Failure`).
        """
        ...

    def stop(self) -> None:
        """Let every robot stay where it is, safely: hold, hover; nothing lands and nothing is disarmed.

        Comes at the end of every mission, also where it was interrupted, or an error ends it.
        """
        ...

    def close(self) -> None:
        """Give back connections. Robots are left as they are."""
        ...
