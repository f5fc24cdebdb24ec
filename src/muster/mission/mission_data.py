"""The fields of a mission, before their consistency is checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from muster.mission.events import Event
from muster.mission.lanes import Lanes
from muster.mission.records import Checked, Record, record, spec
from muster.mission.robots import Robot
from muster.mission.rules import Rules
from muster.mission.site import Landmark, Map, Origin, Tag, TravelTable
from muster.mission.source import IN_PYTHON, Source
from muster.mission.stations import Station
from muster.mission.tasks import Found, Task
from muster.mission.value_types import Choice, Many, Number, Table, Text
from muster.mission.values.time_types import Moment

SCHEMA = "muster/1"


@record
class MissionData(Checked):
    """What a mission holds. `Mission` is the class whose parts fit together."""

    schema: str = spec(Choice((SCHEMA,)), "the version of this format", default=SCHEMA)
    name: str = spec(Text(), "what it is called", default="mission")
    origin_wgs84: Origin | None = spec(Record(Origin, "an origin"), "where the map frame's origin is", default=None)
    starts_at: str | None = spec(Moment(), "date and time at which it begins, for clock times", default=None)
    rules: Rules = spec(Record(Rules, "rules"), "what counts, and how", default=Rules())
    map: Map | None = spec(Record(Map, "a map"), "walls and zones", default=None)
    lanes: Lanes | None = spec(Record(Lanes, "lanes"), "the ways on which robots drive", default=None)
    travel: Mapping[str, str] | None = spec(
        Table(Text(), "a mapping from robot types to CSV files"),
        "travel tables, with rules.travel: matrix",
        default=None,
    )
    suitability: Mapping[str, Mapping[str, float]] | None = spec(
        Table(
            Table(Number(minimum=0, maximum=1), "a mapping from task types to scores"),
            "a mapping from robot types to scores of task types",
        ),
        "scores of robot types for task types; without it every pair is allowed",
        default=None,
    )
    stations: tuple[Station, ...] = spec(
        Many(Record(Station, "a station")), "where robots charge, swap batteries or unload", default=()
    )
    robots: tuple[Robot, ...] = spec(Many(Record(Robot, "a robot"), minimum=1), "the team")
    tasks: tuple[Task, ...] = spec(Many(Record(Task, "a task")), "the work")
    events: tuple[Event, ...] = spec(
        Many(Record(Event, "an event")), "what happens while it is carried out", default=()
    )
    tags: tuple[Tag, ...] = spec(
        Many(Record(Tag, "a tag")), "what there is to be found, in simulated worlds", default=()
    )
    found: tuple[Found, ...] = spec(
        Many(Record(Found, "what becomes of tags")),
        "what becomes of tags that are found: the first that fits",
        default=(),
    )
    landmarks: tuple[Landmark, ...] = spec(
        Many(Record(Landmark, "a landmark")),
        "cylinders by which lasers localise robots, in simulated worlds",
        default=(),
    )
    travel_tables: Mapping[str, TravelTable] = field(default_factory=dict)
    source: Source = field(default=IN_PYTHON, compare=False, repr=False)

    @property
    def travel_rule(self) -> str:
        """How travel is measured: as the rules say, else along lanes where there are any, else as off lanes."""
        return self.rules.travel or ("lanes" if self.lanes is not None else self._without_lanes)

    @property
    def driven_lanes(self) -> Lanes | None:
        """The lanes that robots on the ground keep to; None where travel is by another rule."""
        return self.lanes if self.travel_rule == "lanes" else None

    @property
    def travel_off_lanes(self) -> str:
        """How robots travel that keep to no lanes, those in the air: by the rule, else by the map, else straight."""
        return self._without_lanes if self.travel_rule == "lanes" else self.travel_rule

    @property
    def _without_lanes(self) -> str:
        return "euclidean" if self.map is None else "map"

    @property
    def has_straight_legs_among_areas(self) -> bool:
        """Whether legs are straight, and a boundary or zones of the map close some of them."""
        chart = self.map
        return self.travel_rule == "euclidean" and chart is not None and bool(chart.boundary or chart.zones)

    @property
    def has_ways_by_map(self) -> bool:
        """Whether the map decides which ways there are: shortest paths, or straight legs and lanes that it closes."""
        return self.travel_off_lanes == "map" or self.has_straight_legs_among_areas

    @property
    def has_paths(self) -> bool:
        """Whether ways are other than straight between their ends, or some of them are closed."""
        return self.driven_lanes is not None or self.has_ways_by_map

    @property
    def has_goods(self) -> bool:
        """Whether a task takes something on board or puts it down."""
        return any(task.load is not None or task.delivers is not None for task in self.tasks)

    @property
    def has_batteries(self) -> bool:
        """Whether a robot has a battery."""
        return any(robot.battery is not None for robot in self.robots)

    @property
    def dimensions(self) -> int:
        """2 or 3: how many coordinates the mission's positions have."""
        return len(self.robots[0].position)
