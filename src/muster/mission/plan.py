"""The answer: routes, the tasks left out with the reasons, and the figures. Immutable; `schema: muster-plan/1`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.auction_book import Book
from muster.mission.errors import CutShortError
from muster.mission.ignorable_rules import IGNORABLE, ignored_rules
from muster.mission.stations import Station, station_sign
from muster.mission.tables import data_frame, html_line, html_table
from muster.mission.texts.text_files import write_text

if TYPE_CHECKING:
    from pandas import DataFrame

PLAN_SCHEMA = "muster-plan/1"
REASONS = (*IGNORABLE, "unreachable", "not-chosen")
STOP_TIMES = ("arrive_s", "begin_s", "end_s")
"""The times of a stop, as plan files name them."""
_TRAFFIC_TIMES = ("time_with_traffic_s", "time_without_traffic_s")


@dataclass(frozen=True)
class RouteStop:
    """When a robot is at one stop of its route: seconds from the start of the mission.

    `name` is the id of the task or station.
    `charged` is what a charge at the station adds, in the unit of usage; None: the battery is filled, or not charged.
    """

    name: str
    arrive_s: float
    begin_s: float
    end_s: float
    is_station: bool = False
    charged: float | None = None

    @classmethod
    def at_station(cls, station: Station, arrive_s: float, begin_s: float, end_s: float, filled: float) -> RouteStop:
        """A call at a station that adds so much."""
        charged = filled if station.charges else None
        return cls(station.id, arrive_s, begin_s, end_s, is_station=True, charged=charged)

    @property
    def said_of_station(self) -> str:
        """What a robot does at a station."""
        return "a call" if self.charged is None else "a charge"

    @property
    def task(self) -> str | None:
        """The id of the task; None: a station."""
        return None if self.is_station else self.name

    @property
    def station(self) -> str | None:
        """The id of the station; None: a task."""
        return self.name if self.is_station else None

    def as_dict(self) -> dict[str, Any]:
        """The stop as plan files hold it."""
        place = {"station" if self.is_station else "task": self.name}
        charged = {} if self.charged is None else {"charged": self.charged}
        return place | {name: getattr(self, name) for name in STOP_TIMES} | charged


@dataclass(frozen=True)
class Route:
    """One robot's ordered tasks, and the stations between them.

    A plan from elsewhere may have no `usage`, in the unit of the plan, and no `stops`; else these are the tasks and
    stations again, with the times of the earliest schedule.
    """

    robot: str
    tasks: tuple[str, ...]
    usage: float | None = None
    stops: tuple[RouteStop, ...] = ()

    @property
    def stations(self) -> frozenset[str]:
        """The ids of the stations in it, as far as its stops tell."""
        return frozenset(stop.name for stop in self.stops if stop.is_station)

    @property
    def order(self) -> tuple[str, ...]:
        """Its tasks and, in brackets, its stations in order."""
        return tuple(station_sign(name) if name in self.stations else name for name in self.tasks)

    def as_dict(self) -> dict[str, Any]:
        """The route as plan files hold it."""
        data: dict[str, Any] = {"robot": self.robot, "tasks": list(self.tasks), "usage": self.usage}
        return data | ({"stops": [stop.as_dict() for stop in self.stops]} if self.stops else {})


@dataclass(frozen=True)
class Reason:
    """Why one robot does not do a task; `reason` is one of REASONS."""

    robot: str
    reason: str
    detail: str


@dataclass(frozen=True)
class Unassigned:
    """A task left out, and why each robot does not do it."""

    task: str
    reasons: tuple[Reason, ...]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The answer to a mission.

    Figures are None in a plan from elsewhere that does not state them. The times with and without traffic are a
    forecast of when all robots have ended their routes, ways home included, where they pass in turn; None where they
    do not. `cut_short` says that planning was ended before it had looked at every task that is left out, so that the
    plan is a part of one; files have it only where it is true. Of the figures, `elapsed_s` and the seconds in `history`
    are times; all others are the same whenever mission, allocator, parameters and seed are.

    Raises
    ------
    ParameterError
        for an unknown rule in `ignored`.
    """

    mission: str | None = None
    allocator: str | None = None
    seed: int | None = None
    ignored: tuple[str, ...] = ()
    objective: str | None = None
    objective_value: float | None = None
    usage_unit: str | None = None
    total_cost: float | None = None
    max_usage: float | None = None
    makespan_s: float | None = None
    equality_index: float | None = None
    tasks_completed: int | None = None
    tasks_total: int | None = None
    weight_completed: float | None = None
    lower_bound: float | None = None
    elapsed_s: float | None = None
    cut_short: bool = False
    time_with_traffic_s: float | None = None
    time_without_traffic_s: float | None = None
    routes: tuple[Route, ...]
    unassigned: tuple[Unassigned, ...] = ()
    history: tuple[tuple[float, float], ...] = ()
    book: Book | None = None  # of an auction

    def __post_init__(self) -> None:
        object.__setattr__(self, "ignored", ignored_rules(self.ignored))

    @property
    def complete(self) -> bool:
        """Whether no task is left out, by the plan's own figures where it states them."""
        if self.tasks_completed is not None and self.tasks_total is not None:
            return self.tasks_completed == self.tasks_total
        return not self.unassigned

    @property
    def cut_short_line(self) -> str:
        """What there is to say of a plan that was cut short; empty of others."""
        return f"planning was cut short: {self.planned_line}" if self.cut_short else ""

    @property
    def planned_line(self) -> str:
        """How many tasks are planned, in words."""
        done = len({task for route in self.routes for task in route.tasks if task not in route.stations})
        of_all = "" if self.tasks_total is None else f" of {self.tasks_total}"
        return f"{done}{of_all} tasks are planned"

    def require_whole(self, *, accept_partial: bool = False) -> None:
        """Raise for a plan that planning did not finish, unless a part of one is accepted.

        Raises
        ------
        CutShortError
            if the plan was cut short.
        """
        if self.cut_short and not accept_partial:
            expected = "more time (--time-limit), or that a part is accepted (--accept-partial, accept_partial=True)"
            raise CutShortError(f"{self.cut_short_line}; nothing was started; expected {expected}")

    def as_dict(self) -> dict[str, Any]:
        """The plan as its file holds it."""
        data: dict[str, Any] = {"schema": PLAN_SCHEMA}
        for name, value in ((f.name, getattr(self, f.name)) for f in fields(self)):
            if name == "objective":
                data["objective"] = {"name": self.objective, "value": self.objective_value}
            elif name == "routes":
                data[name] = [route.as_dict() for route in self.routes]
            elif name == "unassigned":
                data[name] = tuple(asdict(left_out) for left_out in self.unassigned)
            elif (name in _TRAFFIC_TIMES and value is None) or (name == "cut_short" and not value):
                continue
            elif name not in ("objective_value", "book"):
                data[name] = value
        if self.book is not None:
            data |= {"rounds": self.book.rounds, "messages": self.book.messages}
            if self.book.done_twice:
                data["done_twice"] = {task: list(robots) for task, robots in self.book.done_twice.items()}
            data["book"] = [award.as_dict() for award in self.book.awards]
        return data

    def text(self) -> str:
        """The plan as JSON; one line a route."""
        return json_text(self.as_dict())

    def save(self, path: str | Path) -> None:
        """Write the plan as JSON."""
        write_text(Path(path), self.text())

    def __repr__(self) -> str:
        done = len({task for route in self.routes for task in route.tasks if task not in route.stations})
        value = "" if self.objective_value is None else f", {self.objective} {self.objective_value:.2f}"
        cut = ", cut short" if self.cut_short else ""
        return f"<Plan of {self.mission or 'a mission'} by {self.allocator or 'hand'}{cut}: {done} tasks done{value}>"

    def _repr_html_(self) -> str:
        routes = [(route.robot, " ".join(route.order), route.usage) for route in self.routes]
        columns = ("robot", "tasks", f"usage ({self.usage_unit})" if self.usage_unit else "usage")
        text = html_line(repr(self)[1:-1]) + html_table("Routes", columns, routes) + self._times_html()
        left_out = [(item.task, ", ".join(sorted({r.reason for r in item.reasons}))) for item in self.unassigned]
        return text + (html_table("Left out", ("task", "reasons"), left_out) if left_out else "")

    def _times_html(self) -> str:
        """A row for each stop, with the robots that are there together; empty where the plan has no times."""
        if not any(route.stops for route in self.routes):
            return ""
        team = teams_of((route.robot, route.tasks) for route in self.routes)
        rows = [
            (route.robot, shown, *map(times.get, STOP_TIMES), _with_whom(route, name, team), times["charged"])
            for route in self.routes
            for name, shown, times in zip(route.tasks, route.order, _times_of(route), strict=True)
            if times
        ]
        stop = "stop" if any(route.stations for route in self.routes) else "task"
        columns = ("robot", stop, "arrives (s)", "begins (s)", "ends (s)", "with", "charged")
        used = len(columns) - (not any(row[-1] is not None for row in rows))
        return html_table("Times", columns[:used], [row[:used] for row in rows])

    def to_frame(self) -> DataFrame:
        """A DataFrame with a row for each stop, in the order of the routes; needs the extra `frames`.

        Its columns are robot, place in its route from 1, task, and where the plan has times arrive_s, begin_s, end_s;
        those of a route whose stops are not its tasks are empty. With stops at stations there are station and charged.
        """
        rows = [row for route in self.routes for row in _frame_rows(route)]
        times = STOP_TIMES if any(route.stops for route in self.routes) else ()
        to_stations = any(route.stations for route in self.routes)
        columns = ("robot", "place", "task", *(("station",) if to_stations else ()), *times)
        return data_frame(rows, (*columns, *(("charged",) if to_stations else ())))


