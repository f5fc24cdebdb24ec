"""A record that was read: the mission, its plans, and what happened."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from muster.mission.model import Mission, Point, Robot, Task
from muster.mission.plan import Plan
from muster.mission.values.arrays import Floats
from muster.motion.grid import Grid
from muster.state import ExecutionEvent, MissionState


@dataclass(frozen=True)
class PlanVersion:
    """A plan, the time from which it held, and its routes as lines: where each robot still had to go then.

    `lines` has points of two or three coordinates, as the mission has, in metres.
    """

    time_s: float
    plan: Plan
    lines: Mapping[str, Sequence[Point]]


@dataclass(frozen=True, eq=False)
class Tracks:
    """The robots' tracks: m moments, n robots. An absent robot has NaN.

    Parameters
    ----------
    robots
        their ids, (n,).
    times_s
        (m,) seconds of the mission's clock, growing.
    positions, headings, velocities
        (m, n, 3) metres, (m, n) radians, (m, n, 3) m/s in the map frame.
    """

    robots: tuple[str, ...]
    times_s: Floats
    positions: Floats
    headings: Floats
    velocities: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """What a record holds.

    Parameters
    ----------
    file
        its name, for messages.
    mission, mission_text
        the mission, without travel tables, and its text as the record has it.
    image
        the cells of a map that is an image.
    plans, events, bids
        in the order in which they came.
    tracks
        of the robots of the mission, then those that joined.
    report
        None where the mission did not come to its end.
    complete
        whether the file was ended in order and is undamaged; if it breaks off, what was read is all up to its last
        whole chunk.
    """

    file: str
    mission: Mission
    mission_text: str
    image: Grid | None
    plans: tuple[PlanVersion, ...]
    events: tuple[ExecutionEvent, ...]
    bids: tuple[Mapping[str, Any], ...]
    tracks: Tracks
    report: Mapping[str, Any] | None
    complete: bool

    @property
    def duration_s(self) -> float:
        """The time of the last entry."""
        told = [event.time_s for event in self.events] + [version.time_s for version in self.plans]
        reported = (self.report or {}).get("mission_time_s") or 0.0
        return float(max([0.0, reported, *told, *self.tracks.times_s[-1:].tolist()]))

    @cached_property
    def outcome(self) -> MissionState:
        """The robots and tasks after the last event, with their states; not to be changed."""
        return MissionState.after(self.mission, self.events)

    @cached_property
    def robots(self) -> tuple[Robot, ...]:
        """Those of the mission, then those that joined."""
        return tuple(known.robot for known in self.outcome.robots.values())

    @cached_property
    def tasks(self) -> tuple[Task, ...]:
        """Those of the mission, then those that were added."""
        return tuple(self.outcome.tasks.values())
