"""A mission as a form: tables of robots, tasks, stations and rules. What is typed goes into the text, cell by cell.

A table that is edited cell by cell; its rows are drawn by a script in the browser, however many there are.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from nicegui import background_tasks, ui
from nicegui.element import Element

from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import OBJECTIVES, Robot, Rules, Station, Task
from muster.mission.records import Checked, all_keys, instead_of, key_of, specified
from muster.mission.value_types import Choice, Flag, Number, Whole
from muster_control.pages.editing.cell_texts import text_of, value_of
from muster_control.pages.editing.draft import Draft
from muster_control.pages.notices import warn, words_of


@dataclass(frozen=True)
class Column:
    """A column: its key, its kind (a choice, or one of `cell_texts`), and its meaning."""

    key: str
    kind: str = "text"
    choices: tuple[str, ...] = ()
    hint: str = ""


class Table(Element, component="table.js"):
    """Emits `cell`, `add`, and `drop` with the id of a row.

    `cell` comes with `{row, id, key, value}`: the row's number and id, empty where it has none, and what was typed.
    That is shown until the table is told to `forget` it, whatever else changes meanwhile.
    """

    def __init__(self, title: str, *, editable: bool, grows: bool = True) -> None:
        super().__init__()
        self.props["title"] = title
        self.props["editable"] = editable
        self.props["grows"] = grows
        self.props["columns"] = []
        self.props["rows"] = []

    def show(self, columns: Sequence[Column], rows: Sequence[Mapping[str, str]]) -> None:
        """Show rows, each a mapping from keys of columns to what their cells say; what is there is not sent again."""
        shown = {"columns": [asdict(column) for column in columns], "rows": [dict(row) for row in rows]}
        for name, value in shown.items():
            if self.props[name] != value:
                self.props[name] = value

    def forget(self) -> None:
        """Show what the rows say in place of what was typed into cells: it has been taken, or refused."""
        self.run_method("forget")


def _of_rules(model: type[Checked]) -> tuple[Column, ...]:
    """The columns of the keys that rules of other packages bring."""
    return tuple(_column(key_of(f), f.metadata["kind"]) for part in model.beside() for f in specified(part))


def _column(key: str, kind: object) -> Column:
    match kind:
        case Number() | Whole():
            return Column(key, "number")
        case Flag():
            return Column(key, "choice", ("true", "false"))
        case Choice():
            return Column(key, "choice", tuple(kind.words))
    return Column(key)


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
    Column("prerequisites", "lagged", hint="with a lag as 31(5..60): from 5 to 60 s after its end"),
    Column("actuation_cost", "number"),
    Column("duration_s", "number"),
    Column("priority", "number"),
    Column("requires", "words"),
)
_ROBOT_TIMES = (
    Column("shift", "clock spans", hint="as 08:00 to 16:00, beside starts_at"),
    *(
        Column(f.name, "number")
        for f in specified(Robot)
        if f.metadata["if_used"] and isinstance(f.metadata["kind"], Number | Whole)
    ),
    *(Column(key, "number") for key in ("acceleration_mps2", "yaw_rate_radps", "climb_mps")),
    Column("abilities", "amounts", hint="as lift_kg 20, water_l 3"),
    *_of_rules(Robot),
)
_TASK_TIMES = (
    Column("window", "clock spans", hint="as 10:00 to 14:00; 16:00 to, beside starts_at"),
    Column("window_s", "spans", hint="as 600 to 1200; 2000 to"),
    Column("deadline", hint="as 14:30, beside starts_at"),
    Column("deadline_s", "number"),
    Column("due", hint="as 14:00, beside starts_at"),
    Column("due_s", "number"),
    Column("robots_needed", "number"),
    Column("team", "parts", hint="as 2 type=rover; 1 kind=air requires=camera+gripper"),
    Column("needs", "amounts", hint="as lift_kg 35"),
    Column("same_robot_as", "words"),
    Column("other_robot_than", "words"),
    Column("starts_with", "words"),
    *_of_rules(Task),
)
_ROBOT_GOODS = (
    Column("load_capacity", "loads", hint="as 10, or parcels 4, water_l 10"),
    Column("load_at_start", "loads", hint="as 2, or parcels 1"),
    Column("battery", "amounts", hint="as capacity 500, at_start 1, reserve 0.1"),
)
_TASK_GOODS = (
    Column("load", "loads", hint="as 3, or parcels 2; below 0 it is put down"),
    Column("delivers", hint="the id of a task with a load"),
)
_STATIONS = (
    Column("services", "words", hint="charge, swap or unload; charge or swap beside unload"),
    Column("slots", "number"),
    Column("charge_per_s", "number"),
    Column("swap_s", "number"),
    Column("partial", "choice", ("true", "false")),
)
_RULES = (
    Column("objective", "choice", OBJECTIVES),
    Column("usage", "choice", ("distance", "time")),
    Column("travel", "choice", ("euclidean", "map", "matrix")),
    Column("min_suitability", "number"),
    Column("capacity_reserve", "number"),
    Column("return_to_start", "choice", ("true", "false")),
    Column("timing", "choice", ("profile", "constant")),
    Column("makespan_includes_return", "choice", ("true", "false")),
    *_of_rules(Rules),
)
_SHOWN = {"rules": "rules", "robot": "robots", "task": "tasks", "station": "stations"}
_AXES = {"x": 0, "y": 1, "z": 2}
_OF_ROBOTS, _OF_TASKS = (*_ROBOTS, *_ROBOT_TIMES, *_ROBOT_GOODS), (*_TASKS, *_TASK_TIMES, *_TASK_GOODS)
_COLUMNS = {column.key: column for column in (*_PLACE, _HEIGHT, *_OF_ROBOTS, *_OF_TASKS, *_STATIONS, *_RULES)}
_GOODS = {column.key for column in (*_ROBOT_GOODS, *_TASK_GOODS)}
_TIMES = {column.key for column in (*_ROBOT_TIMES, *_TASK_TIMES)}
_AMOUNTS = {column.key for column in _COLUMNS.values() if column.kind in ("amounts", "loads")}


def _explained(model: type[Any], columns: Sequence[Column]) -> tuple[Column, ...]:
    """Columns with what the format says of their keys."""
    words = {one.name: str(one.metadata["doc"]) for one in all_keys(model)}
    for one in specified(model):
        words |= {key: doc for key, _, doc in instead_of(one)}
    return tuple(
        replace(column, hint="; ".join(filter(None, (words.get(column.key, ""), column.hint)))) for column in columns
    )


class Form:
    """Tables over the text of a draft."""

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
        with ui.element("div").classes("bar"):
            self._timed = ui.checkbox("Times, teams and relations", on_change=self.show).props("dense")
            self._timed.props('title="Columns for windows, deadlines, shifts, teams, abilities and relations of tasks"')
            self._goods = ui.checkbox("Goods and energy", on_change=self.show).props("dense")
            self._goods.props('title="Loads, deliveries and batteries, and the stations where robots charge or unload"')
        with ui.element("div").classes("forms"):
            self._rules = Table("Rules", editable=editable, grows=False)
            self._robots = Table("Robots", editable=editable)
            self._tasks = Table("Tasks", editable=editable)
            self._stations = Table("Stations", editable=editable)
        if editable:
            self._listen()

    def _listen(self) -> None:
        for table, what in ((self._robots, "robot"), (self._tasks, "task"), (self._stations, "station")):
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
            for table in (self._rules, self._robots, self._tasks, self._stations):
                table.forget()

    async def _read(self) -> None:
        """Read the text; if it cannot be read show why, and the former values."""
        try:
            data = await self._draft.read_keys(*_SHOWN.values())
        except MusterError as error:
            self._message.text = f"The text cannot be shown: {words_of(error)}"
            return
        self._message.text = ""
        robots, tasks, stations = (_rows(data.get(team)) for team in ("robots", "tasks", "stations"))
        in_space = any("z" in row for row in (*robots, *tasks, *stations))
        self._flat.set_visibility(not in_space)
        place = (*_PLACE, _HEIGHT) if in_space else _PLACE
        self._rules.show(_explained(Rules, _RULES), [_row(data.get("rules") or {})])
        timed = self._timed.value or any(not _TIMES.isdisjoint(row) for row in (*robots, *tasks))
        self._timed.set_value(timed)
        carries = self._goods.value or bool(stations) or any(not _GOODS.isdisjoint(row) for row in (*robots, *tasks))
        self._goods.set_value(carries)
        of_robots = (*(_ROBOT_TIMES if timed else ()), *(_ROBOT_GOODS if carries else ()))
        of_tasks = (*(_TASK_TIMES if timed else ()), *(_TASK_GOODS if carries else ()))
        self._robots.show(_explained(Robot, (Column("id"), *place, *_ROBOTS, *of_robots)), robots)
        self._tasks.show(_explained(Task, (Column("id"), *place, *_TASKS, *of_tasks)), tasks)
        self._stations.show(_explained(Station, (Column("id"), *place, *_STATIONS)), stations)
        self._stations.set_visibility(carries)

    async def _cell(self, team: str, change: Mapping[str, Any]) -> None:
        key, row, name = str(change["key"]), int(change["row"]), str(change["id"])
        kind = _COLUMNS[key].kind if key in _COLUMNS else "text"
        where = key if team == "rules" else f"{team[:-1]} {name or f'in row {row + 1}'}: {key}"
        try:
            value = value_of(str(change["value"]), where, kind)
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


def _rows(items: object) -> list[dict[str, str]]:
    return [_row(item) for item in _items(items)]


def _items(items: object) -> list[Mapping[str, Any]]:
    return [item for item in items if isinstance(item, dict)] if isinstance(items, list) else []


def _row(item: Mapping[str, Any]) -> dict[str, str]:
    """One item as its cells show it."""
    shown = {str(key): value for key, value in item.items() if not isinstance(value, dict) or key in _AMOUNTS}
    row = {key: text_of(value, _COLUMNS[key].kind if key in _COLUMNS else "text") for key, value in shown.items()}
    position = item.get("position")
    if isinstance(position, list):
        row.update({axis: text_of(position[k]) for axis, k in _AXES.items() if k < len(position)})
    return row
