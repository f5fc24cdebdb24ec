"""A mission as a form: tables of robots, tasks and rules. What is typed goes into the text, cell by cell."""

from __future__ import annotations

import math
import re
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from nicegui import background_tasks, ui

from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import OBJECTIVES, Robot, Rules, Task
from muster.mission.records import specified
from muster.server.pages.editing.draft import Draft
from muster.server.pages.notices import warn, words_of
from muster.server.pages.plan.table import Column, Table

_AMBIGUOUS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_PLACE = (Column("x", "number", hint="metres east"), Column("y", "number", hint="metres north"))
_HEIGHT = Column("z", "number", hint="metres above the ground of the map")
_ROBOTS = (
    Column("type"),
    Column("kind", "choice", ("ground", "air")),
    Column("work_capacity", "number"),
    Column("speed_mps", "number"),
    Column("radius_m", "number"),
    Column("skills", "words"),
)
_TASKS = (
    Column("type"),
    Column("prerequisites", "words"),
    Column("actuation_cost", "number"),
    Column("duration_s", "number"),
    Column("priority", "number"),
    Column("requires", "words"),
)
_RULES = (
    Column("objective", "choice", OBJECTIVES),
    Column("usage", "choice", ("distance", "time")),
    Column("travel", "choice", ("euclidean", "map", "matrix")),
    Column("min_suitability", "number"),
    Column("capacity_reserve", "number"),
    Column("return_to_start", "choice", ("true", "false")),
)
_SHOWN = {"rules": "rules", "robot": "robots", "task": "tasks"}
_AXES = {"x": 0, "y": 1, "z": 2}


def _explained(model: type[Any], columns: Sequence[Column]) -> tuple[Column, ...]:
    """Columns with what the format says of their keys."""
    words = {one.name: str(one.metadata["doc"]) for one in specified(model)}
    return tuple(replace(column, hint=words.get(column.key, column.hint)) for column in columns)


class Form:
    """Three tables over the text of a draft."""

    def __init__(self, draft: Draft, edit: Callable[..., Awaitable[bool]], *, editable: bool) -> None:
        self._draft = draft
        self._edit = edit
        self._message = ui.label("").classes("alarm").props('role="status"')
        self._flat = ui.element("div").classes("bar")
        with self._flat:
            ui.label("This mission is in the plane: x and y.").classes("quiet")
            if editable:
                raising = ui.button("Make it 3-D", on_click=lambda: self._edit("raised")).props("outline dense")
                raising.props('title="Every robot and task gets a height z, which is 0 at first"')
        with ui.element("div").classes("forms"):
            self._rules = Table("Rules", editable=editable, grows=False)
            self._robots = Table("Robots", editable=editable)
            self._tasks = Table("Tasks", editable=editable)
        if editable:
            self._listen()

    def _listen(self) -> None:
        for table, what in ((self._robots, "robot"), (self._tasks, "task")):
            table.on("cell", lambda event, team=_SHOWN[what]: self._cell(team, event.args))
            table.on("add", lambda _, what=what: self._edit("add_beside", what))
            table.on("drop", lambda event, what=what: self._edit("drop", what, event.args))
        self._rules.on("cell", lambda event: self._cell("rules", event.args))

    def show(self) -> None:
        """Show the text as it is now, as soon as a worker has read it."""
        background_tasks.create_lazy(self._show(), name=f"form {id(self)}")

    async def _show(self) -> None:
        await self._read()
        if not self._draft.is_editing:  # otherwise it is shown again when that is done
            for table in (self._rules, self._robots, self._tasks):
                table.forget()

    async def _read(self) -> None:
        """Read the text; if it cannot be read show why, and the former values."""
        try:
            data = await self._draft.read_keys(*_SHOWN.values())
        except MusterError as error:
            self._message.text = f"The text cannot be shown: {words_of(error)}"
            return
        self._message.text = ""
        robots, tasks = (_rows(data.get(team)) for team in ("robots", "tasks"))
        in_space = any("z" in row for row in (*robots, *tasks))
        self._flat.set_visibility(not in_space)
        place = (*_PLACE, _HEIGHT) if in_space else _PLACE
        self._rules.show(_explained(Rules, _RULES), [_row(data.get("rules") or {})])
        self._robots.show(_explained(Robot, (Column("id"), *place, *_ROBOTS)), robots)
        self._tasks.show(_explained(Task, (Column("id"), *place, *_TASKS)), tasks)

    async def _cell(self, team: str, change: Mapping[str, Any]) -> None:
        key, row, name = str(change["key"]), int(change["row"]), str(change["id"])
        columns = {column.key: column for column in (*_PLACE, _HEIGHT, *_ROBOTS, *_TASKS, *_RULES)}
        kind = columns[key].kind if key in columns else "text"
        where = key if team == "rules" else f"{team[:-1]} {name or f'in row {row + 1}'}: {key}"
        try:
            value = _value(str(change["value"]), where, kind)
            if key in _AXES and value is None:
                raise ParameterError(f"{where}: empty; expected a number of metres")
        except ParameterError as error:
            warn(words_of(error))
            self._draft.tell_waiting()
        else:
            await self._change(team, row, name, key, value)
        self.show()

    async def _change(self, team: str, row: int, name: str, key: str, value: object) -> None:
        if team == "rules":
            await self._edit("set_cell", ("rules", key), value)
        elif key in _AXES:
            await self._edit("set_coordinate", (team, row), _AXES[key], value, name)
        else:
            await self._edit("set_cell", (team, row, key), value, name)


def _value(typed: str, where: str, kind: str) -> object:
    """A typed value as in the mission's text; None for an empty cell. `where` stands in errors."""
    typed = typed.strip()
    if not typed:
        return None
    if kind == "words":
        return typed.replace(",", " ").split()
    if kind == "number":
        return number_of(typed, where)
    if kind == "choice" and typed in ("true", "false"):
        return typed == "true"
    return typed


def number_of(typed: str, where: str) -> float:
    """A number with a decimal point or comma; 1,000 is ambiguous and refused."""
    try:
        number = math.nan if "_" in typed or _AMBIGUOUS.fullmatch(typed) else float(typed.replace(",", "."))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ParameterError(f"{where}: {typed!r}; expected a number, as 1000 or 1.5")
    return int(number) if number.is_integer() and abs(number) < 1e15 else number


def _rows(items: object) -> list[dict[str, str]]:
    return [_row(item) for item in _items(items)]


def _items(items: object) -> list[Mapping[str, Any]]:
    return [item for item in items if isinstance(item, dict)] if isinstance(items, list) else []


def _row(item: Mapping[str, Any]) -> dict[str, str]:
    """One item as its cells show it."""
    row = {str(key): _shown(value) for key, value in item.items() if not isinstance(value, dict)}
    position = item.get("position")
    if isinstance(position, list):
        row.update({axis: _shown(position[k]) for axis, k in _AXES.items() if k < len(position)})
    return row


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return " ".join(map(str, value)) if isinstance(value, list) else "" if value is None else str(value)
