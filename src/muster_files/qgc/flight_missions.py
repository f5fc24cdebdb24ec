"""The flights of files as one mission: a robot a file, a task for each stop and survey, the first home the origin."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.geodesy import wgs84_to_enu
from muster.mission.import_ledger import Ledger, LedgerBook, joined
from muster.mission.model import SCHEMA
from muster.mission.reading.from_data import mission_from
from muster.mission.source import Source
from muster.planning.mission_readers import Noted
from muster_files.qgc.fences import Corner, Fences, map_of
from muster_files.qgc.fields import Degrees, PlanFields
from muster_files.qgc.flight import Flight, require_near
from muster_files.qgc.survey_reader import Survey
from muster_files.sites.features import Document

_SAME_PLACE_M = 0.01


@dataclass(frozen=True)
class FlownFile:
    """The content of one file; `speed_mps` is None where it states no speed."""

    name: str
    fields: PlanFields
    home: Degrees
    kind: str
    speed_mps: float | None
    flight: Flight
    surveys: tuple[Survey, ...]
    fences: Fences
    notes: tuple[str, ...]
    document: Document

    @property
    def last_at(self) -> Degrees:
        """Where the vehicle is after its last stop or survey."""
        ends = {number: stop.place for number, stop in self.flight.stops.items()}
        ends |= {survey.number: (*survey.ends_at, self.home[2]) for survey in self.surveys if survey.ends_at}
        return ends[max(ends)] if ends else self.home


def mission_of(path: Path, files: Sequence[FlownFile], stated: Sequence[float] | None = None) -> Noted:
    """Return the mission of the flights of files; `path` is the file, or the folder of all of them.

    The origin is as stated, degrees and perhaps metres of altitude; else, and where it has no altitude, the first home.

    Raises
    ------
    MissionError
        for the first fence with another boundary, the first home far from the others, and values that do not fit.
    """
    lat, lon, *height = stated or files[0].home
    origin = lat, lon, height[0] if height else files[0].home[2]
    for file in files:
        require_near(file.fields, file.home[:2], origin, "mission.plannedHomePosition")
    spatial = not all(file.kind == "ground" for file in files)

    def metres(place: Degrees) -> list[float]:
        point: list[float] = wgs84_to_enu([place], origin)[0].tolist()
        return point if spatial else point[:2]

    def on_map(corner: Corner) -> Corner:
        east, north, _ = wgs84_to_enu([(*corner, origin[2])], origin)[0].tolist()
        return east, north

    robots = [_robot(file, metres) for file in files]
    tasks = [task for file in files for task in _tasks(file, metres)]
    places = [one[key] for one in (*robots, *tasks) for key in ("position", "end_position") if key in one]
    places += [corner for task in tasks for corner in task.get("action", {}).get("area", ())]
    fences, kinds = [file.fences for file in files], [file.kind for file in files]
    chart = map_of(fences, kinds, on_map, places, lambda k: _without_boundary(files[k]))
    data = {
        "schema": SCHEMA,
        "name": path.stem,
        "origin_wgs84": dict(zip(("lat_deg", "lon_deg", "alt_m"), origin, strict=True)),
        "robots": robots,
        "tasks": tasks,
    } | ({} if chart is None else {"map": chart})
    ledger = joined(_ledger(file) for file in files)
    notes = [note for file in files for note in file.notes]
    if chart is not None and not any(fence.inside for fence in fences):
        notes.append(f"{path}: no fence to stay in: a rectangle 50 m around everything is taken for the boundary")
    return Noted(mission_from(data, Source(str(path)), []), tuple(notes), ledger)


def _ledger(file: FlownFile) -> Ledger:
    book = LedgerBook(str(file.fields.file))
    file.document.enter(book)
    return book.ledger()


def _without_boundary(file: FlownFile) -> MissionError:
    """The error for a fence with no boundary, several, or another than the other files have."""
    expected = "one polygon or circle with inclusion, the same in all files"
    return MissionError(
        [Finding(str(file.fields.file), None, "geoFence.polygons", "not the mission's boundary", expected)]
    )


def _tasks(file: FlownFile, metres: Callable[[Degrees], list[float]]) -> Iterator[dict[str, Any]]:
    surveys = {survey.number: survey for survey in file.surveys}
    rounds: Counter[int] = Counter()
    for number in file.flight.order:
        rounds[number] += 1
        task: dict[str, Any] = {"id": _task_id(file, number, rounds[number])}
        if (survey := surveys.get(number)) is not None:
            task["action"] = survey.action([metres((*at, file.home[2]))[:2] for at in survey.corners])
        else:
            stop = file.flight.stops[number]
            task |= {"position": metres(stop.place)} | ({"duration_s": stop.hold_s} if stop.hold_s else {})
        if rounds[number] > 1:
            loop = file.flight.loops[number]
            task["prerequisites"] = [_task_id(file, one, rounds[number] - 1) for one in loop]
        yield task


def _task_id(file: FlownFile, number: int, repetition: int) -> str:
    return f"{file.name}-{number}" if repetition == 1 else f"{file.name}-{number}.{repetition}"


def _robot(file: FlownFile, metres: Callable[[Degrees], list[float]]) -> dict[str, Any]:
    data: dict[str, Any] = {"id": file.name, "position": metres(file.home), "kind": file.kind}
    if file.speed_mps is not None:
        data["speed_mps"] = file.speed_mps
    if file.flight.climbs and file.kind == "air":
        data["climb_mps"] = min(file.flight.climbs)
    if (lens := next((survey.lens for survey in file.surveys if survey.lens), None)) is not None:
        data["camera"] = lens.camera()
    lands_at = file.flight.lands_at
    if file.flight.returns:
        return data | {"return_to_start": True}
    if lands_at is None or _over(lands_at, file.last_at):
        return data
    return data | {"end_position": metres(lands_at)}


def _over(a: Degrees, b: Degrees) -> bool:
    """Whether two places differ in height alone."""
    (apart,) = wgs84_to_enu([(*a[:2], b[2])], b)
    return math.hypot(*apart[:2]) < _SAME_PLACE_M
