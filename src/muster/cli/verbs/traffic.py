"""`muster traffic`: the roadmap that the robots of a mission share."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options.common import Finite, MissionFile, format_option, load_plan, mission_argument, quiet_option
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.tables.table import number, sequence
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import json_text
from muster.mission.texts.counting import counted

if TYPE_CHECKING:
    from muster.traffic.journeys.forecast import Forecast
    from muster.traffic.mission_roadmap import MissionRoadmap
    from muster.traffic.passages import Passage


@click.command()
@mission_argument
@click.option(
    "--margin",
    type=Finite(1e-6, 1e6),
    default=0.02,
    show_default=True,
    metavar="M",
    help="What two robots keep between them beyond touching, metres.",
)
@click.option(
    "--plan",
    type=click.Path(exists=True, dir_okay=False, path_type=File),
    metavar="FILE",
    help="Forecast how long the plan takes where robots pass in turn.",
)
@format_option
@click.option("--plot", type=click.Path(path_type=File), metavar="FILE", help="Draw the roadmap (.png, .svg, .pdf).")
@quiet_option
def command(
    mission: MissionFile, margin: float, plan: File | None, form: str, plot: File | None, quiet: bool, verbose: bool
) -> int:
    """Show the roadmap that the robots of a MISSION share: its lanes, passages for one, dead ends and holding places.

    It is made of the mission's lanes where it gives them, else of its map, else of the open area around its places, for
    each size of the robots that drive.
    """
    from muster.motion.map_world import World
    from muster.traffic.mission_roadmap import MissionRoadmap
    from muster.traffic.passages import passages

    require_writable(None, (plot,), mission.files, ())
    require_drawable(plot)
    loaded = mission.load(verbose=verbose)
    world = None if loaded.map is None else World.of(loaded)
    made = MissionRoadmap.of(loaded, world, margin_m=margin)
    found = passages(made.roadmap)
    if not quiet:
        _warn(loaded, made)
    if plot is not None:
        from muster.report.figures.files import save_figure
        from muster.report.maps.roadmap_picture import plot_roadmap

        save_figure(plot_roadmap(loaded, made, found, image=None if world is None else world.image), plot)
    forecast = None if plan is None else _forecast(loaded, plan, made, quiet=quiet, verbose=verbose)
    if form == "json":
        told = {} if forecast is None else {"plan": {"robots": [asdict(one) for one in forecast.robots]}}
        click.echo(json_text(_figures(made, found) | told), nl=False)
    else:
        _print(loaded, made, found)
        if forecast is not None:
            _print_forecast(forecast)
    return DONE


def _forecast(mission: Mission, file: File, made: MissionRoadmap, *, quiet: bool, verbose: bool) -> Forecast:
    from muster.mission.plan import RouteStop
    from muster.traffic.journeys.forecast import forecast
    from muster.verification import verify

    plan = load_plan(file, mission, quiet=quiet, verbose=verbose)
    verdict = verify(mission, plan, plan.ignored, plan.objective)
    if not verdict.valid:
        raise ParameterError(f"--plan: {file}: the judge rejects this plan: {verdict.first_violations}")
    routes = {
        route.robot: [RouteStop(one.task, one.arrives_s, one.starts_s, one.ends_s) for one in route.visits]
        for route in verdict.routes
    }
    return forecast(mission, routes, made.plan())


def _print_forecast(forecast: Forecast) -> None:
    """Print when robots have ended their routes, and how much of that they wait for others."""
    from muster.cli.tables.plan import print_traffic_times
    from muster.cli.tables.table import print_table
    from muster.traffic.journeys.forecast import finite

    rows = [
        (one.robot, number(one.alone_s), number(one.with_traffic_s), number(finite(one.delay_s)))
        for one in forecast.robots
    ]
    columns = ("robot", "alone [s]", "with traffic [s]", "more [s]")
    print_table(columns, rows, right=columns[1:])
    print_traffic_times(forecast.with_traffic_s, forecast.alone_s)


def _warn(mission: Mission, made: MissionRoadmap) -> None:
    """Print on standard error the lanes that are left out, and the places that no way leads to."""
    for lane in dict.fromkeys(lane for lanes in made.closed for lane in lanes):
        click.echo(f"warning: lanes.edges[{lane.number}]: {lane.reason}; the lane is left out", err=True)
    for radius_m, point_of in zip(made.roadmap.radii_m.tolist(), made.point_of, strict=True):
        away = [f"({x:g}, {y:g})" for (x, y), point in point_of.items() if point < 0]
        if away:
            click.echo(f"warning: no way for radius {radius_m:g} m leads to {sequence(away)}", err=True)


def _figures(made: MissionRoadmap, found: tuple[Passage, ...]) -> dict[str, Any]:
    roadmap = made.roadmap
    return {
        "radius_m": float(roadmap.radii_m[-1]),
        "radii_m": roadmap.radii_m.tolist(),
        "margin_m": roadmap.margin_m,
        "points": len(roadmap.points),
        "holding_places": int(roadmap.holding.sum()),
        "edges": len(roadmap.edges),
        "one_way": int(roadmap.one_way.sum()),
        "length_m": float(roadmap.lengths_m[~roadmap.one_way].sum() / 2 + roadmap.lengths_m[roadmap.one_way].sum()),
        "passages_for_one": len(found),
        "dead_ends": sum(one.is_dead_end for one in found),
        "lanes_left_out": sorted({lane.number for lanes in made.closed for lane in lanes}),
        "places_without_a_way": list(
            dict.fromkeys(place for points in made.point_of for place, point in points.items() if point < 0)
        ),
    }


def _print(mission: Mission, made: MissionRoadmap, found: tuple[Passage, ...]) -> None:
    from muster.cli.tables.table import print_table

    figures = _figures(made, found)
    rows = [
        ("points", figures["points"]),
        ("  holding places", figures["holding_places"]),
        ("edges", figures["edges"]),
        ("  one-way", figures["one_way"]),
        ("passages for one", figures["passages_for_one"]),
        ("  dead ends", figures["dead_ends"]),
    ]
    print_table(("roadmap", "number"), [(name, str(count)) for name, count in rows], right=("number",))
    radii = sequence([f"{radius_m:g} m" for radius_m in figures["radii_m"]])
    about = f"{counted(len(made.robots), 'robot')}, radius {radii}, margin {figures['margin_m']:g} m"
    click.echo(f"{mission.name}: {about}; {figures['length_m']:.0f} m of lanes")
