"""Pickup and delivery with time windows in the layout of Li and Lim [li2001].

A customer with a delivery is a task with a `load`; the customer that it names `delivers` it.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission
from muster.mission.texts.text_files import read_text
from muster_files.instances.customer_missions import Customer, Instance, fleet, instance_mission
from muster_files.instances.line_fates import LineFates
from muster_files.number_rows import Row, is_whole, node_number, read_row, row_numbers, text_rows

_HEAD = ("number of vehicles", "capacity", "speed")
_COLUMNS = ("customer", "x", "y", "demand", "ready time", "due date", "service time", "pickup", "delivery")


def looks_like_li_lim(rows: Sequence[Row]) -> bool:
    """Whether the first lines are those of such a file: three numbers, then lines of nine."""
    sizes = [len(row.words) for row in rows[:2]]
    return sizes == [len(_HEAD), len(_COLUMNS)] and all(row_numbers(row.words) is not None for row in rows[:1])


def read_li_lim(path: FilePath, salesmen: int | None = None, fates: LineFates | None = None) -> Mission:
    """Read an instance with as many robots as it has vehicles, or `salesmen`.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    head, *table = text_rows(read_text(path))
    fates = fates or LineFates()
    fates.read("vehicles", [head])
    fates.read("customer", table)
    vehicles, capacity, speed = read_row(path, head, _HEAD)
    for name, value in (("capacity", capacity), ("speed", speed)):
        if value <= 0:
            raise MissionError([Finding(str(path), head.line, name, f"{value:g}", "a number above 0")])
    depot, *customers = [_customer(path, row) for row in table]
    return instance_mission(
        Instance(
            path=path,
            name=path.stem,
            depot=depot,
            customers=customers,
            vehicles=fleet(path, head.line, "number of vehicles", vehicles, salesmen),
            capacity=capacity,
            robot={"speed_mps": speed},
        )
    )


def _customer(path: FilePath, row: Row) -> Customer:
    _, x, y, demand, ready, due, service, _, _ = read_row(path, row, _COLUMNS)
    number, pickup, delivery = map(node_number, (row.words[0], *row.words[-2:]))
    for name, word in (("customer", number), ("pickup", pickup), ("delivery", delivery)):
        if not is_whole(word):
            raise MissionError([Finding(str(path), row.line, name, word, "the number of a customer, or 0")])
    return Customer(row.line, number, (x, y), demand, (ready, due), service, pickup, delivery)
