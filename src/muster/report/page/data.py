"""The data of a record's page, as compact JSON: whole millimetres, milliseconds and milliradians.

Series that change little from one moment to the next are written as differences; `null` is a moment at which a robot is
absent.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from muster.mission.model import Map, Station, Task, Zone
from muster.mission.stations import station_sign
from muster.mission.values.arrays import Floats
from muster.motion.grid import Grid
from muster.report.figures.styles import PALETTE
from muster.report.maps.area_marks import areas_of
from muster.report.page.distances import nearest
from muster.report.record import ExecutionEvent, Recording, Tracks
from muster.report.time_charts.activity_spans import Span, spans
from muster.report.time_charts.level_lines import recorded_level
from muster.report.time_charts.recorded_gantt import recorded_rows
from muster.report.time_charts.time_marks import page_marks
from muster.state import MissionState
from muster.state.ground_events import GroundUnknown, MapGrows
from muster.state.mission_state import OPEN
from muster.state.reasons import is_no_loss, was_cancelled
from muster.state.robots import OUT
from muster.state.words import DETAIL

MOST_SAMPLES = 200_000
"""Moments times robots; where a record has more, moments are left out evenly."""


def page_data(recording: Recording) -> dict[str, Any]:
    """All data of the page."""
    tracks = _thinned(recording.tracks)
    order = {robot.id: k for k, robot in enumerate(recording.robots)}
    course = _Course(recording)
    bars = spans(recording.events, recording.duration_s)
    return {
        "name": recording.mission.name,
        "complete": recording.complete,
        "ended": recording.report is not None,
        "duration": _thousandths(recording.duration_s),
        "spatial": recording.mission.dimensions == 3,
        "times": _differences(tracks.times_s),
        "robots": [_robot(recording, tracks, k, course, bars) for k in range(len(order))],
        "tasks": list(course.tasks.values()),
        "stations": [_station(station, course) for station in recording.mission.stations],
        "plans": _plans(recording, order),
        "spans": [
            [order[bar.robot], bar.goal, bar.kind, _thousandths(bar.from_s), _thousandths(bar.until_s)]
            for bar in bars
            if bar.robot in order
        ],
        "events": [_event(event) for event in recording.events if event.mark != DETAIL],
        "nearest": _nearest(recording, tracks),
        "areas": _areas(recording.tasks),
        "map": _map(recording.mission.map, recording.image, course),
        "explored": _explored(recording),
        "figures": _figures(recording),
        **page_marks(recording.tasks, recorded_rows(recording), recording.mission.starts_at),
    }


def _thinned(tracks: Tracks) -> Tracks:
    moments = len(tracks.times_s)
    every = -(-moments * len(tracks.robots) // MOST_SAMPLES)
    if every <= 1:
        return tracks
    kept = np.unique(np.append(np.arange(0, moments, every), moments - 1))
    return Tracks(
        tracks.robots,
        tracks.times_s[kept],
        tracks.positions[kept],
        tracks.headings[kept],
        tracks.velocities[kept],
    )


def _thousandths(value: float) -> int:
    return round(value * 1000)


def _differences(values: Floats) -> list[int | None]:
    """Values in thousandths, each as the difference from the last value present."""
    found: list[int | None] = []
    last = 0
    for value in values.tolist():
        if value != value:  # NaN
            found.append(None)
            continue
        now = _thousandths(value)
        found.append(now - last)
        last = now
    return found


def _robot(recording: Recording, tracks: Tracks, k: int, course: _Course, bars: Sequence[Span]) -> dict[str, Any]:
    robot = recording.robots[k]
    data: dict[str, Any] = {
        "id": robot.id,
        "color": k % len(PALETTE),
        "radius": _thousandths(robot.radius_m),
        "kind": robot.kind,
        "x": _differences(tracks.positions[:, k, 0]),
        "y": _differences(tracks.positions[:, k, 1]),
        "heading": _differences(_unwrapped(tracks.headings[:, k])),
        "gone": course.gone.get(robot.id, []),
    }
    if recording.mission.dimensions == 3:
        data["z"] = _differences(tracks.positions[:, k, 2])
    level = recorded_level(recording, robot, [bar for bar in bars if bar.robot == robot.id])
    if level is not None:
        data["level"] = [[_thousandths(at_s), round(100_000 * share)] for at_s, share in level.points]
        data["reserve"] = level.reserve
    return data


def _station(station: Station, course: _Course) -> dict[str, Any]:
    slots = f", {station.slots} slots" if station.slots > 1 else ""
    label = f"station {station.id}: {', '.join(station.services)}{slots}"
    place, away = _millimetres(station.position[:2]), course.away.get(station.id, [])
    return {"sign": station_sign(station.id), "place": place, "label": label, "away": away}


def _unwrapped(headings: Floats) -> Floats:
    """The same directions without jumps, so that they can be interpolated."""
    there, smooth = np.isfinite(headings), headings.copy()
    smooth[there] = np.unwrap(headings[there])
    return smooth


def _event(event: ExecutionEvent) -> list[Any]:
    """When it was, its line, and whether somebody should look at it."""
    return [_thousandths(event.time_s), event.line, event.alarming]


class _Course:
    """What happened to tasks, robots, stations and doors: for each its values over time, each [when, value]."""

    def __init__(self, recording: Recording) -> None:
        self._state = MissionState(recording.mission, forgets=False)
        self.tasks = {name: _task(self._state, name, 0.0) for name in self._state.tasks}
        self.gone: dict[str, list[list[Any]]] = {}
        self.away: dict[str, list[list[Any]]] = {}
        self.closed = {name: [[0, name in self._state.doors.closed]] for name in self._state.doors.known}
        for event in recording.events:
            self._apply(event)

    def _apply(self, event: ExecutionEvent) -> None:
        state, now, robot = self._state, _thousandths(event.time_s), event.data.get("robot")
        for name in state.apply(event):
            if name not in self.tasks:
                self.tasks[name] = _task(state, name, event.time_s)
                continue
            self.tasks[name]["places"].append([now, *_millimetres(state.tasks[name].position)])
            self.tasks[name]["states"].append([now, state.stage(name), robot])
        if isinstance(robot, str) and robot in state.robots:
            _note(self.gone, robot, now, OUT.get(state.robots[robot].out, ""))
        for station in (*self.away, *state.failed_stations, *state.cut_off_stations):
            cut_off = "cut off" if station in state.cut_off_stations else ""
            _note(self.away, station, now, "failed" if station in state.failed_stations else cut_off)
        for door in self.closed:
            _note(self.closed, door, now, door in state.doors.closed)


def _note(course: dict[str, list[list[Any]]], name: str, now: int, value: str | bool) -> None:
    """Note a value from now on, unless it is as before: at first it is empty."""
    before = course[name][-1][1] if name in course else ""
    if value != before:
        course.setdefault(name, []).append([now, value])


def _task(mission_state: MissionState, name: str, since: float) -> dict[str, Any]:
    task, now = mission_state.tasks[name], _thousandths(since)
    return {
        "id": name,
        "type": task.type,
        "places": [[now, *_millimetres(task.position)]],
        "states": [[now, OPEN, None]],
    }


def _millimetres(place: Sequence[float]) -> list[int]:
    return [_thousandths(value) for value in place]


def _plans(recording: Recording, order: Mapping[str, int]) -> list[dict[str, Any]]:
    """For each plan its routes as lines: the number of the robot, and its points one after another."""
    return [
        {
            "at": _thousandths(version.time_s),
            "routes": [
                [order[robot], [value for point in line for value in _millimetres(point)]]
                for robot, line in version.lines.items()
                if robot in order and len(line) > 1
            ],
        }
        for version in recording.plans
    ]


def _nearest(recording: Recording, tracks: Tracks) -> dict[str, Any] | None:
    robots = recording.robots
    if len(robots) < 2 or not len(tracks.times_s):
        return None
    found = nearest(tracks.positions, np.array([robot.radius_m for robot in robots]))
    return {
        "metres": _differences(found.metres),
        "touch": _differences(found.touch_m),
        "first": found.pairs[:, 0].tolist(),
        "second": found.pairs[:, 1].tolist(),
    }


def _map(chart: Map | None, image: Grid | None, course: _Course) -> dict[str, Any] | None:
    if chart is None:
        return None
    return {
        "boundary": None if chart.boundary is None else [_millimetres(corner) for corner in chart.boundary],
        "zones": [_zone(zone, course) for zone in chart.zones],
        "image": None if image is None else _image(image),
    }


def _areas(tasks: Iterable[Task]) -> list[list[list[list[int]]]]:
    """The areas that tasks cover: of each its corners, then those of its holes."""
    areas = dict.fromkeys((area, *holes) for area, holes, _ in areas_of(tasks))
    return [[[_millimetres(corner) for corner in ring] for ring in area] for area in areas]


def _zone(zone: Zone, course: _Course) -> dict[str, Any]:
    low, high = zone.floor_m, zone.ceiling_m
    heights = (
        "" if low is None and high is None else f", {low or 0:g} m to {'the sky' if high is None else f'{high:g} m'}"
    )
    return {
        "corners": [_millimetres(corner) for corner in zone.polygon],
        "label": f"{f'door {zone.id}, closed' if zone.id else 'no entry'}: {', '.join(zone.forbidden_to)}{heights}",
        "label_open": f"door {zone.id}, open{heights}",
        "closed": course.closed.get(zone.id or "", [[0, True]]),
    }


def _image(image: Grid) -> dict[str, Any]:
    """The cells as run lengths, free and blocked alternately, from the lowest row on."""
    cells = image.blocked.ravel()
    ends = np.append(np.flatnonzero(cells[1:] != cells[:-1]) + 1, cells.size)
    runs = np.diff(np.concatenate([[0], ends])).tolist()
    return {
        "rows": image.shape[0],
        "columns": image.shape[1],
        "resolution": image.resolution_m,
        "origin": list(image.origin),
        "runs": [0, *runs] if cells[0] else runs,
    }


def _explored(recording: Recording) -> list[list[Any]]:
    """How the map of robots that had none has grown: when, and the event's data; null where they begin without one."""
    return [
        [_thousandths(event.time_s), dict(event.data) if isinstance(event, MapGrows) else None]
        for event in recording.events
        if isinstance(event, GroundUnknown | MapGrows)
    ]


