"""The question: robots, tasks and rules. Immutable; a mission that exists is consistent.

Units are SI; positions are metres in the map frame (ENU: x east, y north, z up). Names that hold another unit say so.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from muster.mission.consistency import inconsistencies
from muster.mission.errors import MissionError
from muster.mission.events import DelayedTask, Event, MovedTask
from muster.mission.mission_data import SCHEMA, MissionData
from muster.mission.records import findings, record
from muster.mission.robots import Camera, Robot
from muster.mission.rules import OBJECTIVES, Rules
from muster.mission.site import Map, Origin, Point, Tag, TravelTable, Zone
from muster.mission.tasks import Action, Found, Task, Work

__all__ = [
    "OBJECTIVES",
    "SCHEMA",
    "Action",
    "Camera",
    "DelayedTask",
    "Event",
    "Found",
    "Map",
    "Mission",
    "MovedTask",
    "Origin",
    "Point",
    "Robot",
    "Rules",
    "Tag",
    "Task",
    "TravelTable",
    "Work",
    "Zone",
]


@record
class Mission(MissionData):
    """The question: robots, tasks, rules. A mission that exists is consistent.

    Raises
    ------
    MissionError
        when made from parts that do not fit together; it holds all findings.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        faults = list(inconsistencies(self))
        if faults:
            raise MissionError(findings(faults, self.source))

    def at_once(self, **changes: Any) -> Mission:
        """The mission, changed, without what happens or is found while it is carried out."""
        return replace(self, events=(), tags=(), found=(), **changes)
