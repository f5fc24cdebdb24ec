"""Makes a record from a run's log, as `muster simulate --record` writes it, and exports it.

Done by a worker, `record` of `server.work.tasks`.
"""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from muster.mission.model import Mission
from muster.report.page.data import MOST_SAMPLES
from muster.report.page.page import page_text
from muster.report.record import Recording, RecordWriter, read_record
from muster.report.record.plan_changes import ReadPlan
from muster.state import MissionState, event_of
from muster_control.runs.log.tracks import VALUES, Steps
from muster_control.runs.records.exports import EXPORTS
from muster_control.runs.records.record_files import read_log, read_tracks
from muster_control.work.missions import mission_of

Logged = Mapping[str, Any]
"""An entry: `time_s`, `kind`, `data`."""
_OURS = ("plan", "report", "command", "resumed")
_WAY_POINTS = 2000


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "folder", "to"}` -> `{"files"}`, or the figures where `to` is `flown`.

    The folder has log and tracks (`record_files`); `to` is `page`, `mcap`, `flown`, or one of `exports.EXPORTS`.
    """
    mission, source, to = mission_of(arguments["mission"]), Path(arguments["folder"]), arguments["to"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "record.mcap"
        write_record(file, mission, read_log(source), read_tracks(source))
        if to == "mcap":
            return _files({"record.mcap": file.read_bytes()})
        most = MOST_SAMPLES if to == "page" else None
        recording = replace(read_record(file, most), mission=mission)  # messages name the mission, not this file
    if to == "flown":
        return flown(recording)
    if to == "page":
        return _files({"page.html": page_text(recording).encode()})
    return _files({name: text.encode() for name, text in EXPORTS[to](recording, read_log(source)).items()})


def _files(found: Mapping[str, bytes]) -> dict[str, Any]:
    return {"files": {name: base64.b64encode(data).decode() for name, data in found.items()}}


def write_record(file: Path, mission: Mission, log: Iterable[Logged], stretches: Iterable[Steps]) -> None:
    """Pass a run's log and tracks to a recorder in the order of time, steps before events."""
    mission_state, steps, plan = MissionState(mission, forgets=False), _steps(stretches), ReadPlan("the log")
    with RecordWriter(file, mission) as writer:
        step = next(steps, None)
        for entry in log:
            while step is not None and step[0] <= entry["time_s"] + 1e-6:
                _tell_step(writer, list(mission_state.robots), *step)
                step = next(steps, None)
            _tell(writer, entry, plan)
            if entry["kind"] not in _OURS:
                mission_state.apply(event_of(entry["time_s"], entry["kind"], entry["data"]))
        while step is not None:
            _tell_step(writer, list(mission_state.robots), *step)
            step = next(steps, None)


def flown(recording: Recording) -> dict[str, Any]:
    """What was planned and what was carried out: in all, per robot and task, and the paths.

    `planned` has the routes of the first plan as lines, `tracks` each robot's [time_s, x, y, z], some thousand at most.
    """
    told = dict(recording.report or {})
    tracks = recording.tracks
    every = max(1, len(tracks.times_s) // _WAY_POINTS)
    places = np.column_stack([tracks.times_s, tracks.positions.reshape(len(tracks.times_s), -1)])[::every].round(3)
    ways = {}
    for k, robot in enumerate(tracks.robots):
        rows = places[:, [0, 1 + 3 * k, 2 + 3 * k, 3 + 3 * k]]
        ways[robot] = rows[np.isfinite(rows).all(axis=1)].tolist()
    lengths = np.nansum(np.linalg.norm(np.diff(tracks.positions, axis=0), axis=2), axis=0)
    robots = {row["robot"]: row for row in told.get("robots", ())}
    return {
        "mission_time_s": told.get("mission_time_s", recording.duration_s),
        "objective": told.get("objective"),
        "robots": [
            {**robots.get(robot, {"robot": robot}), "travelled_m": round(float(length), 3)}
            for robot, length in zip(tracks.robots, lengths, strict=True)
        ],
        "tasks": [
            {**row, "starts_s": told["starts_s"][row["task"]], "ends_s": told["ends_s"][row["task"]]}
            for row in told.get("tasks", ())
        ],
        "tasks_lost": told.get("tasks_lost", []),
        "states": recording.outcome.stages,
        "planned": dict(recording.plans[0].lines) if recording.plans else {},
        "tracks": ways,
    }


def _tell(writer: RecordWriter, entry: Logged, plan: ReadPlan) -> None:
    kind, data, now = entry["kind"], entry["data"], entry["time_s"]
    if kind == "plan":
        writer.on_plan(now, plan.take(data))
    elif kind == "report":
        writer.on_report(data)
    else:
        writer.on_event(now, kind, {"verb": data["verb"], **data["data"]} if kind == "command" else data)


def _tell_step(writer: RecordWriter, robots: Sequence[str], now: float, rows: Mapping[str, Any]) -> None:
    nowhere = np.full(VALUES, np.nan)
    states = np.array([rows.get(robot, nowhere) for robot in robots]).reshape(len(robots), VALUES)
    writer.on_step(now, states[:, :3], states[:, 3], states[:, 4:])


def _steps(stretches: Iterable[Steps]) -> Iterator[tuple[float, Mapping[str, Any]]]:
    for stretch in stretches:
        for now, rows in zip(stretch.times_s.tolist(), stretch.states, strict=True):
            yield now, dict(zip(stretch.robots, rows, strict=True))