def _figures(recording: Recording) -> list[list[str]]:
    """The report's figures in words; without a report, what follows from the events."""
    report = recording.report or {}
    done = report.get("tasks_done") or [event for event in recording.events if event.kind == "ends"]
    told = report.get("tasks_lost") or [event.data for event in recording.events if event.kind == "lost"]
    reasons = [one.get("reason") for one in told]
    cancelled = sum(map(was_cancelled, reasons))
    figures = [
        ["mission time", f"{recording.duration_s:.1f} s"],
        ["tasks done", str(len(done))],
        ["tasks lost", str(len(told) - sum(map(is_no_loss, reasons)))],
        *([["tasks cancelled", str(cancelled)]] if cancelled else []),
    ]
    for key, name, unit in _REPORTED:
        if isinstance(report.get(key), int | float):
            value = report[key]
            figures.append([name, f"{value:g}" if isinstance(value, int) else f"{value:.2f}{unit}"])
    if report.get("objective"):
        objective = report["objective"]
        planned = "" if objective["planned"] is None else f", planned {objective['planned']:.2f}"
        figures.append(["objective", f"{objective['flown']:.2f}{planned}"])
    return figures


_REPORTED = (
    ("contacts", "contacts", ""),
    ("min_distance_m", "least distance", " m"),
    ("waiting_s", "waiting", " s"),
    ("reallocations", "re-allocations", ""),
)
