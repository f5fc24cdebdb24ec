"""Electric vehicle routing with time windows and recharging stations in the layout of Schneider et al. [schneider2014].

Energy is counted in metres: a battery holds `Q / r`, as a vehicle uses `r` a unit of distance, and a second of
charging adds `1 / (g r)`, as a unit of energy takes `g`. A station always fills a battery, as in the published plans,
and has room for all robots. The file has no fleet: without `salesmen` there are as many robots as customers.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import Mission
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import shown
from muster_files.instances.customer_missions import Customer, Instance, fleet, instance_mission
from muster_files.instances.line_fates import LineFates
from muster_files.number_rows import Row, read_row, row_numbers, text_rows

_COLUMNS = ("x", "y", "demand", "ready time", "due date", "service time")
_DEPOT, _STATION, _CUSTOMER = "d", "f", "c"
_KINDS = {_DEPOT: "the depot", _STATION: "a station", _CUSTOMER: "a customer"}
_FIGURES = {
    "Q": "battery capacity",
    "C": "load capacity",
    "r": "consumption rate",
    "g": "inverse recharging rate",
    "v": "velocity",
}
_VALUE = re.compile(r"/([^/]*)/\s*$")


def looks_like_electric_vrptw(rows: Sequence[Row]) -> bool:
    """Whether the first line is the head of such a file."""
    return bool(rows) and rows[0].words[:2] == ["StringID", "Type"]


def read_electric_vrptw(path: FilePath, salesmen: int | None = None, fates: LineFates | None = None) -> Mission:
    """Read an instance with `salesmen` robots, or as many as it has customers.

    Raises
    ------
    MissionError
        with file, line, field, value, what was expected.
    """
    head, *rows = text_rows(read_text(path))
    fates = fates or LineFates()
    fates.read("columns", [head])
    fates.read("line", rows)
    figures = _figures(path, [row for row in rows if row.words[0] in _FIGURES])
    places = _places(path, [row for row in rows if row.words[0] not in _FIGURES])
    if len(places[_DEPOT]) != 1:
        raise MissionError([Finding(str(path), None, "Type", f"{len(places[_DEPOT])} of type d", "one depot")])
    per_metre = figures["r"]
    count = fleet(path, None, "customers", max(1, len(places[_CUSTOMER])), salesmen)
    stations: list[dict[str, Any]] = [
        {
            "id": station.id,
            "position": station.position,
            "services": ["charge"],
            "slots": count,
            "charge_per_s": 1 / (figures["g"] * per_metre),
            "partial": False,
        }
        for station in places[_STATION]
    ]
    return instance_mission(
        Instance(
            path=path,
            name=path.stem,
            depot=places[_DEPOT][0],
            customers=places[_CUSTOMER],
            vehicles=count,
            capacity=figures["C"],
            robot={"speed_mps": figures["v"], "battery": {"capacity": figures["Q"] / per_metre}},
            mission={"stations": stations},
        )
    )


def _figures(path: FilePath, rows: Sequence[Row]) -> Mapping[str, float]:
    """The figures of the vehicles, which stand between slashes at the ends of lines."""
    figures: dict[str, float] = {}
    for row in rows:
        letter, text = row.words[0], " ".join(row.words)
        found = _VALUE.search(text)
        value = row_numbers([found[1]]) if found else None
        if value is None or not 1e-12 < value[0] < 1e12:
            expected = f"{letter} {_FIGURES[letter]} /a number above 0/"
            raise MissionError([Finding(str(path), row.line, letter, shown(text), expected)])
        figures[letter] = value[0]
    missing = [letter for letter in _FIGURES if letter not in figures]
    if missing:
        raise MissionError(
            [Finding(str(path), None, x, "missing", f"a line: {x} {_FIGURES[x]} /a number above 0/") for x in missing]
        )
    return figures


def _places(path: FilePath, rows: Sequence[Row]) -> Mapping[str, list[Customer]]:
    places: dict[str, list[Customer]] = {kind: [] for kind in _KINDS}
    seen: set[str] = set()
    for row in rows:
        name, kind = row.words[0], row.words[1] if len(row.words) > 1 else ""
        if kind not in _KINDS:
            expected = ", ".join(f"{one} for {what}" for one, what in _KINDS.items())
            raise MissionError([Finding(str(path), row.line, "Type", shown(kind), expected)])
        if name in seen:
            raise MissionError([Finding(str(path), row.line, "StringID", shown(name), "an id of its own")])
        seen.add(name)
        x, y, demand, ready, due, service = read_row(path, Row(row.line, row.words[2:]), _COLUMNS, name)
        places[kind].append(Customer(row.line, name, (x, y), demand, (ready, due), service))
    return places
