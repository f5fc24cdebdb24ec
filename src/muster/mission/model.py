"""The question: robots, tasks and rules. Immutable; a mission that exists is consistent.

Units are SI; positions are metres in the map frame (ENU: x east, y north, z up). Names that hold another unit say so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from muster.mission.areas.parts import with_parts
from muster.mission.consistency.all_rules import inconsistencies
from muster.mission.cooperation import Lag, TeamPart
from muster.mission.errors import MissionError, ParameterError
from muster.mission.events import DelayedTask, Event, MovedTask
from muster.mission.lanes import Lane, Lanes
from muster.mission.mission_data import SCHEMA, MissionData
from muster.mission.records import findings, record, shown_if_used
from muster.mission.robots import Camera, Robot
from muster.mission.rules import OBJECTIVES, Rules
from muster.mission.site import Landmark, Map, Origin, Point, Tag, TravelTable, Zone
from muster.mission.stations import Battery, Station
from muster.mission.tables import frame_of_records, html_line, html_table
from muster.mission.tasks import Action, Found, Task, Work
from muster.mission.texts.counting import counted
from muster.mission.texts.text_files import write_text
from muster.mission.yaml_writer import flow_text, plain, with_files_from, yaml_text

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = [
    "OBJECTIVES",
    "SCHEMA",
    "Action",
    "Battery",
    "Camera",
    "DelayedTask",
    "Event",
    "Found",
    "Lag",
    "Landmark",
    "Lane",
    "Lanes",
    "Map",
    "Mission",
    "MovedTask",
    "Origin",
    "Point",
    "Robot",
    "Rules",
    "Station",
    "Tag",
    "Task",
    "TeamPart",
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
        for name, value in with_parts(self).items():
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"<Mission {self.name}: {self._counts}, {self.rules.objective}>"

    def _repr_html_(self) -> str:
        worked = any(task.actuation_cost for task in self.tasks)
        of_tasks = ("type", "position", "actuation_cost" if worked else "duration_s", "prerequisites")
        return (
            html_line(f"Mission {self.name}: {self._counts}, objective {self.rules.objective}")
            + _html_table("Robots", self.robots, ("type", "position", "work_capacity", "skills"))
            + _html_table("Tasks", self.tasks, of_tasks)
            + (_html_table("Stations", self.stations, ("position", "services", "slots")) if self.stations else "")
        )

    @property
    def _counts(self) -> str:
        counts = [counted(len(self.robots), "robot"), counted(len(self.tasks), "task")]
        return ", ".join([*counts, counted(len(self.stations), "station")] if self.stations else counts)

    def to_frame(self, of: Literal["tasks", "robots", "stations"] = "tasks") -> DataFrame:
        """The tasks, robots or stations as a DataFrame with a column for each field; needs the extra `frames`."""
        if of == "stations":
            return frame_of_records(Station, self.stations)
        if of not in ("tasks", "robots"):
            raise ParameterError(f"of: {of}; expected tasks, robots or stations")
        return frame_of_records(Task, self.tasks) if of == "tasks" else frame_of_records(Robot, self.robots)

    def save(self, path: str | Path) -> None:
        """Write the mission as YAML. Files that it names, maps and travel tables, are found from there as from before.

        Raises
        ------
        OSError
            if the file cannot be written.
        """
        write_text(Path(path), yaml_text(with_files_from(self, Path(path).parent)))

    @property
    def all_robots(self) -> tuple[Robot, ...]:
        """Its robots, and those that join it while it is carried out."""
        return (*self.robots, *self.newcomers)

    @property
    def newcomers(self) -> tuple[Robot, ...]:
        """The robots that join it while it is carried out."""
        return tuple(event.robot_joins for event in self.events if event.robot_joins is not None)

    def at_once(self, **changes: Any) -> Mission:
        """The mission, changed, without what happens or is found while it is carried out."""
        return replace(self, events=(), tags=(), found=(), **changes)

    def what_is_left(self, **changes: Any) -> Mission:
        """The same with changes that are not checked: robots and tasks of its own, some of them, as they are now."""
        left = object.__new__(Mission)
        own = {f.name: getattr(self, f.name) for f in fields(self)}
        left.__dict__.update({**own, "events": (), "tags": (), "found": (), **changes})
        return left


def _html_table(title: str, items: Sequence[Robot] | Sequence[Task] | Sequence[Station], columns: Sequence[str]) -> str:
    """A table of robots or tasks: their ids, these columns, and those of times and teams that say something."""
    if_used = [*shown_if_used(Robot), *shown_if_used(Task)]
    used = [name for name in if_used if any(_value(item, name) for item in items)]
    names = (*columns, *used)
    rows = [(item.id, *(_in_cell(_value(item, name)) for name in names)) for item in items]
    return html_table(title, (title.lower()[:-1], *(name.replace("_", " ") for name in names)), rows)


def _value(item: Robot | Task | Station, name: str) -> Any:
    """The value of a field, or of a key of a rule; None: it has none."""
    return getattr(item, name, None) if isinstance(item, Station) else item.value(name)


def _in_cell(value: Any) -> Any:
    """A value as a cell shows it: what is nested as in a mission file."""
    flat = isinstance(value, tuple) and all(isinstance(item, str | float) for item in value)
    nested = isinstance(value, Mapping | tuple) or is_dataclass(value)
    return flow_text(plain(value)) if nested and not flat else value
