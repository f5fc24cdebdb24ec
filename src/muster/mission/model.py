"""The question: robots, tasks and rules. Immutable; a mission that exists is consistent.

Units are SI; positions are metres in the map frame (ENU: x east, y north, z up). Names that hold another unit say so.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from muster.mission.action_keys import ACTION_KEYS
from muster.mission.consistency import inconsistencies
from muster.mission.errors import Finding, MissionError
from muster.mission.place_types import LatLon, Place
from muster.mission.source import IN_PYTHON, Source
from muster.mission.value_types import (
    Choice,
    Fault,
    Flag,
    JsonSchema,
    Many,
    Number,
    Path,
    Position,
    Record,
    Table,
    Text,
    Whole,
    shown,
    spec,
    specified,
)

SCHEMA = "muster/1"
OBJECTIVES = ("total+max", "total", "max", "average", "makespan")

Point = tuple[float, ...]

IN_DEGREES = ("lat_lon", LatLon(), "in place of position, beside origin_wgs84")


class _Checked:
    """Checks and converts the fields of a model class by their kinds when one is made in Python."""

    def __post_init__(self) -> None:
        faults: list[Fault] = []
        for f in specified(type(self)):
            value = getattr(self, f.name)
            if value is None and f.default is None:
                continue
            object.__setattr__(self, f.name, f.metadata["kind"].read(value, (f.name,), faults))
        if not faults:
            values = {f.name: getattr(self, f.name) for f in specified(type(self))}
            faults.extend(self.cross_check(values))
        if faults:
            raise MissionError(findings(faults, IN_PYTHON))

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        """Faults that lie between fields; `values` holds the fields that are given."""
        return ()


@dataclass(frozen=True, kw_only=True)
class Rules(_Checked):
    """What counts, and how."""

    objective: str = spec(Choice(OBJECTIVES), "what is minimised after most tasks completed", default="total+max")
    usage: str = spec(Choice(("distance", "time")), "the unit of usage: metres or seconds", default="distance")
    min_suitability: float = spec(Number(minimum=0, maximum=1), "least suitability to be assigned", default=0.65)
    return_to_start: bool = spec(Flag(), "every robot goes back to its start", default=False)
    travel: str | None = spec(
        Choice(("euclidean", "map", "matrix")),
        "how travel is measured: euclidean without a map, else map",
        default=None,
    )
    capacity_reserve: float = spec(Number(minimum=0, below=1), "share of the work capacity kept free", default=0.0)
    stability: int | None = spec(Whole(), "tasks that may change robot per event", default=None)


@dataclass(frozen=True, kw_only=True)
class Origin(_Checked):
    """Where on Earth the map frame's origin is."""

    lat_deg: float = spec(Number(minimum=-90, maximum=90), "latitude")
    lon_deg: float = spec(Number(minimum=-180, maximum=180), "longitude")
    alt_m: float = spec(Number(), "altitude above the ellipsoid", default=0.0)


@dataclass(frozen=True, kw_only=True)
class Zone(_Checked):
    """A part of the map that some robots may not enter."""

    polygon: tuple[Point, ...] = spec(Many(Position(planar=True), minimum=3), "corners in order")
    floor_m: float | None = spec(Number(), "lower end of the zone", default=None)
    ceiling_m: float | None = spec(Number(), "upper end of the zone", default=None)
    forbidden_to: tuple[str, ...] = spec(
        Many(Choice(("ground", "air")), minimum=1), "kinds of robot that may not enter", default=("ground", "air")
    )

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        floor, ceiling = values.get("floor_m"), values.get("ceiling_m")
        if floor is not None and ceiling is not None and floor >= ceiling:
            yield Fault(("ceiling_m",), shown(ceiling), f"a number above floor_m ({floor:g})")


