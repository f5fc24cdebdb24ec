"""Vehicle routing with time windows: the layout of Solomon [solomon1987], Gehring and Homberger [gehring1999]."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission
from muster.mission.texts.text_files import read_text
from muster_files.instances.customer_missions import Customer, Instance, fleet, instance_mission
from muster_files.instances.line_fates import LineFates
from muster_files.number_rows import Row, is_whole, node_number, read_row, text_rows

_COLUMNS = ("customer", "x", "y", "demand", "ready time", "due date", "service time")
_TITLES = ("VEHICLE", "CUSTOMER")


def looks_like_solomon(rows: Sequence[Row]) -> bool:
    """Whether the first lines are those of such a file: its name, and the title VEHICLE or CUSTOMER."""
    return any(_is_title(row, *_TITLES) for row in rows[:8])


def read_solomon(path: FilePath, salesmen: int | None = None, fates: LineFates | None = None) -> Mission:
    """Read an instance with as many robots as it has vehicles, or `salesmen`.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    rows = text_rows(read_text(path))
    fates = fates or LineFates()
    fates.read("title", [row for row in rows if _is_title(row, *_TITLES)])
    fates.read("name", rows[:1])
    name = path.stem if not rows or _is_title(rows[0], *_TITLES) else " ".join(rows[0].words)
    number = _after(path, rows, "VEHICLE", "a line with the number of vehicles and their capacity")[:1]
    if not number:
        raise MissionError([Finding(str(path), None, "VEHICLE", "no numbers", "number of vehicles, capacity")])
    fates.read("vehicles", number)
    vehicles, capacity = read_row(path, number[0], ("number of vehicles", "capacity"), "VEHICLE")
    if capacity <= 0:
        raise MissionError([Finding(str(path), number[0].line, "CAPACITY", f"{capacity:g}", "a number above 0")])
    table = _after(path, rows, "CUSTOMER", f"lines of {', '.join(_COLUMNS)}")
    fates.read("customer", table)
    after_titles = [row for k, row in enumerate(rows) if k and _is_title(rows[k - 1], *_TITLES)]
    fates.read("columns", [row for row in after_titles if row not in (*table, *number)])
    customers = [_customer(path, row) for row in table]
    if not customers:
        raise MissionError([Finding(str(path), None, "CUSTOMER", "no customers", f"lines of {', '.join(_COLUMNS)}")])
    return instance_mission(
        Instance(
            path=path,
            name=name,
            depot=customers[0],
            customers=customers[1:],
            vehicles=fleet(path, number[0].line, "NUMBER", vehicles, salesmen),
            capacity=capacity,
        )
    )


def _after(path: FilePath, rows: list[Row], title: str, expected: str) -> list[Row]:
    """The rows after a title and a line of columns, up to the next title."""
    at = next((k for k, row in enumerate(rows) if _is_title(row, title)), None)
    if at is None:
        raise MissionError([Finding(str(path), None, title, "missing", expected)])
    found = rows[at + 1 :]
    if found and not found[0].words[0][0].isdigit():
        del found[0]
    end = next((k for k, row in enumerate(found) if _is_title(row, *_TITLES)), len(found))
    return found[:end]


def _is_title(row: Row, *titles: str) -> bool:
    return len(row.words) == 1 and row.words[0].upper() in titles


def _customer(path: FilePath, row: Row) -> Customer:
    _, x, y, demand, ready, due, service = read_row(path, row, _COLUMNS, "CUSTOMER")
    if not is_whole(row.words[0]):
        raise MissionError([Finding(str(path), row.line, "CUSTOMER", row.words[0], "the number of a customer")])
    return Customer(row.line, node_number(row.words[0]), (x, y), demand, (ready, due), service)
