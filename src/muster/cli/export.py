"""`muster export`: a plan as files of other tools."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from muster.cli.exits import DONE
from muster.cli.options import Finite, load_mission, mission_argument, quiet_option, require_admissible, say_of_plan
from muster.cli.outputs import require_folder, require_writable
from muster.mission.errors import ParameterError
from muster.mission.hints import did_you_mean
from muster.mission.model import Mission
from muster.mission.plan import read_plan

if TYPE_CHECKING:
    from muster.exchange.itinerary import Itinerary
    from muster.exchange.qgc_writer import PlanFiles
    from muster.motion.roads import Roads
    from muster.verification import Verdict

FORMATS = ("qgc", "geojson", "gpx", "kml", "csv")


@dataclass(frozen=True)
class _Wishes:
    """What is asked for of plan files: the options that are theirs, by name."""

    altitude: float | None
    clearance: float
    tolerance: float
    firmware: str


def _format(_: click.Context, __: click.Parameter, value: str) -> str:
    if value not in FORMATS:
        hint = did_you_mean(value, FORMATS)
        raise click.BadParameter(f"{value!r} is not one of {', '.join(FORMATS)}{hint}", param_hint="'--to'")
    return value


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--to", "form", required=True, callback=_format, metavar="FORMAT", help=f"One of {', '.join(FORMATS)}.")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="For qgc a folder.")
@click.option(
    "--altitude",
    type=Finite(0, 1e5),
    metavar="M",
    help="qgc: fly no lower than so many metres above the start; needed for drones of a mission in the plane.",
)
@click.option(
    "--clearance",
    type=Finite(0, 1e5),
    default=0.0,
    show_default=True,
    metavar="M",
    help="qgc: warn where bodies come nearer to each other.",
)
@click.option(
    "--tolerance",
    type=Finite(0, 1e3),
    default=0.1,
    show_default=True,
    metavar="M",
    help="qgc: around corners of a map join way points, no farther than this from the way; 0 keeps all.",
)
@click.option(
    "--firmware", type=click.Choice(["px4", "ardupilot"]), default="px4", show_default=True, help="qgc: of the robots."
)
@quiet_option
def command(
    mission: str,
    plan: Path,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    form: str,
    output: Path | None,
    altitude: float | None,
    clearance: float,
    tolerance: float,
    firmware: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Write a PLAN of a MISSION for other tools: ground stations, maps, spreadsheets.

    All but csv need the mission's origin_wgs84. Without -o the file goes to standard output; qgc writes a file for each
    robot into a folder.
    """
    if form == "qgc":
        if output is None:
            raise ParameterError("-o missing; expected a folder for the .plan files")
        require_folder(output, "-o")
    else:
        _require_none_of_qgc(form)
        require_writable(None, (output,), (mission, robots, suitability), (plan,))
    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    given = read_plan(plan)
    say_of_plan(given, plan, loaded, quiet=quiet, verbose=verbose)
    verdict = require_admissible(loaded, given, plan)
    if form == "qgc":
        assert output is not None
        wishes = _Wishes(altitude, clearance, tolerance, firmware)
        messages = _write_plan_files(loaded, verdict, output, (mission, plan), wishes)
        for message in () if quiet else messages:
            click.echo(message, err=True)
        return DONE
    text = _text(loaded, verdict, form)
    if output is None:
        click.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8", newline="")
    return DONE


def _require_none_of_qgc(form: str) -> None:
    """Refuse wishes of plan files for a format that does not know them."""
    context = click.get_current_context()
    for field in fields(_Wishes):
        if context.get_parameter_source(field.name) is ParameterSource.COMMANDLINE:
            raise ParameterError(f"--{field.name} given; expected it with --to qgc, not {form}")


def _text(mission: Mission, verdict: Verdict, form: str) -> str:
    from muster.exchange.earth import Earth
    from muster.exchange.geojson import geojson_text
    from muster.exchange.gpx import gpx_text
    from muster.exchange.itinerary import itineraries
    from muster.exchange.kml import kml_text
    from muster.exchange.spreadsheet import csv_text
    from muster.exchange.survey import survey

    if form == "csv":
        return csv_text(mission, verdict, None if mission.origin_wgs84 is None else Earth.of(mission, "--to csv"))
    earth = Earth.of(mission, f"--to {form}")
    writer = {"geojson": geojson_text, "gpx": gpx_text, "kml": kml_text}[form]
    return writer(survey(mission, verdict, itineraries(mission, verdict), earth))