@dataclass(frozen=True, kw_only=True)
class Map(_Checked):
    """The map: one of a ROS map file, an image, or polygons."""

    ros_yaml: str | None = spec(Text(), "a map in the form of ROS map_server", default=None)
    image: str | None = spec(Text(), "an image of the floor", default=None)
    resolution_m: float | None = spec(Number(above=0), "side of one pixel of the image", default=None)
    origin: Point | None = spec(
        Position(third="yaw"), "[x, y, yaw] of the image's lower left corner, metres and radians", default=None
    )
    boundary: tuple[Point, ...] | None = spec(
        Many(Position(planar=True), minimum=3), "corners of the arena in order", default=None
    )
    zones: tuple[Zone, ...] = spec(Many(Record(Zone, "a zone")), "parts that some robots may not enter", default=())

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        forms = [name for name in ("ros_yaml", "image", "boundary") if values.get(name) is not None]
        if len(forms) != 1:
            yield Fault((), ", ".join(forms) or "no form", "exactly one of ros_yaml, image, boundary")
        if "image" in forms and values.get("resolution_m") is None:
            yield Fault(("resolution_m",), "missing", "a finite number above 0, beside image")
        if forms in (["ros_yaml"], ["boundary"]):
            for key in ("resolution_m", "origin"):
                if values.get(key) is not None:
                    yield Fault((key,), shown(values[key]), f"no such key beside {forms[0]}: it goes with image")


@dataclass(frozen=True, kw_only=True)
class Camera(_Checked):
    """A camera fixed to a robot's body."""

    fov_deg: float = spec(Number(above=0, below=180), "field of view, horizontal")
    tilt_deg: float = spec(Number(minimum=-90, maximum=90), "downward tilt", default=0.0)
    mount: Point = spec(Position(), "place on the body, body frame", default=(0.0, 0.0, 0.0))
    width_px: int = spec(Whole(minimum=1, maximum=1920), "width of its picture", default=640)
    height_px: int = spec(Whole(minimum=1, maximum=1440), "height of its picture", default=480)
    rate_hz: float = spec(Number(above=0, maximum=100), "pictures a second", default=2.0)


@dataclass(frozen=True, kw_only=True)
class Robot(_Checked):
    """One agent."""

    id: str = spec(Text(), "unique among the robots")
    position: Point = spec(Position(), "where it starts", instead=IN_DEGREES)
    type: str | None = spec(Text(), "row of the suitability table", default=None)
    work_capacity: float | None = spec(Number(minimum=0), "most usage; without it unlimited", default=None)
    skills: tuple[str, ...] = spec(Many(Text()), "what it can do", default=())
    speed_mps: float = spec(Number(above=0), "speed of travel", default=1.0)
    efficiency: float = spec(Number(above=0), "work of duration d takes d / efficiency (aging factor)", default=1.0)
    return_to_start: bool | None = spec(Flag(), "goes back to its start; without it as the rules say", default=None)
    end_position: Point | None = spec(Place(), "where its route ends; stronger than return_to_start", default=None)
    available_from_s: float = spec(Number(minimum=0), "earliest time it can leave", default=0.0)
    heading_deg: float = spec(Number(), "heading at the start, from east, anticlockwise", default=0.0)
    radius_m: float = spec(Number(minimum=0), "radius of its body", default=0.0)
    kind: str = spec(Choice(("ground", "air")), "where it moves", default="ground")
    kinematics: str = spec(
        Choice(("holonomic", "differential-drive", "quadcopter")), "how it moves", default="holonomic"
    )
    yaw_rate_radps: float | None = spec(Number(above=0), "greatest yaw rate", default=None)
    acceleration_mps2: float | None = spec(Number(above=0), "greatest acceleration", default=None)
    avoidance_priority: float = spec(Number(minimum=0), "who gives way: the lower one", default=0.0)
    camera: Camera | None = spec(Record(Camera, "a camera"), "its camera", default=None)

    def place_at_end(self, rules: Rules) -> Point | None:
        """Where the robot's route must end, or None where it may end anywhere."""
        if self.end_position is not None:
            return self.end_position
        returns = rules.return_to_start if self.return_to_start is None else self.return_to_start
        return self.position if returns else None


