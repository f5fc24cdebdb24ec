"""The verdict: the recomputed figures of a plan and its violations. Immutable."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.goods import ONLY
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.stations import station_sign
from muster.mission.tables import data_frame, html_line, html_table
from muster.mission.texts.counting import counted
from muster.mission.value_types import shown

if TYPE_CHECKING:
    from pandas import DataFrame

KINDS = (
    "mission",
    "unknown-robot",
    "unknown-task",
    "repeated-robot",
    "repeated-task",
    *IGNORABLE,
    "action",
    "closed-area",
    "unreachable",
    "deadlock",
    "unassigned",
    "reason",
    "book",
    "objective",
    "figure",
    "stop",
    "history",
)
"""The kinds of violation."""


@dataclass(frozen=True)
class Violation:
    """One thing that is wrong with a plan; `kind` is one of KINDS, robot and task are ids where they are meant."""

    kind: str
    robot: str | None
    task: str | None
    detail: str


@dataclass(frozen=True)
class Visit:
    """One task of a route in time, seconds; and the usage when the robot arrives, the task's own cost not counted."""

    task: str
    arrives_s: float
    starts_s: float
    ends_s: float
    arrival_usage: float


@dataclass(frozen=True)
class Stop:
    """One stop of a route, at a task or a station, in time: seconds.

    `arrival_level` and `level_after` are what the battery holds on arrival and at the end of work or service, and
    `charged` is what a station added, in the unit of usage; None for a robot without a battery, and `charged` also
    where nothing is charged. `load_after` is what is on board then, by commodity.
    """

    name: str
    is_station: bool
    arrives_s: float
    starts_s: float
    ends_s: float
    arrival_level: float | None = None
    level_after: float | None = None
    charged: float | None = None
    load_after: Mapping[str, float] = field(default_factory=dict, hash=False)

    @property
    def shown(self) -> str:
        """The id, that of a station in brackets."""
        return station_sign(self.name) if self.is_station else self.name

    @property
    def waits_s(self) -> float:
        """How long the robot waits: for a window, a team, a prerequisite or a slot."""
        return self.starts_s - self.arrives_s


