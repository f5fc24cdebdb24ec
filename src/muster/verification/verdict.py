"""The verdict: the recomputed figures of a plan and its violations. Immutable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import TYPE_CHECKING, Any

from muster.mission.data_frames import data_frame
from muster.mission.errors import ParameterError
from muster.mission.html_tables import html_line, html_table
from muster.mission.ignorable_rules import IGNORABLE
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
        return sum(stop.starts_s - stop.arrives_s for route in self.routes for stop in route.stops)

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
        }

    def __repr__(self) -> str:
        return f"<Verdict: {self._summary}>"

    def _repr_html_(self) -> str:
        wrong = [(v.kind, v.robot, v.task, v.detail) for v in self.violations]
        routes = [(route.robot, " ".join(route.tasks), route.usage, route.capacity) for route in self.routes]
        columns = ("robot", "tasks", f"usage ({self.usage_unit})", "capacity")
        return (
            html_line(self._summary)
            + (html_table("Violations", ("kind", "robot", "task", "detail"), wrong) if wrong else "")
            + html_table("Routes", columns, routes)
        )

    @property
    def _summary(self) -> str:
        count = len(self.violations)
        judgement = "valid" if self.valid else f"{count} violation{'' if count == 1 else 's'}"
        value = self.value()
        figure = "no schedule" if value is None else f"{self.objective_name} {value:.2f}"
        return f"{judgement}, {self.tasks_completed} of {self.tasks_total} tasks, {figure}"

    def to_frame(self) -> DataFrame:
        """A DataFrame with a row for each visit of a task: robot, task and times; needs the extra `frames`."""
        rows = ({"robot": route.robot, **asdict(visit)} for route in self.routes for visit in route.visits)
        return data_frame(rows, ("robot", *(f.name for f in fields(Visit))))
