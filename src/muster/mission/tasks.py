"""The tasks of a mission, and their actions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any, Self

from muster.mission.action_keys import ACTION_KEYS, WITH_AREA, coverage_faults
from muster.mission.cooperation import Lag, Prerequisite, PrerequisiteOrId, TeamPart
from muster.mission.errors import MissionError
from muster.mission.goods import Amount, Amounts
from muster.mission.place_types import Corners, Place
from muster.mission.records import Checked, Record, findings, record, spec
from muster.mission.rule_keys import RuleKeys
from muster.mission.site import IN_DEGREES, Point
from muster.mission.source import IN_PYTHON
from muster.mission.value_types import (
    Choice,
    Fault,
    Flag,
    Key,
    Many,
    Number,
    OneOrMany,
    Position,
    Table,
    Text,
    Whole,
    shown,
)
from muster.mission.values.clock_times import DEADLINE, DUE, WINDOW
from muster.mission.values.time_types import Window, Windows


def _is_given(value: object) -> bool:
    """Return whether a value of an action's key is one; 0 is."""
    return not (value is None or value is False or value == ())


@record
class Action(Checked):
    """What a robot does at a task."""

    name: str = spec(Choice(ACTION_KEYS.keys()), "which action")
    area: tuple[Point, ...] | None = spec(Corners(), "coverage: corners in order", default=None)
    holes: tuple[tuple[Point, ...], ...] = spec(
        Many(Corners()), "coverage: parts of the area that need not be seen, each by its corners", default=()
    )
    cross_holes: bool = spec(Flag(), "coverage: whether a robot may cross holes", default=False)
    width_m: float | None = spec(
        Number(above=0), "stationary-observation: width in view; coverage: width of the tool", default=None
    )
    fov_deg: float | None = spec(
        Number(above=0, below=180),
        "coverage: field of view across the lanes, straight down, in place of the robot's camera",
        default=None,
    )
    heading_deg: float | None = spec(
        Number(),
        "stationary-observation: direction of view, 0 if absent; coverage: of the lanes, the best if absent",
        default=None,
    )
    side_m: float | None = spec(Number(above=0), "raster-search, ground-patrol: side of the square", default=None)
    height_m: float | None = spec(Number(above=0), "raster-search, coverage: height of flight", default=None)
    spacing_m: float | None = spec(
        Number(above=0), "raster-search: distance between lanes; without it from the camera's footprint", default=None
    )
    overlap: float | None = spec(
        Number(minimum=0, below=1),
        "raster-search, coverage: share of what is seen that lanes share, 0.1 if absent; of a tool 0",
        default=None,
    )
    front_overlap: float | None = spec(
        Number(minimum=0, below=1), "coverage: share of a picture that the next one shares, for exports", default=None
    )
    pickup: Point | None = spec(Place(), "delivery: where the load is taken up", default=None)
    duration_s: float | None = spec(Number(minimum=0), "sensor-activation: time it takes", default=None)
    split: int | None = spec(Whole(minimum=1, maximum=1000), "coverage: into how many tasks it is split", default=None)
    part: int | None = spec(Whole(minimum=1), "coverage: which part of a split area, from 1", default=None)

    extra: Mapping[str, Any] = field(default_factory=dict, hash=False)
    """Values of the keys that a package gives an action of its own; in files they stand beside the others."""

    def __post_init__(self) -> None:
        faults: list[Fault] = []
        kinds = ACTION_KEYS[self.name].own if self.name in ACTION_KEYS else {}
        read = {key: kinds[key].kind.read(value, (key,), faults) for key, value in self.extra.items() if key in kinds}
        if faults:
            raise MissionError(findings(faults, IN_PYTHON))
        object.__setattr__(self, "extra", dict(self.extra) | read)
        super().__post_init__()

    @property
    def has_geometry(self) -> bool:
        """Whether the action's cost follows from way points, not from a typed number."""
        return ACTION_KEYS[self.name].has_geometry

    @property
    def places(self) -> dict[str, Point]:
        """The places that the action names, by key."""
        own = ACTION_KEYS[self.name].own if self.name in ACTION_KEYS else {}
        extra = {key: point for key, point in self.extra.items() if isinstance(own[key].kind, Position)}
        return extra if self.pickup is None else {"pickup": self.pickup} | extra

    def value(self, key: str) -> Any:
        """The value of a key, a field or one of `extra`; None where the mission gives none."""
        return self.extra[key] if key in self.extra else getattr(self, key, None)

    @classmethod
    def further_keys(cls, data: Mapping[Any, Any]) -> Mapping[str, Key]:
        name = data.get("name")
        return ACTION_KEYS[name].own if isinstance(name, str) and name in ACTION_KEYS else {}

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        name, extra = values["name"], values.get("extra", {})
        keys = ACTION_KEYS[name]
        given = {
            *extra,
            *(key for key, value in values.items() if _is_given(value) and key not in ("name", "extra")),
        }
        for key in keys.needed:
            if key not in given:
                yield Fault((key,), "missing", f"a value: {name} needs {', '.join(keys.needed)}")
        if name == "coverage":
            yield from coverage_faults(values)
        if name == "raster-search" and {"spacing_m", "overlap"} <= given:
            yield Fault(("overlap",), shown(values["overlap"]), "spacing_m or overlap, not both")
        for key in sorted(given.difference(keys.names)):
            yield Fault((key,), "unknown key", f"the keys of {name}: {', '.join(keys.names) or 'none'}")


