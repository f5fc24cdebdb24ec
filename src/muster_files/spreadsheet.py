"""A plan as CSV for spreadsheets: a line for each stop in the order of routes, then one for each task left out."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping

from muster.mission.goods import shown_amounts
from muster.mission.model import Mission, Point, Task
from muster.verification import Stop as TimedStop
from muster.verification import Verdict
from muster_files.earth import Earth
from muster_files.formula_cells import cell
from muster_files.task_times import Stop, clock, late_s, stops_of

_TIMES = ("arrives_s", "starts_s", "ends_s")
_CLOCKS = ("arrives_at", "starts_at", "ends_at")


def csv_text(mission: Mission, verdict: Verdict, earth: Earth | None) -> str:
    """Lines of stops; `usage` is the robot's usage at the arrival, `with` the other robots of the task's team.

    Without `earth` no degrees; clock times where the mission says when it starts. Stations, batteries and goods have
    columns where the mission has them.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    places = ("x", "y", "z", "lat_deg", "lon_deg")
    clocks = () if mission.starts_at is None else _CLOCKS
    more = (f"usage_{verdict.usage_unit}", "waits_s", "late_s", "with", *clocks)
    last = _last_columns(mission, verdict.usage_unit)
    writer.writerow(("robot", "order", "task", *places, *_TIMES, *more, *last))
    writer.writerows(_rows(mission, verdict, earth, columns=len(_TIMES) + len(more) + len(last)))
    return out.getvalue()


def _rows(mission: Mission, verdict: Verdict, earth: Earth | None, columns: int) -> Iterator[tuple[object, ...]]:
    where = _places(mission, earth)
    tasks = {task.id: task for task in mission.tasks}
    stops = stops_of(verdict)
    own = {(stop.robot, stop.order): stop for team in stops.values() for stop in team}
    for route in verdict.routes:
        usages = {visit.task: visit.arrival_usage for visit in route.visits}
        for order, timed in enumerate(route.stops, 1):
            figures = _figures(mission, tasks, own[route.robot, order], usages.get(timed.name))
            name = "" if timed.is_station else cell(timed.name)
            yield (cell(route.robot), order, name, *where[timed.name], *figures, *_last_cells(mission, timed))
    for task in mission.tasks:
        if task.id not in stops:
            yield ("", "", cell(task.id), *where[task.id], *[""] * columns)


def _last_columns(mission: Mission, unit: str) -> tuple[str, ...]:
    """The columns of stations, batteries and goods, as far as the mission has them."""
    stations = ("station", f"charged_{unit}") if mission.stations else ()
    levels = (f"level_{unit}",) if mission.has_batteries else ()
    return (*stations, *levels, *(("load",) if mission.has_goods else ()))


def _last_cells(mission: Mission, stop: TimedStop) -> Iterator[object]:
    """The cells of these columns; level and load are those after the stop."""
    if mission.stations:
        yield cell(stop.name) if stop.is_station else ""
        yield "" if stop.charged is None else round(stop.charged, 4)
    if mission.has_batteries:
        yield "" if stop.level_after is None else round(stop.level_after, 4)
    if mission.has_goods:
        yield cell(shown_amounts(stop.load_after))


def _figures(mission: Mission, tasks: Mapping[str, Task], stop: Stop, usage: float | None) -> Iterator[object]:
    """The cells of a stop from its times on; `usage` is that at the arrival at a task."""
    visit = stop.visit
    times = (visit.arrives_s, visit.starts_s, visit.ends_s)
    late = None if visit.is_station else late_s(tasks[visit.name], visit.ends_s)
    yield from ("" if value is None else round(value, 4) for value in (*times, usage, stop.waits_s))
    yield "" if late is None else round(late, 4)
    yield cell(" ".join(stop.others))
    if mission.starts_at is not None:
        yield from (clock(mission, seconds) for seconds in times)


def _places(mission: Mission, earth: Earth | None) -> dict[str, tuple[object, ...]]:
    """For each task and station x, y, z, latitude and longitude; unknown ones are empty."""
    points = {task.id: task.position for task in mission.tasks}
    points |= {station.id: station.position for station in mission.stations}
    spots = [] if earth is None else earth.spots(points.values())
    degrees: list[tuple[object, object]] = [(spot.lat, spot.lon) for spot in spots] or [("", "")] * len(points)
    return {name: (*_metres(point), *pair) for (name, point), pair in zip(points.items(), degrees, strict=True)}


def _metres(point: Point) -> tuple[object, ...]:
    return (*point, "")[:3]
