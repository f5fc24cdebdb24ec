"""The answer: routes, the tasks left out with the reasons, and the figures. Immutable; `schema: muster-plan/1`."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.mission.auction_book import Award, Book
from muster.mission.data_frames import data_frame
from muster.mission.errors import Finding, MissionError, ParameterError, PlanError
from muster.mission.html_tables import html_line, html_table
from muster.mission.ignorable_rules import IGNORABLE, ignorable_rule, ignored_rules
from muster.mission.rules import OBJECTIVES
from muster.mission.text_files import read_text, write_text
from muster.mission.value_types import shown

if TYPE_CHECKING:
    from pandas import DataFrame

PLAN_SCHEMA = "muster-plan/1"
REASONS = (*IGNORABLE, "unreachable", "not-chosen")


@dataclass(frozen=True)
class RouteStop:
    """When a robot is at one task of its route: seconds from the start of the mission."""

    task: str
    arrive_s: float
    begin_s: float
    end_s: float


@dataclass(frozen=True)
class Route:
    """One robot's ordered tasks.

    A plan from elsewhere may have no `usage`, in the unit of the plan, and no `stops`; else these are the tasks again,
    with the times of the earliest schedule.
    """

    robot: str
    tasks: tuple[str, ...]
    usage: float | None = None
    stops: tuple[RouteStop, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """The route as plan files hold it."""
        data: dict[str, Any] = {"robot": self.robot, "tasks": list(self.tasks), "usage": self.usage}
        return data | ({"stops": [asdict(stop) for stop in self.stops]} if self.stops else {})


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

    Figures are None in a plan from elsewhere that does not state them. Of those stated here, `elapsed_s` and the
    seconds in `history` are times; all others are the same whenever mission, allocator, parameters and seed are.

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

    def as_dict(self) -> dict[str, Any]:
        """The plan as its file holds it."""
        data: dict[str, Any] = {"schema": PLAN_SCHEMA}
        for name, value in asdict(replace(self, book=None)).items():
            if name == "objective":
                data["objective"] = {"name": self.objective, "value": self.objective_value}
            elif name == "routes":
                data[name] = [route.as_dict() for route in self.routes]
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
        done = len({task for route in self.routes for task in route.tasks})
        value = "" if self.objective_value is None else f", {self.objective} {self.objective_value:.2f}"
        return f"<Plan of {self.mission or 'a mission'} by {self.allocator or 'hand'}: {done} tasks done{value}>"

    def _repr_html_(self) -> str:
        routes = [(route.robot, " ".join(route.tasks), route.usage) for route in self.routes]
        columns = ("robot", "tasks", f"usage ({self.usage_unit})" if self.usage_unit else "usage")
        text = html_line(repr(self)[1:-1]) + html_table("Routes", columns, routes)
        left_out = [(item.task, ", ".join(sorted({r.reason for r in item.reasons}))) for item in self.unassigned]
        return text + (html_table("Left out", ("task", "reasons"), left_out) if left_out else "")

    def to_frame(self) -> DataFrame:
        """A DataFrame with a row for each stop, in the order of the routes; needs the extra `frames`.

        Its columns are robot, place in its route from 1, task, and where the plan has times arrive_s, begin_s, end_s;
        those of a route whose stops are not its tasks are empty.
        """
        rows = (
            {"robot": route.robot, "place": place, "task": task} | times
            for route in self.routes
            for place, (task, times) in enumerate(zip(route.tasks, _times_of(route), strict=True), 1)
        )
        has_times = any(route.stops for route in self.routes)
        return data_frame(rows, ("robot", "place", "task", *(_TIMES if has_times else ())))


def _times_of(route: Route) -> list[dict[str, Any]]:
    """For each task of a route its times; none where the stops are not those of its tasks."""
    if tuple(stop.task for stop in route.stops) != route.tasks:
        return [{} for _ in route.tasks]
    return [asdict(stop) for stop in route.stops]


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


def read_plan(path: str | Path) -> Plan:
    """Read a plan file. One from elsewhere needs only `schema` and `routes`.

    Raises
    ------
    PlanError
        with everything that is wrong with the file; whether the plan is admissible is for `verify` to say.
    """
    file = Path(path)
    try:
        data = json.loads(read_text(file))
    except MissionError as error:
        raise PlanError(error.findings) from None
    except json.JSONDecodeError as error:
        raise PlanError([Finding(str(file), error.lineno, "", error.msg, "a plan in JSON")]) from None
    except (RecursionError, ValueError) as error:
        raise PlanError([Finding(str(file), None, "", shown(str(error)), "a plan in JSON")]) from None
    try:
        json.dumps(data, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        half = f"\\u{ord(error.object[error.start]):04x} alone in a text"
        raise PlanError([Finding(str(file), None, "", half, "whole characters")]) from None
    return plan_from(data, str(file))


def plan_from(data: object, file: str) -> Plan:
    """The plan in plain data, as its file holds it; `file` names it in messages.

    Raises
    ------
    PlanError
        with everything that is wrong with it.
    """
    return _Reading(file).plan(data)


def plan_of(given: Plan | Mapping[str, Any]) -> Plan:
    """A plan as it is; or the plan in a mapping: from robots to their tasks in order, or a plan file's content.

    Raises
    ------
    ParameterError
        if it is neither.
    PlanError
        with everything that is wrong with the mapping.
    """
    if isinstance(given, Plan):
        return given
    if not isinstance(given, Mapping):
        raise ParameterError(f"plan: {shown(given)}; expected a Plan, or a mapping from robots to lists of tasks")
    data = given if "schema" in given else {"schema": PLAN_SCHEMA, "routes": _routes_in(given)}
    return plan_from(json.loads(json.dumps(data, default=str)), "<plan>")


def _routes_in(given: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [{"robot": robot, "tasks": tasks} for robot, tasks in given.items()]


class _Reading:
    """Plain data to a Plan, with all that is wrong in one go."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._found: list[Finding] = []

    def plan(self, data: Any) -> Plan:
        if not isinstance(data, dict):
            raise PlanError(
                [Finding(self._file, None, "", shown(data), f"a mapping with schema: {PLAN_SCHEMA} and routes")]
            )
        if "schema" not in data:
            self._missing("schema", PLAN_SCHEMA)
        elif data["schema"] != PLAN_SCHEMA:
            self._refuse("schema", data["schema"], PLAN_SCHEMA)
        objective = self._given(data, "objective", dict, {})
        ignored = self._names(data.get("ignored", []), "ignored", f"a list of {', '.join(IGNORABLE)}")
        for name in ignored:
            if ignorable_rule(name) is None:
                self._refuse("ignored", name, " or ".join(IGNORABLE))
        if objective.get("name") not in (None, *OBJECTIVES):
            self._refuse("objective.name", objective["name"], " or ".join(OBJECTIVES))
        figures = (
            "total_cost",
            "max_usage",
            "makespan_s",
            "equality_index",
            "weight_completed",
            "lower_bound",
            "elapsed_s",
        )
        plan = Plan(
            mission=self._given(data, "mission", str),
            allocator=self._given(data, "allocator", str),
            seed=self._given(data, "seed", int),
            ignored=tuple(name for name in ignored if ignorable_rule(name) is not None),
            objective=objective.get("name") if objective.get("name") in OBJECTIVES else None,
            objective_value=self._number(objective, "value", "objective."),
            usage_unit=self._given(data, "usage_unit", str),
            tasks_completed=self._given(data, "tasks_completed", int),
            tasks_total=self._given(data, "tasks_total", int),
            routes=self._routes(data),
            unassigned=self._unassigned(data),
            history=self._history(data),
            book=self._book(data),
            **{name: self._number(data, name) for name in figures},
        )
        if self._found:
            raise PlanError(self._found)
        return plan

    def _missing(self, field: str, expected: str) -> None:
        self._found.append(Finding(self._file, None, field, "missing", expected))

    def _refuse(self, field: str, value: object, expected: str) -> None:
        self._found.append(Finding(self._file, None, field, shown(value), expected))

    def _given(self, data: Mapping[str, Any], name: str, kind: type, default: Any = None) -> Any:
        value = data.get(name)
        if value is None:
            return default
        if not isinstance(value, kind) or isinstance(value, bool):
            self._refuse(name, value, {str: "a text", int: "a whole number", dict: "a mapping", list: "a list"}[kind])
            return default
        return value

    def _number(self, data: Mapping[str, Any], name: str, at: str = "") -> float | None:
        value = data.get(name)
        if value is not None and not _finite(value):
            self._refuse(at + name, value, "a finite number")
            return None
        return value

    def _names(self, value: object, field: str, expected: str = "a list of ids") -> tuple[str, ...]:
        if not isinstance(value, list) or not all(map(_is_id, value)):
            self._refuse(field, value, expected)
            return ()
        return tuple(str(name) for name in value)

    def _routes(self, data: Mapping[str, Any]) -> tuple[Route, ...]:
        if "routes" not in data:
            self._missing("routes", "a list of routes")
        elif data["routes"] is None:
            self._refuse("routes", None, "a list of routes")
        routes = []
        for k, route in enumerate(self._given(data, "routes", list, [])):
            if not isinstance(route, dict) or not _is_id(route.get("robot")):
                self._refuse(f"routes[{k}]", route, "a mapping with robot and tasks")
                continue
            if "tasks" not in route:
                self._missing(f"routes[{k}].tasks", "a list of ids")
            tasks = self._names(route.get("tasks", []), f"routes[{k}].tasks")
            usage = self._number(route, "usage", f"routes[{k}].")
            routes.append(Route(str(route["robot"]), tasks, usage, self._stops(route.get("stops"), k)))
        return tuple(routes)

    def _stops(self, data: object, k: int) -> tuple[RouteStop, ...]:
        """The stops of a route; whether they are those of its tasks is for the judge to say."""
        if data is None or data == []:
            return ()
        if not isinstance(data, list):
            self._refuse(f"routes[{k}].stops", data, "a list of stops, one for each of its tasks")
            return ()
        before = len(self._found)
        for n, stop in enumerate(data):
            self._check_stop(stop, f"routes[{k}].stops[{n}]")
        if len(self._found) > before:
            return ()
        return tuple(RouteStop(str(stop["task"]), *(float(stop[name]) for name in _TIMES)) for stop in data)

    def _check_stop(self, stop: object, at: str) -> None:
        if not isinstance(stop, dict) or not _is_id(stop.get("task")):
            self._refuse(at, stop, f"a mapping with task, {', '.join(_TIMES)}")
            return
        for name in _TIMES:
            if not _finite(stop.get(name)):
                self._refuse(f"{at}.{name}", stop.get(name), "a finite number, in seconds")

    def _unassigned(self, data: Mapping[str, Any]) -> tuple[Unassigned, ...]:
        left_out = []
        for k, item in enumerate(self._given(data, "unassigned", list, [])):
            if not isinstance(item, dict) or not _is_id(item.get("task")):
                self._refuse(f"unassigned[{k}]", item, "a mapping with task and reasons")
                continue
            left_out.append(Unassigned(str(item["task"]), self._reasons(item.get("reasons", []), k)))
        return tuple(left_out)

    def _reasons(self, data: object, k: int) -> tuple[Reason, ...]:
        keys = ("robot", "reason", "detail")
        if not isinstance(data, list) or not all(
            isinstance(r, dict) and all(isinstance(r.get(x), str) for x in keys) for r in data
        ):
            self._refuse(f"unassigned[{k}].reasons", data, "a list of mappings with robot, reason and detail")
            return ()
        return tuple(Reason(r["robot"], r["reason"], r["detail"]) for r in data)

    def _history(self, data: Mapping[str, Any]) -> tuple[tuple[float, float], ...]:
        history = self._given(data, "history", list, [])
        if not all(isinstance(pair, list) and len(pair) == 2 and all(map(_finite, pair)) for pair in history):
            self._refuse("history", history, "a list of [seconds, objective]")
            return ()
        return tuple((float(seconds), float(value)) for seconds, value in history)

    def _book(self, data: Mapping[str, Any]) -> Book | None:
        if data.get("book") is None:
            return None
        awards = self._given(data, "book", list, [])
        right = [self._is_award(award, k) for k, award in enumerate(awards)]
        if not all(right):
            return None
        return Book(
            rounds=self._given(data, "rounds", int, 0),
            messages=self._given(data, "messages", int),
            awards=tuple(Award(**award | {"bids": tuple(award["bids"].items())}) for award in awards),
            done_twice={task: tuple(robots) for task, robots in self._given(data, "done_twice", dict, {}).items()},
        )

    def _is_award(self, award: object, k: int) -> bool:
        if not isinstance(award, dict) or award.keys() != _AWARD.keys():
            self._refuse(f"book[{k}]", award, f"a mapping with {', '.join(_AWARD)} and nothing else")
            return False
        wrong = [name for name, (fits, _) in _AWARD.items() if not fits(award[name])]
        for name in wrong:
            self._refuse(f"book[{k}].{name}", award[name], _AWARD[name][1])
        return not wrong


def _finite(value: object) -> bool:
    """Whether a value is a number that float64 can hold."""
    try:
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:
        return False


def _is_count(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_id(value: object) -> bool:
    return isinstance(value, str | int) and not isinstance(value, bool)


_TIMES = ("arrive_s", "begin_s", "end_s")

_AWARD: Mapping[str, tuple[Callable[[object], bool], str]] = {
    "round": (_is_count, "a whole number of at least 0"),
    "task": (_is_id, "an id"),
    "robot": (_is_id, "an id"),
    "price": (_finite, "a finite number"),
    "bids": (
        lambda bids: isinstance(bids, dict) and all(map(_finite, bids.values())),
        "a mapping from robot to number",
    ),
    "bidders": (_is_count, "a whole number of at least 0"),
}


def tie_order(names: Sequence[str]) -> list[int]:
    """Indices of ids in the order that breaks ties: numeric ids as numbers, then the others by code points."""
    return sorted(range(len(names)), key=lambda k: _tie_key(names[k]))


def _tie_key(name: str) -> tuple[int, int, str]:
    return (0, int(name), name) if name.isascii() and name.isdecimal() and len(name) < 4000 else (1, 0, name)