@record
class Work(RuleKeys, bearer="task"):
    """What there is to do, wherever that is."""

    type: str | None = spec(Text(), "column of the suitability table", default=None)
    actuation_cost: float = spec(Number(minimum=0), "cost of doing it", unit="unit of usage", default=0.0)
    prerequisites: tuple[str, ...] = spec(
        Many(PrerequisiteOrId()),
        "ids of tasks that must be done before; with a lag {task, after_s, within_s}",
        default=(),
    )
    window_s: tuple[Window, ...] = spec(
        Windows(), "when work may begin: [from, until], or several such pairs", default=(), instead=WINDOW, if_used=True
    )
    deadline_s: float | None = spec(
        Number(minimum=0), "when it must have ended", default=None, instead=DEADLINE, if_used=True
    )
    due_s: float | None = spec(
        Number(minimum=0),
        "when it should have ended, for the objective lateness",
        default=None,
        instead=DUE,
        if_used=True,
    )
    requires: tuple[str, ...] = spec(Many(Text()), "skills a robot must have", default=())
    robots_needed: int | None = spec(Whole(minimum=1), "how many robots do it together", default=None, if_used=True)
    team: tuple[TeamPart, ...] = spec(
        Many(Record(TeamPart, "a part of a team")),
        "the robots that do it together, by what they must be",
        default=(),
        if_used=True,
    )
    needs: Mapping[str, float] | None = spec(
        Table(Number(above=0), "a mapping from abilities to amounts"),
        "what the abilities of the robots that do it together must sum to",
        default=None,
        if_used=True,
    )
    same_robot_as: tuple[str, ...] = spec(
        OneOrMany(Text()), "ids of tasks that the same robot does", default=(), if_used=True
    )
    other_robot_than: tuple[str, ...] = spec(
        OneOrMany(Text()), "ids of tasks that another robot does", default=(), if_used=True
    )
    starts_with: tuple[str, ...] = spec(
        OneOrMany(Text()), "ids of tasks that other robots begin at the same moment", default=(), if_used=True
    )
    either_or: tuple[str, ...] = spec(
        OneOrMany(Text()),
        "ids of tasks in whose place it is done: of all that are tied so at most one is",
        default=(),
        if_used=True,
    )
    load: Amount | None = spec(
        Amounts(), "what it takes on board, or by commodity; below 0: puts down", default=None, if_used=True
    )
    delivers: str | None = spec(
        Text(), "id of the task whose load the same robot puts down here", default=None, if_used=True
    )
    longest_aboard_s: float | None = spec(
        Number(minimum=0),
        "longest time from the end of the task that it delivers to its own begin",
        default=None,
        if_used=True,
        beside="delivers",
    )
    duration_s: float | None = spec(Number(minimum=0), "time it takes a robot of efficiency 1", default=None)
    within_m: float | None = spec(
        Number(above=0),
        "how far from its true place it may be done, where the world knows that; by default by its action",
        default=None,
        if_used=True,
    )
    priority: float = spec(Number(above=0), "weight among the tasks completed", default=1.0)
    only_robots: tuple[str, ...] | None = spec(
        Many(Text(), minimum=1), "ids of the only robots that may do it", default=None
    )
    action: Action | None = spec(Record(Action, "an action"), "what the robot does there", default=None)
    across_partition: str = spec(
        Choice(("at-least-once", "at-most-once")), "what a split network may do to it", default="at-least-once"
    )

    lags: Mapping[str, Lag] = field(default_factory=dict, hash=False)
    """By prerequisite, those that have one; in files they stand inside `prerequisites`."""

    tied = frozenset(
        {"prerequisites", "lags", "robots_needed", "team", "needs", "load", "delivers", "longest_aboard_s", "action"}
    )

    @property
    def is_for_team(self) -> bool:
        """Whether more robots than one may have to do it."""
        return (self.robots_needed or 1) > 1 or bool(self.team) or bool(self.needs)

    def is_open_to(self, robot: str) -> bool:
        """Whether a robot, by id, is one of those that may do it."""
        return self.only_robots is None or robot in self.only_robots

    def only_for(self, robot: str) -> Self:
        """The same work, which this robot alone may do."""
        return self.changed(only_robots=(robot,))

    def lag(self, prerequisite: str) -> Lag:
        """How long after the end of a prerequisite work begins."""
        return self.lags.get(prerequisite, Lag())

    def waiting_for(self, prerequisites: Iterable[str]) -> Self:
        """The same work with only those prerequisites, and their lags."""
        kept = tuple(prerequisites)
        if kept == self.prerequisites:
            return self
        return self.changed(prerequisites=kept, lags={name: lag for name, lag in self.lags.items() if name in kept})

    @classmethod
    def settled(cls, values: Mapping[str, Any]) -> Mapping[str, Any]:
        given = values.get("prerequisites", ())
        if not isinstance(values.get("lags", {}), Mapping):
            return {}
        lags = dict(values.get("lags", {}))
        for one in given:
            if isinstance(one, Prerequisite):
                lags[one.task] = Lag(after_s=one.after_s, within_s=one.within_s)
        ids = tuple(one.task if isinstance(one, Prerequisite) else one for one in given)
        return {"prerequisites": ids, "lags": {name: lag for name, lag in lags.items() if lag != Lag()}}

    def file_values(self) -> Mapping[str, Any]:
        return {"prerequisites": tuple(self._prerequisite(name) for name in self.prerequisites)}

    def _prerequisite(self, name: str) -> Prerequisite | str:
        lag = self.lags.get(name)
        return name if lag is None else Prerequisite(task=name, after_s=lag.after_s, within_s=lag.within_s)

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        yield from _team_faults(values)
        yield from _goods_faults(values)
        yield from _lag_faults(values.get("lags", {}), values.get("prerequisites", ()))
        action = values.get("action")
        if action is not None and action.has_geometry and values.get("actuation_cost"):
            cost = shown(values["actuation_cost"])
            yield Fault(("actuation_cost",), cost, f"no typed cost beside {action.name}, whose cost is computed")
        if action is not None and action.duration_s is not None and values.get("duration_s") is not None:
            yield Fault(("duration_s",), shown(values["duration_s"]), f"no second duration beside {action.name}")


