"""A plan as files of other programs, and messages for the user before anything flies."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import partial

from muster.exchange.antimeridian import crosses
from muster.exchange.earth import Earth
from muster.exchange.export_request import FORMATS, Files, QgcOptions
from muster.exchange.fence import Fence
from muster.exchange.geographic_features import Survey, survey
from muster.exchange.geojson import geojson_text
from muster.exchange.gpx import gpx_text
from muster.exchange.itinerary import Itinerary, Passage, itineraries
from muster.exchange.kml import kml_text
from muster.exchange.qgc_writer import PlanFiles
from muster.exchange.separation import meetings
from muster.exchange.spreadsheet import csv_text
from muster.exchange.thinning import thinned
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.sol_files import sol_text
from muster.motion.map_world import body_of
from muster.motion.robot_paths import RobotPaths
from muster.verification import Verdict


def exported(mission: Mission, verdict: Verdict, form: str, options: QgcOptions) -> Files:
    """An admissible plan as files of a format: of qgc a file for each robot, of the others that ship one file.

    Parameters
    ----------
    options
        for qgc alone.

    Raises
    ------
    MissionError
        if the format needs a place on Earth and the mission has none.
    ParameterError
        if there is no such format, or drones have no height to fly at.
    """
    if form == "qgc":
        return plan_files(mission, verdict, options)
    made = FORMATS.named(form)(mission, verdict)
    return made if isinstance(made, Files) else Files({f"plan.{form}": made})


def csv_file(mission: Mission, verdict: Verdict) -> str:
    """The stops as a table; with places on Earth where the mission has its own."""
    return csv_text(mission, verdict, None if mission.origin_wgs84 is None else Earth.of(mission, "--to csv"))


def sol_file(mission: Mission, verdict: Verdict) -> str:
    """The routes as a solution of vehicle routing, stations in place; the cost is the total usage."""
    return sol_text(mission, (tuple(stop.name for stop in route.stops) for route in verdict.routes), verdict.total_cost)


def geojson_file(mission: Mission, verdict: Verdict) -> str:
    """Ways and stops as GeoJSON."""
    return geojson_text(_surveyed(mission, verdict, "geojson"))


def gpx_file(mission: Mission, verdict: Verdict) -> str:
    """Ways and stops as GPX."""
    return gpx_text(_surveyed(mission, verdict, "gpx"))


def kml_file(mission: Mission, verdict: Verdict) -> str:
    """Ways and stops as KML."""
    return kml_text(_surveyed(mission, verdict, "kml"))


def _surveyed(mission: Mission, verdict: Verdict, form: str) -> Survey:
    earth = Earth.of(mission, f"--to {form}")
    return survey(mission, verdict, itineraries(mission, verdict), earth)


def plan_files(mission: Mission, verdict: Verdict, options: QgcOptions | None = None) -> Files:
    """An admissible plan as QGroundControl's files, one for each robot that has tasks.

    Raises
    ------
    MissionError
        if the mission has no place on Earth.
    ParameterError
        if drones have no height to fly at.
    """
    options = options or QgcOptions()
    earth = Earth.of(mission, "--to qgc")
    robot_paths = RobotPaths.of(mission) if mission.travel_rule == "map" else None
    whole = itineraries(mission, verdict, robot_paths)
    _require_heights(mission, whole, options.altitude)
    team = [_adapted(itinerary, robot_paths, options) for itinerary in whole]
    busy = [itinerary for itinerary in team if len(itinerary.passages) > 1]
    files = dict(zip(_file_names([i.robot.id for i in busy]), busy, strict=True))
    plans = PlanFiles(mission, earth, team, options.firmware)
    texts = {name: json.dumps(plans.plan(i), indent=4, sort_keys=True) + "\n" for name, i in files.items()}
    messages = [f"{i.robot.id}: no tasks, no file" for i in team if i not in busy]
    messages += [message for i in busy for message in _notes(plans, i)]
    if mission.map is not None and mission.map.boundary is None:
        messages.append("warning: the map is an image; expected a boundary for a fence, the files have none")
    messages += [f"warning: {meeting}" for meeting in meetings(team, options.clearance)]
    return Files(texts, tuple(messages))


def _adapted(itinerary: Itinerary, robot_paths: RobotPaths | None, options: QgcOptions) -> Itinerary:
    """An itinerary with fewer bends around corners, and with the least height of drones."""
    if robot_paths is not None and options.tolerance:
        clear = partial(robot_paths.clear, body_of(itinerary.robot))
        itinerary = thinned(itinerary, options.tolerance, clear)
    if options.altitude is None or itinerary.robot.kind == "ground":
        return itinerary
    return itinerary.at_least(options.altitude)


def _notes(plans: PlanFiles, itinerary: Itinerary) -> Iterator[str]:
    """Messages about one robot's file."""
    name, fence = itinerary.robot.id, Fence.of(plans.mission, itinerary)
    for k in fence.passed:
        yield f"warning: {name}: its way leads over or under zone {k}, which a fence cannot say; left out of its fence"
    for broken in fence.broken:
        how = "does not stay in" if broken == "the boundary" else "leads through"
        yield f"warning: {name}: its way {how} {broken}; its fence will stop it"
    if stations := dict.fromkeys(passage.station for passage in itinerary.passages if passage.station is not None):
        yield f"{name}: holds at {', '.join(stations)} for its service; whether it lands there is up to you"
    if any(crosses(plans.earth.spots([*corners, corners[0]])) for corners, _ in fence.polygons):
        told = "autopilots may take the outside of such a fence for its inside"
        yield f"warning: {name}: its fence crosses the meridian of 180 degrees; {told}"
    low = [p for p in itinerary.under_way if p.place[2] <= itinerary.start.place[2]]
    if itinerary.robot.kind == "air" and low:
        yield f"warning: {name}: flies no higher than its start at {_named(low[0])}; --altitude M gives a least height"


def _named(passage: Passage) -> str:
    if passage.task:
        return f"task {passage.task}"
    return f"station {passage.station}" if passage.station else "a way point"


def _require_heights(mission: Mission, team: tuple[Itinerary, ...], altitude: float | None) -> None:
    drones = [i.robot.id for i in team if i.robot.kind == "air" and len(i.passages) > 1]
    if drones and mission.dimensions == 2 and not altitude:
        raise ParameterError(f"--altitude missing; expected metres above the start for {drones[0]} in the plane")


def _file_names(ids: list[str]) -> list[str]:
    """A name for each robot's file: its id without characters that files cannot have. No two differ by case alone."""
    names: list[str] = []
    for robot in ids:
        stem = "".join(c if c.isalnum() or c in "_-." else "_" for c in robot).lstrip(".") or "robot"
        taken, name, k = {known.casefold() for known in names}, f"{stem}.plan", 2
        while name.casefold() in taken:
            name, k = f"{stem}-{k}.plan", k + 1
        names.append(name)
    return names
