"""Reads plans: from files, from plain data, and from mappings that a program has."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from muster.mission.auction_book import Award, Book
from muster.mission.errors import Finding, MissionError, ParameterError, PlanError
from muster.mission.ignorable_rules import IGNORABLE, ignorable_rule
from muster.mission.model import Mission
from muster.mission.plan import PLAN_SCHEMA, STOP_TIMES, Plan, Reason, Route, RouteStop, Unassigned
from muster.mission.reading.mistaken_files import MISSION_AS_PLAN, is_mission
from muster.mission.rules import OBJECTIVES
from muster.mission.system.plugins import Registry, function_expected
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import shown

PlanReader = Callable[[Path, str, Mission], Plan | None]
"""Reads the text of a file of another program as a plan for a mission; returns None for a text of another kind."""
PLAN_READERS: Registry[PlanReader] = Registry(
    "plan reader", "muster.plan_readers", function_expected("a function of a path, its text and a mission")
)


def read_plan(path: str | Path, mission: Mission | None = None) -> Plan:
    """Read a plan file. One from elsewhere needs only `schema` and `routes`.

    With the mission that it is for, it may be a solution of vehicle routing (`.sol`), `Route #1: 5 3 2`, or another
    file that an installed package reads (entry points `muster.plan_readers`).

    Raises
    ------
    PlanError
        with everything that is wrong with the file; whether the plan is admissible is for `verify` to say.
    """
    file = Path(path)
    try:
        text = read_text(file)
    except MissionError as error:
        raise PlanError(error.findings) from None
    if mission is not None and (plan := _of_other_program(file, text, mission)) is not None:
        return plan
    if is_mission(text):
        raise PlanError([Finding(str(file), None, "schema", '"muster/1"', MISSION_AS_PLAN)])
    try:
        data = json.loads(text)
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


def _of_other_program(file: Path, text: str, mission: Mission) -> Plan | None:
    plans = (read(file, text, mission) for read in PLAN_READERS.usable().values())
    return next(filter(None, plans), None)


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
            "time_with_traffic_s",
            "time_without_traffic_s",
        )
        plan = Plan(
            mission=self._given(data, "mission", str),
            allocator=self._given(data, "allocator", str),
            seed=self._given(data, "seed", int),
            ignored=tuple(name for name in ignored if ignorable_rule(name) is not None),
            objective=objective.get("name") if objective.get("name") in OBJECTIVES else None,
            objective_value=self._number(objective, "value", "objective."),
            usage_unit=self._given(data, "usage_unit", str),
            cut_short=self._flag(data, "cut_short"),
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

    def _flag(self, data: Mapping[str, Any], name: str) -> bool:
        value = data.get(name, False)
        if not isinstance(value, bool):
            self._refuse(name, value, "true or false")
        return value is True

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
            self._refuse(f"routes[{k}].stops", data, "a list of stops, one for each of its tasks and stations")
            return ()
        before = len(self._found)
        for n, stop in enumerate(data):
            self._check_stop(stop, f"routes[{k}].stops[{n}]")
        if len(self._found) > before:
            return ()
        return tuple(map(_stop_of, data))

    def _check_stop(self, stop: object, at: str) -> None:
        if not isinstance(stop, dict) or _is_id(stop.get("task")) == _is_id(stop.get("station")):
            self._refuse(at, stop, f"a mapping with task or station, {', '.join(STOP_TIMES)}")
            return
        for name in STOP_TIMES:
            if not _finite(stop.get(name)):
                self._refuse(f"{at}.{name}", stop.get(name), "a finite number, in seconds")
        charged = stop.get("charged")
        if charged is not None and (_is_id(stop.get("task")) or not _finite(charged) or charged < 0):
            self._refuse(f"{at}.charged", charged, "a finite number of at least 0, at a station")

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


def _stop_of(data: Mapping[str, Any]) -> RouteStop:
    charged, is_station = data.get("charged"), data.get("task") is None
    arrive_s, begin_s, end_s = (float(data[name]) for name in STOP_TIMES)
    return RouteStop(
        str(data["station" if is_station else "task"]),
        arrive_s,
        begin_s,
        end_s,
        is_station,
        None if charged is None else float(charged),
    )


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
