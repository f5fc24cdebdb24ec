"""A plan as CSV for spreadsheets: a line for each visit in the order of routes, then one for each task left out.

Spreadsheets run a cell that begins with =, +, - or @ as a formula, even in quotes. Such an id gets a leading
apostrophe, which marks text (OWASP, "CSV Injection").
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping

from muster.exchange.earth import Earth
from muster.exchange.task_times import Stop, clock, late_s, stops_of
from muster.mission.model import Mission, Task
from muster.verification import Verdict

_BEGIN_FORMULAS = ("=", "+", "-", "@", "\t", "\r")


_TIMES = ("arrives_s", "starts_s", "ends_s")
_CLOCKS = ("arrives_at", "starts_at", "ends_at")


def csv_text(mission: Mission, verdict: Verdict, earth: Earth | None) -> str:
    """Lines of visits; `usage` is the robot's usage at the arrival, `with` the other robots of the task's team.

    Without `earth` no degrees; clock times where the mission says when it starts.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    places = ("x", "y", "z", "lat_deg", "lon_deg")
    clocks = () if mission.starts_at is None else _CLOCKS
    more = (f"usage_{verdict.usage_unit}", "waits_s", "late_s", "with", *clocks)
    writer.writerow(("robot", "order", "task", *places, *_TIMES, *more))
    writer.writerows(_rows(mission, verdict, earth, columns=len(_TIMES) + len(more)))
    return out.getvalue()


def _rows(mission: Mission, verdict: Verdict, earth: Earth | None, columns: int) -> Iterator[tuple[object, ...]]:
    where = _places(mission, earth)
    tasks = {task.id: task for task in mission.tasks}
    stops = stops_of(verdict)
    own = {(stop.robot, stop.order): stop for team in stops.values() for stop in team}
    for route in verdict.routes:
        for order, visit in enumerate(route.visits, 1):
            stop = own[route.robot, order]
            yield (cell(route.robot), order, cell(visit.task), *where[visit.task], *_figures(mission, tasks, stop))
    for task in mission.tasks:
        if task.id not in stops:
            yield ("", "", cell(task.id), *where[task.id], *[""] * columns)


def _figures(mission: Mission, tasks: Mapping[str, Task], stop: Stop) -> Iterator[object]:
    """The cells of a visit from its times on."""
    visit = stop.visit
    times = (visit.arrives_s, visit.starts_s, visit.ends_s)
    late = late_s(tasks[visit.task], visit.ends_s)
    yield from (round(value, 4) for value in (*times, visit.arrival_usage, stop.waits_s))
    yield "" if late is None else round(late, 4)
    yield cell(" ".join(stop.others))
    if mission.starts_at is not None:
        yield from (clock(mission, seconds) for seconds in times)


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
