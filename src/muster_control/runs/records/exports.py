"""Exports of a record: tracks and events as CSV; tracks as GeoJSON, GPX, KML; the log as JSON.

GeoJSON is RFC 7946, GPX 1.1 topografix.com/GPX/1/1, KML 2.2 OGC 07-147r2. Tracks that cross the meridian of 180
degrees are cut there. Formats on the earth need the mission's `origin_wgs84`.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any
from xml.etree import ElementTree as Tree

import numpy as np

from muster.report.record import Recording
from muster_files.antimeridian import cut_line
from muster_files.earth import Earth, Spot
from muster_files.formula_cells import cell
from muster_files.geojson import one_or_many
from muster_files.xml_text import add, decimal, text_of

Log = Iterable[Mapping[str, Any]]


def csv_files(recording: Recording, _: Log) -> dict[str, str]:
    """`tracks.csv` with a line a robot and step, `events.csv` with a line an event."""
    events = [(event.time_s, cell(event.kind), cell(event.line)) for event in recording.events]
    return {
        "tracks.csv": _csv(("time_s", "robot", "x", "y", "z", "heading_rad", "speed_mps"), _track_rows(recording)),
        "events.csv": _csv(("time_s", "kind", "what"), events),
    }


def _track_rows(recording: Recording) -> Iterator[Sequence[Any]]:
    tracks = recording.tracks
    for i, now in enumerate(tracks.times_s.tolist()):
        for k, robot in enumerate(tracks.robots):
            place = tracks.positions[i, k]
            if np.isfinite(place).all():
                speed = float(np.linalg.norm(tracks.velocities[i, k]))
                yield now, cell(robot), *place.tolist(), float(tracks.headings[i, k]), round(speed, 4)


def geojson_file(recording: Recording, _: Log) -> dict[str, str]:
    """A LineString for each robot, with the mission's clock at each of its points, and a Point for each task."""
    features = []
    for robot, times, spots in _tracks(recording, "GeoJSON"):
        pieces = [[[spot.lon, spot.lat, spot.alt] for spot in line] for line in cut_line(spots)]
        shape = one_or_many("LineString", [piece if len(piece) > 1 else piece * 2 for piece in pieces])
        features.append(_feature(shape, {"name": robot, "kind": "track", "times_s": times}))
    outcome = recording.outcome
    for name, spot in zip(outcome.tasks, _task_spots(recording, "GeoJSON"), strict=True):
        shape = {"type": "Point", "coordinates": [spot.lon, spot.lat, spot.alt]}
        features.append(_feature(shape, {"name": name, "kind": "task", "state": outcome.stage(name)}))
    data = {"type": "FeatureCollection", "name": recording.mission.name, "features": features}
    return {"flown.geojson": json.dumps(data, ensure_ascii=False)}


def gpx_file(recording: Recording, _: Log) -> dict[str, str]:
    """A way point for each task, then a track for each robot."""
    root = Tree.Element("gpx", {"version": "1.1", "creator": "Muster", "xmlns": "http://www.topografix.com/GPX/1/1"})
    add(add(root, "metadata"), "name", recording.mission.name)
    for name, spot in zip(recording.outcome.tasks, _task_spots(recording, "GPX"), strict=True):
        point = add(root, "wpt", lat=decimal(spot.lat), lon=decimal(_below_180(spot.lon)))
        add(point, "ele", spot.alt)
        add(point, "name", name)
        add(point, "desc", recording.outcome.stage(name))
    for robot, _times, spots in _tracks(recording, "GPX"):
        track = add(root, "trk")
        add(track, "name", robot)
        for line in cut_line(spots):
            segment = add(track, "trkseg")
            for spot in line:
                point = add(segment, "trkpt", lat=decimal(spot.lat), lon=decimal(_below_180(spot.lon)))
                add(point, "ele", spot.alt)
    return {"flown.gpx": text_of(root)}


def kml_file(recording: Recording, _: Log) -> dict[str, str]:
    """A line for each robot; heights are those of the mission, over the ground."""
    root = Tree.Element("kml", {"xmlns": "http://www.opengis.net/kml/2.2"})
    document = add(root, "Document")
    add(document, "name", recording.mission.name)
    ground = 0.0 if recording.mission.origin_wgs84 is None else recording.mission.origin_wgs84.alt_m
    for robot, _times, spots in _tracks(recording, "KML"):
        mark = add(document, "Placemark")
        add(mark, "name", robot)
        lines = add(mark, "MultiGeometry")
        for line in cut_line(spots):
            shape = add(lines, "LineString")
            add(shape, "altitudeMode", "relativeToGround")
            places = (f"{decimal(s.lon)},{decimal(s.lat)},{decimal(round(s.alt - ground, 4))}" for s in line)
            add(shape, "coordinates", " ".join(places))
    return {"flown.kml": text_of(root)}


def json_file(recording: Recording, log: Log) -> dict[str, str]:
    """The log as it is, and the report."""
    data = {"mission": recording.mission.name, "log": list(log), "report": recording.report}
    return {"log.json": json.dumps(data, ensure_ascii=False, indent=1)}


EXPORTS: Mapping[str, Callable[[Recording, Log], dict[str, str]]] = MappingProxyType(
    {"csv": csv_files, "geojson": geojson_file, "gpx": gpx_file, "kml": kml_file, "json": json_file}
)
"""By format: files by their names."""


def _tracks(recording: Recording, purpose: str) -> list[tuple[str, list[float], list[Spot]]]:
    """Of each robot that was anywhere: when, and where on the earth."""
    earth, tracks, found = Earth.of(recording.mission, purpose), recording.tracks, []
    for k, robot in enumerate(tracks.robots):
        there = np.isfinite(tracks.positions[:, k]).all(axis=1)
        if there.any():
            spots = earth.spots(map(tuple, tracks.positions[there, k].tolist()))
            found.append((robot, tracks.times_s[there].tolist(), spots))
    return found


def _task_spots(recording: Recording, purpose: str) -> list[Spot]:
    return Earth.of(recording.mission, purpose).spots(task.position for task in recording.outcome.tasks.values())


def _feature(geometry: Mapping[str, Any], properties: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _below_180(lon: float) -> float:
    """GPX has longitudes from -180 on, and below 180."""
    return -180.0 if lon >= 180 else lon


def _csv(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return out.getvalue()