def teams_of(routes: Iterable[tuple[str, Iterable[str]]]) -> dict[str, list[str]]:
    """For each task in routes, which are robots with their tasks, the robots that do it."""
    teams: dict[str, list[str]] = {}
    for robot, tasks in routes:
        for task in tasks:
            teams.setdefault(task, []).append(robot)
    return teams


def _frame_rows(route: Route) -> Iterator[dict[str, Any]]:
    """For each stop of a route the values of a frame's columns."""
    for place, (name, times) in enumerate(zip(route.tasks, _times_of(route), strict=True), 1):
        at = {"task": None, "station": name} if name in route.stations else {"task": name, "station": None}
        yield {"robot": route.robot, "place": place, **at, **times}


def _with_whom(route: Route, name: str, team: Mapping[str, Sequence[str]]) -> str:
    """The other robots of a task's team; nobody at a station."""
    return "" if name in route.stations else ", ".join(one for one in team[name] if one != route.robot)


def _times_of(route: Route) -> list[dict[str, Any]]:
    """For each stop of a route its times, and what it charges; none where the stops are not those of its tasks."""
    if tuple(stop.name for stop in route.stops) != route.tasks:
        return [{} for _ in route.tasks]
    return [{name: getattr(stop, name) for name in (*STOP_TIMES, "charged")} for stop in route.stops]


def gap(value: float, bound: float) -> float:
    """How far a plan with that objective may be from the best one at most, as a share: (value - bound) / value."""
    return (value - bound) / value if value > 0 else 0.0


def json_text(data: Mapping[str, Any]) -> str:
    """A mapping as JSON: a line for each key, and for each item of a list of records."""
    lines = []
    for key, value in data.items():
        if isinstance(value, list | tuple) and value and isinstance(value[0], dict | list | tuple):
            items = ",\n  ".join(json.dumps(item, ensure_ascii=False) for item in value)
            lines.append(f" {json.dumps(key)}: [\n  {items}]")
        else:
            lines.append(f" {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def tie_order(names: Sequence[str]) -> list[int]:
    """Indices of ids in the order that breaks ties: numeric ids as numbers, then the others by code points."""
    return sorted(range(len(names)), key=lambda k: _tie_key(names[k]))


def _tie_key(name: str) -> tuple[int, int, str]:
    return (0, int(name), name) if name.isascii() and name.isdecimal() and len(name) < 4000 else (1, 0, name)