def _write_plan_files(
    mission: Mission, verdict: Verdict, folder: Path, inputs: tuple[str | Path, ...], wishes: _Wishes
) -> list[str]:
    """Write a file for each robot that has tasks; returns what a person has to know before anything flies."""
    from muster.exchange.earth import Earth
    from muster.exchange.itinerary import itineraries
    from muster.exchange.qgc_writer import PlanFiles
    from muster.exchange.separation import meetings
    from muster.motion.roads import Roads

    earth = Earth.of(mission, "--to qgc")
    roads = Roads.of(mission) if mission.travel_rule == "map" else None
    whole = itineraries(mission, verdict, roads)
    _require_heights(mission, whole, wishes.altitude)
    team = [_as_wished(itinerary, roads, wishes) for itinerary in whole]
    busy = [itinerary for itinerary in team if len(itinerary.passages) > 1]
    files = dict(zip(_file_names([i.robot.id for i in busy]), busy, strict=True))
    _require_free(folder, files, inputs)
    plans = PlanFiles(mission, earth, team, wishes.firmware)
    texts = {name: json.dumps(plans.plan(i), indent=4, sort_keys=True) + "\n" for name, i in files.items()}
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    messages = [f"{i.robot.id}: no tasks, no file" for i in team if i not in busy]
    messages += [message for i in busy for message in _notes(plans, i)]
    if mission.map is not None and mission.map.boundary is None:
        messages.append("warning: the map is an image; expected a boundary for a fence, the files have none")
    return messages + [f"warning: {meeting}" for meeting in meetings(team, wishes.clearance)]


def _as_wished(itinerary: Itinerary, roads: Roads | None, wishes: _Wishes) -> Itinerary:
    """With fewer bends around corners, and a drone no lower than it may fly."""
    from muster.exchange.thinning import thinned
    from muster.motion.world import body_of

    if roads is not None and wishes.tolerance:
        clear = partial(roads.clear, body_of(itinerary.robot))
        itinerary = thinned(itinerary, wishes.tolerance, clear)
    if wishes.altitude is None or itinerary.robot.kind == "ground":
        return itinerary
    return itinerary.at_least(wishes.altitude)


def _notes(plans: PlanFiles, itinerary: Itinerary) -> Iterator[str]:
    """What a person has to know of one robot's file."""
    from muster.exchange.antimeridian import crosses
    from muster.exchange.fence import Fence

    name, fence = itinerary.robot.id, Fence.of(plans.mission, itinerary)
    for k in fence.passed:
        yield f"warning: {name}: its way leads over or under zone {k}, which a fence cannot say; left out of its fence"
    for broken in fence.broken:
        how = "does not stay in" if broken == "the boundary" else "leads through"
        yield f"warning: {name}: its way {how} {broken}; its fence will stop it"
    if any(crosses(plans.earth.spots([*corners, corners[0]])) for corners, _ in fence.polygons):
        told = "autopilots may take the outside of such a fence for its inside"
        yield f"warning: {name}: its fence crosses the meridian of 180 degrees; {told}"
    low = [p for p in itinerary.under_way if p.place[2] <= itinerary.start.place[2]]
    if itinerary.robot.kind == "air" and low:
        where = f"task {low[0].task}" if low[0].task else "a way point"
        yield f"warning: {name}: flies no higher than its start at {where}; --altitude M gives a least height"


def _require_heights(mission: Mission, team: tuple[Itinerary, ...], altitude: float | None) -> None:
    drones = [i.robot.id for i in team if i.robot.kind == "air" and len(i.passages) > 1]
    if drones and mission.dimensions == 2 and not altitude:
        raise ParameterError(f"--altitude missing; expected metres above the start for {drones[0]} in the plane")


def _file_names(ids: list[str]) -> list[str]:
    """A name for each robot's file: its id, where files can be called so; no two differ by case alone."""
    names: list[str] = []
    for robot in ids:
        stem = "".join(c if c.isalnum() or c in "_-." else "_" for c in robot).lstrip(".") or "robot"
        taken, name, k = {known.casefold() for known in names}, f"{stem}.plan", 2
        while name.casefold() in taken:
            name, k = f"{stem}-{k}.plan", k + 1
        names.append(name)
    return names


def _require_free(folder: Path, files: dict[str, Itinerary], inputs: tuple[str | Path, ...]) -> None:
    """Refuse a folder in which something would be replaced that was read, or a plan of another mission be left."""
    read = {Path(name).resolve() for name in inputs}
    for name in files:
        if (folder / name).resolve() in read or folder.resolve() in read:
            raise ParameterError(f"{folder / name}: given twice; expected a folder whose files are not read")
    others = sorted(file.name for file in folder.glob("*.plan") if file.name not in files)
    if others:
        raise ParameterError(f"-o: {folder} holds {others[0]}; expected a folder without .plan files of other robots")
