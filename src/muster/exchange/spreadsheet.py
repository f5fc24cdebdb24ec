"""A plan as CSV for spreadsheets: a line for each visit in the order of routes, then one for each task left out.

Spreadsheets run a cell that begins with =, +, - or @ as a formula, even in quotes. Such an id gets a leading
apostrophe, which marks text (OWASP, "CSV Injection").
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from muster.exchange.earth import Earth
from muster.mission.model import Mission, Task
from muster.verification import Verdict

_BEGIN_FORMULAS = ("=", "+", "-", "@", "\t", "\r")


def csv_text(mission: Mission, verdict: Verdict, earth: Earth | None) -> str:
    """Lines of visits; `usage` is the robot's usage at the arrival. Without `earth` no degrees."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    times = ("arrives_s", "starts_s", "ends_s", f"usage_{verdict.usage_unit}")
    writer.writerow(("robot", "order", "task", "x", "y", "z", "lat_deg", "lon_deg", *times))
    writer.writerows(_rows(mission, verdict, earth))
    return out.getvalue()


def _rows(mission: Mission, verdict: Verdict, earth: Earth | None) -> Iterator[tuple[object, ...]]:
    where = _places(mission, earth)
    done: set[str] = set()
    for route in verdict.routes:
        for order, v in enumerate(route.visits, 1):
            done.add(v.task)
            times = (round(value, 4) for value in (v.arrives_s, v.starts_s, v.ends_s, v.arrival_usage))
            yield (cell(route.robot), order, cell(v.task), *where[v.task], *times)
    for task in mission.tasks:
        if task.id not in done:
            yield ("", "", cell(task.id), *where[task.id], "", "", "", "")


def cell(name: str) -> str:
    """An id as a cell that no spreadsheet runs as a formula."""
    return f"'{name}" if name.startswith(_BEGIN_FORMULAS) else name


def _places(mission: Mission, earth: Earth | None) -> dict[str, tuple[object, ...]]:
    """For each task x, y, z, latitude and longitude; unknown ones are empty."""
    spots = [] if earth is None else earth.spots(task.position for task in mission.tasks)
    degrees: list[tuple[object, object]] = [(spot.lat, spot.lon) for spot in spots] or [("", "")] * len(mission.tasks)
    return {task.id: (*_metres(task), *pair) for task, pair in zip(mission.tasks, degrees, strict=True)}


def _metres(task: Task) -> tuple[object, ...]:
    return (*task.position, "")[:3]