def _lag_faults(lags: object, prerequisites: tuple[str, ...]) -> Iterable[Fault]:
    if not isinstance(lags, Mapping):
        yield Fault(("lags",), shown(lags), "a mapping from prerequisites to lags")
        return
    for name, lag in lags.items():
        if name not in prerequisites:
            yield Fault(("lags", name), shown(name), "one of its prerequisites")
        elif not isinstance(lag, Lag):
            yield Fault(("lags", name), shown(lag), "a muster.Lag")


def _team_faults(values: Mapping[str, Any]) -> Iterable[Fault]:
    ways = [name for name in ("robots_needed", "team", "needs") if values.get(name)]
    if len(ways) > 1:
        yield Fault((ways[1],), f"beside {ways[0]}", "at most one of robots_needed, team, needs")


def _goods_faults(values: Mapping[str, Any]) -> Iterable[Fault]:
    many = (values.get("robots_needed") or 1) > 1 or values.get("team") or values.get("needs")
    for name in ("load", "delivers"):
        if many and values.get(name) is not None:
            yield Fault((name,), shown(values[name]), "a task for one robot: goods are on board of one")
    longest = values.get("longest_aboard_s")
    if longest is not None and values.get("delivers") is None:
        yield Fault(("longest_aboard_s",), shown(longest), "delivers beside it: whose load is on board so long")


@record
class _Placed(Checked):
    """What comes first of a task."""

    id: str = spec(Text(), "unique among the tasks")
    position: Point = spec(Position(), "where it is", instead=IN_DEGREES, unless=WITH_AREA)


@record
class Task(Work, _Placed):
    """One piece of work at a place."""

    entry: Point | None = spec(Place(), "where a robot arrives; without it the position", default=None)
    exit: Point | None = spec(Place(), "where a robot leaves; without it the position", default=None)


@record
class Found(Checked):
    """What becomes of tags that cameras find."""

    becomes: Work = spec(Record(Work, "a task without id and position"), "the task that each becomes, at its place")
    tags: tuple[int, ...] | None = spec(
        Many(Whole(maximum=586), minimum=1), "of which tags; without it of all", default=None
    )
