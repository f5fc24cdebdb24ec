"""A plan as files of other programs, and messages for the user before anything flies."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from muster.execution.reports.itinerary import Itinerary, Passage, itineraries
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.map_world import body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.planning.export_formats import ALTITUDE_MISSING, HEIGHTS, ExportOptions, Files, declares
from muster.verification import Verdict
from muster.verification.required import require_geometry
from muster_files.altitudes import altitudes_of, at_work, height_notes, raised, raised_team
from muster_files.antimeridian import crosses
from muster_files.earth import Earth
from muster_files.fence import Fence
from muster_files.file_names import file_names
from muster_files.geographic_features import PlanFeatures, features_of
from muster_files.geojson import geojson_text
from muster_files.gpx import gpx_text
from muster_files.instances.sol_files import sol_text
from muster_files.kml import kml_text
from muster_files.open_ways import require_open_itineraries
from muster_files.qgc.writer import PlanFiles
from muster_files.spreadsheet import csv_text
from muster_files.thinning import thinned


def csv_file(mission: Mission, verdict: Verdict) -> str:
    """The stops as a table; with places on Earth where the mission has its own."""
    return csv_text(mission, verdict, None if mission.origin_wgs84 is None else Earth.of(mission, "--to csv"))


def sol_file(mission: Mission, verdict: Verdict) -> str:
    """The routes as a solution of vehicle routing, stations in place; the cost is the total usage."""
    return sol_text(mission, (tuple(stop.name for stop in route.stops) for route in verdict.routes), verdict.total_cost)


@declares(options=HEIGHTS)
def geojson_file(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """Ways and stops as GeoJSON."""
    features, notes = _features(mission, verdict, "geojson", options)
    return Files({"plan.geojson": geojson_text(features)}, notes)


@declares(options=HEIGHTS)
def gpx_file(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """Ways and stops as GPX."""
    features, notes = _features(mission, verdict, "gpx", options)
    return Files({"plan.gpx": gpx_text(features)}, notes)


@declares(options=HEIGHTS)
def kml_file(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """Ways and stops as KML."""
    features, notes = _features(mission, verdict, "kml", options)
    return Files({"plan.kml": kml_text(features)}, notes)


def _features(
    mission: Mission, verdict: Verdict, form: str, options: ExportOptions
) -> tuple[PlanFeatures, tuple[str, ...]]:
    """The features of a plan, drones at their heights, and messages on these."""
    earth = Earth.of(mission, f"--to {form}")
    require_geometry(mission, f"--to {form}")
    altitudes = altitudes_of(mission, options)
    team, notes = raised_team(mission, verdict, altitudes, options)
    require_open_itineraries(mission, team)
    return features_of(mission, verdict, team, earth, layered=altitudes), notes


@declares(options=(*HEIGHTS, "tolerance", "firmware"), folder=True)
def plan_files(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """An admissible plan as QGroundControl's files, one for each robot that has tasks.

    Raises
    ------
    MissionError
        if the mission has no place on Earth.
    ParameterError
        if drones have no height to fly at, or an altitude is for no drone.
    """
    earth = Earth.of(mission, "--to qgc")
    require_geometry(mission, "--to qgc")
    robot_paths = RobotPaths.of(mission) if mission.travel_rule == "map" else None
    altitudes = altitudes_of(mission, options)
    if robot_paths is None and options.tolerance != ExportOptions.tolerance:
        told = "expected it with travel over a map, whose corners it is for: no robot of the mission travels so"
        raise ParameterError(f"tolerance: {options.tolerance:g}; {told}")
    straight = [_thinned(i, robot_paths, options.tolerance) for i in itineraries(mission, verdict, robot_paths)]
    whole = at_work(mission, straight)
    _require_heights(mission, whole, altitudes)
    team = [raised(itinerary, altitudes) for itinerary in whole]
    require_open_itineraries(mission, team)
    busy = [itinerary for itinerary in team if len(itinerary.passages) > 1]
    files = dict(zip(file_names([i.robot.id for i in busy], ".plan"), busy, strict=True))
    plans = PlanFiles(mission, earth, team, options.firmware)
    texts = {name: json.dumps(plans.plan(i), indent=4, sort_keys=True) + "\n" for name, i in files.items()}
    messages = [f"{i.robot.id}: no tasks, no file" for i in team if i not in busy]
    messages += [message for i in busy for message in _notes(plans, i)]
    if mission.map is not None and mission.map.boundary is None:
        messages.append("warning: the map is an image; expected a boundary for a fence, the files have none")
    messages += height_notes(mission, whole, team, options)
    return Files(texts, tuple(messages))


def _thinned(itinerary: Itinerary, robot_paths: RobotPaths | None, tolerance: float) -> Itinerary:
    """An itinerary with fewer bends around corners."""
    if robot_paths is None or not tolerance:
        return itinerary
    return thinned(itinerary, tolerance, partial(robot_paths.clear, body_of(itinerary.robot)))


def _notes(plans: PlanFiles, itinerary: Itinerary) -> Iterator[str]:
    """Messages about one robot's file."""
    name, fence = itinerary.robot.id, Fence.of(plans.mission, itinerary)
    for k in fence.passed:
        yield f"warning: {name}: its way leads over or under zone {k}, which a fence cannot say; left out of its fence"
    if stations := dict.fromkeys(passage.station for passage in itinerary.passages if passage.station is not None):
        yield f"{name}: holds at {', '.join(stations)} for its service; whether it lands there is up to you"
    if any(crosses(plans.earth.spots([*corners, corners[0]])) for corners, _ in fence.polygons):
        told = "autopilots may take the outside of such a fence for its inside"
        yield f"warning: {name}: its fence crosses the meridian of 180 degrees; {told}"
    low = [p for p in itinerary.under_way if p.place[2] <= itinerary.start.place[2]]
    if itinerary.robot.kind == "air" and low:
        yield f"warning: {name}: flies no higher than its start at {_named(low[0])}; --altitude M gives a least height"
    if itinerary.robot.kind == "air":
        yield f"{name}: {_landing(itinerary)}"


def _landing(itinerary: Itinerary) -> str:
    """Where a drone lands, as the ending of its file says."""
    start, last = itinerary.start.place, itinerary.passages[-1].place
    if itinerary.has_end and itinerary.robot.end_position is None:
        return "lands at its start"
    away = f"{math.dist(start[:2], last[:2]):.0f} m from its start"
    if itinerary.has_end:
        return f"lands at its end_position, {away}"
    return (
        f"lands where its route ends, at {_named(itinerary.passages[-1])}, {away}; return_to_start: true lets it return"
    )


def _named(passage: Passage) -> str:
    if passage.task:
        return f"task {passage.task}"
    return f"station {passage.station}" if passage.station else "a way point"


def _require_heights(mission: Mission, team: Sequence[Itinerary], altitudes: Mapping[str, float]) -> None:
    drones = [
        i.robot.id for i in team if i.robot.kind == "air" and len(i.passages) > 1 and not altitudes.get(i.robot.id)
    ]
    if drones and mission.dimensions == 2:
        raise ParameterError(f"{ALTITUDE_MISSING}; expected metres above the start for {drones[0]} in the plane")