@dataclass(frozen=True)
class RouteFigures:
    """One robot's route, recomputed.

    `travel`, `work`, `usage` (their sum) and `capacity` are in the unit of usage. `capacity` is what the robot may
    use, the reserve taken off; None where it is unlimited or ignored. `visits` are those of tasks, and `stops` those of
    tasks and stations, in order. Both are empty, and `back_s` None, where the plan has no schedule because of a
    deadlock. `back_s` is when the robot is where its route must end; None where it may end anywhere, or stays because
    its route has no stops.
    """

    robot: str
    tasks: tuple[str, ...]
    travel: float
    work: float
    usage: float
    capacity: float | None
    leaves_s: float
    visits: tuple[Visit, ...]
    back_s: float | None
    stops: tuple[Stop, ...] = ()

    @property
    def order(self) -> tuple[str, ...]:
        """Its tasks and, in brackets, its stations in order; without a schedule its tasks alone."""
        return tuple(stop.shown for stop in self.stops) or self.tasks

    @property
    def charged(self) -> float:
        """What stations add to the robot's battery, in the unit of usage."""
        return sum(stop.charged or 0.0 for stop in self.stops)


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """The judgement of one plan.

    `total_cost`, `max_usage` and `average` are in `usage_unit`. `makespan_s` and `lateness` are None where routes and
    prerequisites deadlock. `ignored` are the rules that the caller had ignored. `routes` holds every robot, in mission
    order. All numbers are finite. `reasons_undecided` counts the reasons for tasks left out of which it was not
    decided whether they are true.
    """

    violations: tuple[Violation, ...]
    objective_name: str
    ignored: tuple[str, ...]
    usage_unit: str
    total_cost: float
    max_usage: float
    average: float
    makespan_s: float | None
    lateness: float | None
    equality_index: float
    tasks_completed: int
    tasks_total: int
    weight_completed: float
    routes: tuple[RouteFigures, ...]
    reasons_undecided: int = 0

    @property
    def valid(self) -> bool:
        """Whether nothing is wrong with the plan."""
        return not self.violations

    @property
    def first_violations(self) -> str:
        """What is wrong with the plan, in one line: three violations at most."""
        return "; ".join(f"{found.kind} {found.detail}" for found in self.violations[:3])

    @property
    def waiting_s(self) -> float | None:
        """How long robots wait at tasks and stations, in all; None where they deadlock."""
        if self.makespan_s is None:
            return None
        return sum(stop.waits_s for route in self.routes for stop in route.stops)

    @property
    def station_visits(self) -> int:
        """How often robots are at stations."""
        return sum(stop.is_station for route in self.routes for stop in route.stops)

    @property
    def charged(self) -> float:
        """What stations add to all batteries, in the unit of usage."""
        return sum(route.charged for route in self.routes)

    def value(self, name: str | None = None) -> float | None:
        """Return the value of an objective, by default the one judged by; None for a time of a deadlocked plan.

        Raises
        ------
        ParameterError
            if there is no objective of that name.
        """
        values = {
            "total": self.total_cost,
            "max": self.max_usage,
            "total+max": self.total_cost + self.max_usage,
            "average": self.average,
            "makespan": self.makespan_s,
            "lateness": self.lateness,
        }
        name = self.objective_name if name is None else name
        if name not in values:
            raise ParameterError(f"objective: {shown(name)}; expected {' or '.join(values)}")
        return values[name]

    def as_dict(self) -> dict[str, Any]:
        """Return what `muster verify --format json` prints; `objective` is the value."""
        return {
            "valid": self.valid,
            "violations": [asdict(violation) for violation in self.violations],
            "ignored": list(self.ignored),
            "objective_name": self.objective_name,
            "objective": self.value(),
            "usage_unit": self.usage_unit,
            "total_cost": self.total_cost,
            "max_usage": self.max_usage,
            "average": self.average,
            "makespan_s": self.makespan_s,
            "lateness": self.lateness,
            "equality_index": self.equality_index,
            "tasks_completed": self.tasks_completed,
            "tasks_total": self.tasks_total,
            "weight_completed": self.weight_completed,
            "reasons_undecided": self.reasons_undecided,
            "station_visits": self.station_visits,
            "charged": self.charged,
        }

    def __repr__(self) -> str:
        return f"<Verdict: {self._summary}>"

    def _repr_html_(self) -> str:
        wrong = [(v.kind, v.robot, v.task, v.detail) for v in self.violations]
        routes = [(route.robot, " ".join(route.order), route.usage, route.capacity) for route in self.routes]
        columns = ("robot", "tasks", f"usage ({self.usage_unit})", "capacity")
        return (
            html_line(self._summary)
            + (html_table("Violations", ("kind", "robot", "task", "detail"), wrong) if wrong else "")
            + html_table("Routes", columns, routes)
        )

    @property
    def _summary(self) -> str:
        judgement = "valid" if self.valid else counted(len(self.violations), "violation")
        value = self.value()
        figure = "no schedule" if value is None else f"{self.objective_name} {value:.2f}"
        return f"{judgement}, {self.tasks_completed} of {self.tasks_total} tasks, {figure}"

    def to_frame(self) -> DataFrame:
        """A DataFrame with a row for each stop; needs the extra `frames`.

        Its columns are robot, task, station, times and the usage at the arrival at a task. A plan that has to do with
        batteries or goods has their columns too, as `Stop` names them.
        """
        rows = [row for route in self.routes for row in _frame_rows(route)]
        columns = ["robot", "task", "station", *(f.name for f in fields(Visit) if f.name != "task")]
        used = [name for name in _OF_STOPS if any(row[name] for row in rows)]
        return data_frame(rows, (*columns, *used))


_OF_STOPS = ("arrival_level", "level_after", "charged", "load_after")


def _frame_rows(route: RouteFigures) -> Iterator[dict[str, Any]]:
    """The rows of a route: its stops, those at tasks with the usage at the arrival."""
    visits = iter(route.visits)
    for stop in route.stops:
        usage = None if stop.is_station else next(visits).arrival_usage
        place = {"task": None, "station": stop.name} if stop.is_station else {"task": stop.name, "station": None}
        values = {name: value for name, value in asdict(stop).items() if name not in ("name", "is_station")}
        yield {"robot": route.robot, **place, "arrival_usage": usage, **values, "load_after": _load(stop.load_after)}


def _load(by_commodity: Mapping[str, float]) -> float | Mapping[str, float]:
    """A number where there is nothing, or the only commodity, which has no name."""
    return by_commodity.get(ONLY, 0.0) if by_commodity.keys() <= {ONLY} else by_commodity