@dataclass(frozen=True, kw_only=True)
class Action(_Checked):
    """What a robot does at a task."""

    name: str = spec(Choice(ACTION_KEYS.keys()), "which action")
    width_m: float | None = spec(Number(above=0), "stationary-observation: width in view", default=None)
    heading_deg: float | None = spec(Number(), "stationary-observation: direction of view, 0 if absent", default=None)
    side_m: float | None = spec(Number(above=0), "raster-search, ground-patrol: side of the square", default=None)
    height_m: float | None = spec(Number(above=0), "raster-search: height of flight", default=None)
    spacing_m: float | None = spec(Number(above=0), "raster-search: distance between lanes", default=None)
    pickup: Point | None = spec(Place(), "delivery: where the load is taken up", default=None)
    duration_s: float | None = spec(Number(minimum=0), "sensor-activation: time it takes", default=None)

    @property
    def has_geometry(self) -> bool:
        """Whether the action's cost follows from way points, not from a typed number."""
        return ACTION_KEYS[self.name].has_geometry

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        name = values["name"]
        needed, optional = ACTION_KEYS[name].needed, ACTION_KEYS[name].optional
        given = {key for key, value in values.items() if value is not None and key != "name"}
        for key in needed:
            if key not in given:
                yield Fault((key,), "missing", f"a value: {name} needs {', '.join(needed)}")
        for key in sorted(given - {*needed, *optional}):
            yield Fault((key,), "unknown key", f"the keys of {name}: {', '.join((*needed, *optional)) or 'none'}")


@dataclass(frozen=True, kw_only=True)
class Work(_Checked):
    """What there is to do, wherever that is."""

    type: str | None = spec(Text(), "column of the suitability table", default=None)
    actuation_cost: float = spec(Number(minimum=0), "cost of doing it, in the unit of usage", default=0.0)
    prerequisites: tuple[str, ...] = spec(Many(Text()), "ids of tasks that must be done before", default=())
    requires: tuple[str, ...] = spec(Many(Text()), "skills a robot must have", default=())
    duration_s: float | None = spec(Number(minimum=0), "time it takes a robot of efficiency 1", default=None)
    priority: float = spec(Number(above=0), "weight among the tasks completed", default=1.0)
    only_robots: tuple[str, ...] | None = spec(
        Many(Text(), minimum=1), "ids of the only robots that may do it", default=None
    )
    action: Action | None = spec(Record(Action, "an action"), "what the robot does there", default=None)
    across_partition: str = spec(
        Choice(("at-least-once", "at-most-once")), "what a split network may do to it", default="at-least-once"
    )

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        action = values.get("action")
        if action is not None and action.has_geometry and values.get("actuation_cost"):
            cost = shown(values["actuation_cost"])
            yield Fault(("actuation_cost",), cost, f"no typed cost beside {action.name}, whose cost is computed")
        if action is not None and action.duration_s is not None and values.get("duration_s") is not None:
            yield Fault(("duration_s",), shown(values["duration_s"]), f"no second duration beside {action.name}")


@dataclass(frozen=True, kw_only=True)
class _Placed(_Checked):
    """What comes first of a task."""

    id: str = spec(Text(), "unique among the tasks")
    position: Point = spec(Position(), "where it is", instead=IN_DEGREES)


@dataclass(frozen=True, kw_only=True)
class Task(Work, _Placed):
    """One piece of work at a place."""

    entry: Point | None = spec(Place(), "where a robot arrives; without it the position", default=None)
    exit: Point | None = spec(Place(), "where a robot leaves; without it the position", default=None)


@dataclass(frozen=True, kw_only=True)
class Tag(_Checked):
    """A tag that lies there to be found: simulated worlds show it to cameras, and nobody else knows of it."""

    id: int = spec(Whole(maximum=586), "which tag of the AprilTag family 36h11")
    position: Point = spec(Position(), "where its middle is", instead=IN_DEGREES)
    heading_deg: float = spec(Number(), "where its upper edge is, from east, anticlockwise", default=0.0)
    size_m: float = spec(Number(above=0), "side of its black square", default=0.4)


