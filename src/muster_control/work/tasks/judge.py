"""The task that judges a plan, with the times and paths of all robots."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from muster.mission.model import Mission
from muster.report.route_lines import Places, RobotLines, robot_lines
from muster.report.time_charts.gantt import plan_rows
from muster.report.time_charts.time_marks import page_marks
from muster.verification import Verdict, verify
from muster_control.work.missions import mission_of, plan_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan", "ignore", "objective"}` -> the verdict.

    It is what `muster verify --format json` prints, with `waiting_s`, `routes`, `lines`, `marks` and `clock_start_s`.

    `routes` has for each robot, in mission order, its figures, `visits` and `stops` with their times; `order`, its
    tasks and stations as they are shown; and `level`, what its battery holds over time: `points`, [seconds, share of
    the capacity], and the `reserve`; None without one. `lines` has for each robot's id `travel`, `work` and `end`, each
    a list of polylines in metres of the map frame. `marks` are the time windows, deadlines, due times, lateness and
    teams of a time chart, by the numbers of `routes`; `clock_start_s` is when the mission starts, seconds from
    midnight, where it says so.
    """
    mission = mission_of(arguments["mission"])
    verdict = verify(mission, plan_of(arguments["plan"]), arguments.get("ignore", ()), arguments.get("objective"))
    rows = plan_rows(mission, verdict)
    routes = [
        {**asdict(route), "order": route.order, "level": None if row.level is None else asdict(row.level)}
        for route, row in zip(verdict.routes, rows, strict=True)
    ]
    own = {"waiting_s": verdict.waiting_s, "routes": routes, "lines": lines(mission, verdict)}
    return {**verdict.as_dict(), **own, **page_marks(mission.tasks, rows, mission.starts_at)}


def lines(mission: Mission, verdict: Verdict) -> dict[str, dict[str, list[list[list[float]]]]]:
    """The ways of all robots, by id: what is travelled, what is worked along, and the leg to where a route ends."""
    return {lines.robot.id: _lines(lines) for lines in robot_lines(mission, verdict, mission.dimensions)}


def _lines(lines: RobotLines) -> dict[str, list[list[list[float]]]]:
    parts = {"travel": lines.travel, "work": lines.all_work, "end": lines.end}
    return {name: list(_polylines(places)) for name, places in parts.items()}


def _polylines(places: Places) -> Iterator[list[list[float]]]:
    """Polylines that rows of NaN part; millimetres are enough for what is drawn."""
    gaps = np.flatnonzero(np.isnan(places).any(axis=1))
    for piece in np.split(places, gaps):
        line = np.round(piece[~np.isnan(piece).any(axis=1)], 3)
        if len(line) > 1:
            yield line.tolist()