@dataclass(frozen=True, kw_only=True)
class Found(_Checked):
    """What becomes of tags that cameras find."""

    becomes: Work = spec(Record(Work, "a task without id and position"), "the task that each becomes, at its place")
    tags: tuple[int, ...] | None = spec(
        Many(Whole(maximum=586), minimum=1), "of which tags; without it of all", default=None
    )


@dataclass(frozen=True, kw_only=True)
class MovedTask(_Checked):
    task: str = spec(Text(), "id of the task")
    position: Point = spec(Position(), "where it is from then on", instead=IN_DEGREES)


@dataclass(frozen=True, kw_only=True)
class DelayedTask(_Checked):
    task: str = spec(Text(), "id of the task")
    by_s: float = spec(Number(minimum=0), "how much longer it takes")


@dataclass(frozen=True, kw_only=True)
class Event(_Checked):
    """Something that happens while the mission is carried out: a time, and exactly one of the others."""

    at_s: float = spec(Number(minimum=0), "when")
    robot_fails: str | None = spec(Text(), "id of the robot", default=None)
    robot_silent: str | None = spec(Text(), "id of the robot", default=None)
    robot_returns: str | None = spec(Text(), "id of the robot", default=None)
    robot_joins: Robot | None = spec(Record(Robot, "a robot"), "the robot", default=None)
    new_task: Task | None = spec(Record(Task, "a task"), "the task", default=None)
    cancel_task: str | None = spec(Text(), "id of the task", default=None)
    move_task: MovedTask | None = spec(Record(MovedTask, "a task and its position"), "what moves", default=None)
    delay_task: DelayedTask | None = spec(Record(DelayedTask, "a task and its delay"), "what is late", default=None)

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        names = [f.name for f in specified(cls) if f.name != "at_s"]
        given = [name for name in names if values.get(name) is not None]
        if len(given) != 1:
            yield Fault((), ", ".join(given) or "no happening", f"exactly one of {', '.join(names)}")

    @classmethod
    def schema_extra(cls) -> JsonSchema:
        return {"minProperties": 2, "maxProperties": 2}


@dataclass(frozen=True)
class TravelTable:
    """Travel between places for one robot type: `metres[from][to]`, inf where there is no way."""

    places: tuple[str, ...]
    metres: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, kw_only=True)
class Mission(_Checked):
    """The question: robots, tasks, rules. A mission that exists is consistent.

    Raises
    ------
    MissionError
        when made from parts that do not fit together; it holds all findings.
    """

    schema: str = spec(Choice((SCHEMA,)), "the version of this format", default=SCHEMA)
    name: str = spec(Text(), "what it is called", default="mission")
    origin_wgs84: Origin | None = spec(Record(Origin, "an origin"), "where the map frame's origin is", default=None)
    rules: Rules = spec(Record(Rules, "rules"), "what counts, and how", default=Rules())
    map: Map | None = spec(Record(Map, "a map"), "walls and zones", default=None)
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
    travel_tables: Mapping[str, TravelTable] = field(default_factory=dict)
    source: Source = field(default=IN_PYTHON, compare=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        faults = list(inconsistencies(self))
        if faults:
            raise MissionError(findings(faults, self.source))

    def at_once(self, **changes: Any) -> Mission:
        """The mission, changed, without what happens or is found while it is carried out."""
        return replace(self, events=(), tags=(), found=(), **changes)

    @property
    def travel_rule(self) -> str:
        """How travel is measured: as the rules say, else by the map where there is one, else straight."""
        return self.rules.travel or ("euclidean" if self.map is None else "map")

    @property
    def dimensions(self) -> int:
        """2 or 3: how many coordinates the mission's positions have."""
        return len(self.robots[0].position)


def findings(faults: Iterable[Fault], source: Source) -> list[Finding]:
    """Faults as findings: with file and line, in the order of the files."""
    found = [Finding(*source.place(fault.path), path_text(fault.path), fault.value, fault.expected) for fault in faults]
    return sorted(found, key=lambda finding: (finding.file, finding.line or 0))


def path_text(path: Path) -> str:
    """`("tasks", 3, "position")` as `tasks[3].position`."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text and step else step
    return text
