"""`muster path`: a path for one robot from one point to another on a mission's map."""

from __future__ import annotations

import math
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options.common import Finite, MissionFile, format_option, mission_argument, quiet_option
from muster.cli.outputs import require_csv, require_drawable, require_writable
from muster.cli.verbs.smooth_path import bends_of, corners_of, require_turning_radius, smooth_path, write_trajectory
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot
from muster.mission.plan import json_text
from muster.mission.texts.near_matches import did_you_mean
from muster.motion.path import NoPath, Path

if TYPE_CHECKING:
    from muster.motion.map_world import Body, World

_PLANNERS = (
    "shortest",
    "theta-star",
    "a-star",
    "dijkstra",
    "rrt-star",
    "rrt",
    "bug",
    "potential-field",
    "dubins",
)
_GUIDANCE = ("pure-pursuit", "virtual-target", "synthetic-waypoint")
_FILE = click.Path(path_type=File)


@click.command()
@mission_argument
@click.option("--from", "start", metavar="X,Y[,Z]", help="Where the path begins, metres.")
@click.option("--to", "goal", metavar="X,Y[,Z]", help="Where it ends.")
@click.option(
    "--planner",
    type=click.Choice(_PLANNERS),
    default="shortest",
    show_default=True,
    metavar="PLANNER",
    help=f"What finds it: {', '.join(_PLANNERS)}.",
)
@click.option("--robot", metavar="ID", help="Radius and kind are those of this robot.")
@click.option("--radius", type=float, metavar="R", help="Radius of the body, metres.  [default: 0]")
@click.option("--kind", type=click.Choice(("ground", "air")), help="Where the body moves.  [default: ground]")
@click.option("--smooth", is_flag=True, help="Round the corners by a radius that the robot can drive.")
@click.option(
    "--turning-radius",
    type=float,
    metavar="R",
    help="Metres: of --smooth  [default: the robot's at full speed, else 0.1], of the planner dubins  [default: 0.5],"
    " of --unknown  [default: it turns on the spot]",
)
@click.option(
    "--trajectory", type=_FILE, metavar="FILE", help="Write the motion along the path with its speeds (.csv)."
)
@click.option(
    "--follow", type=click.Choice(_GUIDANCE), help="Drive the path by this law of guidance; show what is driven."
)
@click.option("--lookahead", type=float, metavar="M", help="Of --follow: how far ahead the target is.  [default: 0.5]")
@click.option("--unknown", is_flag=True, help="The robot has no map: it builds one with its laser, and goes by it.")
@click.option(
    "--together", multiple=True, metavar="ROBOT=X,Y", help="Paths of several robots at once, each from its start."
)
@click.option(
    "--cell", type=float, metavar="M", help="Of --together: side of a cell.  [default: the least with diagonals]"
)
@click.option(
    "--window", type=click.IntRange(min=2), metavar="N", help="Of --together: look at others for N steps only."
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of what is random.")
@click.option(
    "--joint",
    is_flag=True,
    help="Paths of all robots, step by step: of --scenario, or of --together on the roadmap.",
)
@click.option("--scenario", type=_FILE, metavar="FILE", help="Of --joint: starts and goals on a MovingAI map (.scen).")
@click.option("--agents", type=click.IntRange(min=1), metavar="N", help="Of --joint: the first N.  [default: all]")
@click.option("--time-limit", type=Finite(1e-3, 1e6), metavar="S", help="Of --joint, seconds.  [default: 10]")
@click.option(
    "--expansions",
    type=click.IntRange(min=1),
    metavar="N",
    help="Of --joint: end after N expansions; of --lifelong: N operations are checked a step.  [default: 1000000]",
)
@click.option(
    "-o",
    "--output",
    type=_FILE,
    metavar="FILE",
    help="Of --joint: write the paths (.json, else text); of --lifelong: what the league writes (.json).",
)
@click.option("--lifelong", is_flag=True, help="Run an instance of the League of Robot Runners (MISSION: its .json).")
@click.option("--steps", type=click.IntRange(min=1), metavar="N", help="Of --lifelong.  [default: 600]")
@format_option
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw the path on the map (.png, .svg, .pdf).")
@quiet_option
def command(  # noqa: PLR0913  the options of a verb
    mission: MissionFile,
    start: str | None,
    goal: str | None,
    planner: str,
    robot: str | None,
    radius: float | None,
    kind: str | None,
    smooth: bool,
    turning_radius: float | None,
    trajectory: File | None,
    follow: str | None,
    lookahead: float | None,
    unknown: bool,
    together: tuple[str, ...],
    cell: float | None,
    window: int | None,
    seed: int,
    joint: bool,
    scenario: File | None,
    agents: int | None,
    time_limit: float | None,
    expansions: int | None,
    output: File | None,
    lifelong: bool,
    steps: int | None,
    form: str,
    plot: File | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Find a path for one robot on the map of a MISSION, from one point to another.

    `shortest` is the path that plans are made of: the shortest at any angle. That there is no path is an answer, with
    the reason, and no error. Without a map the path is straight. With --together it finds paths of several robots in
    space and time, on which they do not touch. With --joint
    MISSION may be a MovingAI map (.map). With --lifelong it is an instance of the League of Robot Runners.
    """
    require_writable(output, (plot, trajectory), (*mission.files, scenario), ())
    require_drawable(plot)
    require_csv(trajectory, "--trajectory")
    require_turning_radius(turning_radius)
    of_joint = {
        "--scenario": scenario,
        "--agents": agents,
        "--time-limit": time_limit,
        "--expansions": expansions,
        "--output": output,
    }
    if lifelong:
        from muster.cli.verbs import path_lifelong

        of_joint_alone = {name: of_joint[name] for name in ("--scenario", "--agents", "--time-limit")}
        _require_none(of_joint_alone | {"--plot": plot, "--joint": joint or None}, "no --lifelong")
        settings = path_lifelong.Settings(steps, expansions, seed)
        return path_lifelong.run(File(mission.name), settings, form, output, quiet=quiet)
    _require_none({"--steps": steps}, "--lifelong")
    if joint:
        from muster.cli.verbs import path_joint

        if mission.name.endswith(".map"):
            instance = path_joint.of_map(File(mission.name), scenario, agents)
        else:
            instance = path_joint.of_mission(mission, together, agents, verbose=verbose)
        return path_joint.run(instance, path_joint.Limits(time_limit, expansions, seed), form, output, plot)
    _require_none(of_joint, "--joint")
    loaded = mission.load(verbose=verbose)
    if together:
        from muster.cli.verbs.path_together import run

        return run(loaded, together, cell, window, seed, form)
    ends = _point(loaded, "--from", start), _point(loaded, "--to", goal)
    body = _body(loaded, robot, radius, kind)
    world = _world(loaded)
    driven: dict[str, Any] = {}
    if unknown:
        found, driven = _by_laser(world, body, ends, turning_radius, seed)
    else:
        found = _found(world, body, planner, ends, seed, _parameters(planner, turning_radius, smooth=smooth))
    curve = None
    mover = None if robot is None else _robot(loaded, robot)
    if smooth and isinstance(found, Path):
        rounded = smooth_path(world, body, found, mover, turning_radius)
        found, driven, curve = rounded.path, rounded.answer(), rounded.curve
    if trajectory is not None and isinstance(found, Path):
        write_trajectory(trajectory, curve, found, mover)
    if lookahead is not None and follow is None:
        raise ParameterError(f"--lookahead: {lookahead:g}; expected --follow beside it")
    if follow is not None and isinstance(found, Path):
        found, driven = _followed(loaded, robot, body, found, follow, 0.5 if lookahead is None else lookahead)
    if plot is not None:
        _draw(loaded, world, body, found, ends, planner, plot)
    if form == "json":
        click.echo(json_text(_answer(found) | driven), nl=False)
    else:
        _print(found, loaded, body, planner, driven)
    return DONE


def _require_none(options: dict[str, Any], beside: str) -> None:
    for option, value in options.items():
        if value is not None:
            raise ParameterError(f"{option}: {value}; expected {beside} beside it")


def _world(mission: Mission) -> World | None:
    from muster.motion.map_world import World

    return None if mission.map is None else World.of(mission)


def _parameters(planner: str, turning_radius: float | None, *, smooth: bool) -> Any:
    """Parameters of the planner; None for its own."""
    if turning_radius is None or (smooth and planner != "dubins"):
        return None
    if planner != "dubins":
        raise ParameterError(
            f"--turning-radius: {turning_radius:g}; expected --smooth, --unknown or --planner dubins beside it"
        )
    from muster.motion.paths.dubins import Parameters

    return Parameters(turning_radius_m=turning_radius)


def _found(
    world: World | None, body: Body, planner: str, ends: tuple[list[float], list[float]], seed: int, params: Any
) -> Path | NoPath:
    import numpy as np

    from muster.motion.paths import planner_named
    from muster.motion.paths.robot_paths import RobotPaths, with_heights

    start, goal = ends
    if world is None:
        return Path(np.array(ends))
    if planner == "shortest":
        return RobotPaths(world).path(body, start, goal)
    found = planner_named(planner).find(
        world.free_space(body.radius_m, body.kind), start, goal, seed=seed, params=params
    )
    return found if isinstance(found, NoPath) else with_heights(found, start, goal)


def _by_laser(
    world: World | None,
    body: Body,
    ends: tuple[list[float], list[float]],
    turning_radius: float | None,
    seed: int,
) -> tuple[Path | NoPath, dict[str, Any]]:
    """What a robot drives that has no map, and builds one with its laser; it begins towards the goal."""
    from muster.motion.free_space import PrismSpace
    from muster.motion.paths.planner import blocked, point_of
    from muster.simulation.unknown_obstacles import Parameters, drive

    if world is None:
        raise ParameterError("--unknown: the mission has no map; expected one, which the robot does not know")
    space = world.free_space(body.radius_m, body.kind)
    if isinstance(space, PrismSpace):
        raise ParameterError("--unknown: a robot in the air of a mission in space; expected one in the plane")
    start, goal = (point_of(space, end, "point") for end in ends)
    reason = blocked(space, start, goal)
    if reason is not None:
        return reason, {}
    heading = math.atan2(goal[1] - start[1], goal[0] - start[0])
    pose, place = (float(start[0]), float(start[1]), heading), (float(goal[0]), float(goal[1]))
    found = drive(world, body, pose, place, Parameters(turning_radius_m=turning_radius), seed=seed)
    if isinstance(found, NoPath):
        return found, {}
    return found.path, {"scans": found.scans, "ways": found.ways}


def _followed(
    mission: Mission, robot: str | None, body: Body, path: Path, law: str, lookahead: float
) -> tuple[Path, dict[str, Any]]:
    """The path as a robot drives it: the one that was named, else a differential drive, or a quadcopter in the air."""
    import numpy as np

    from muster.motion.guidance import follow
    from muster.motion.kinematics.registry import kinematics_named, limits_of

    usual = "quadcopter" if body.kind == "air" else "differential-drive"
    own = Robot(id="robot", position=(0.0, 0.0), kinematics=usual) if robot is None else _robot(mission, robot)
    tracked = follow(path, law, kinematics_named(own.kinematics), limits_of(own), lookahead_m=lookahead)
    figures = {
        "law": law,
        "kinematics": own.kinematics,
        "arrived": tracked.arrived,
        "duration_s": tracked.duration_s,
        "max_cross_track_m": float(tracked.cross_track_m.max()),
        "rms_cross_track_m": float(np.sqrt((tracked.cross_track_m**2).mean())),
    }
    return Path(tracked.path.points[:, : path.points.shape[1]]), figures


def _point(mission: Mission, option: str, text: str | None) -> list[float]:
    expected = "x,y,z" if mission.dimensions == 3 else "x,y"
    if text is None:
        raise ParameterError(f"{option}: missing; expected {expected}, metres in the map frame, or --together")
    try:
        point = [float(part) for part in text.split(",")]
    except ValueError:
        point = []
    if len(point) != mission.dimensions or not all(map(math.isfinite, point)):
        raise ParameterError(f"{option}: {text!r}; expected {expected}, metres in the map frame")
    return point


def _body(mission: Mission, robot: str | None, radius: float | None, kind: str | None) -> Body:
    from muster.motion.map_world import Body

    if radius is not None and not (math.isfinite(radius) and radius >= 0):
        raise ParameterError(f"--radius: {radius:g}; expected a finite number of at least 0")
    own = None if robot is None else _robot(mission, robot)
    radius_m = radius if radius is not None else 0.0 if own is None else own.radius_m
    return Body(radius_m, kind or ("ground" if own is None else own.kind))


def _robot(mission: Mission, name: str) -> Robot:
    for robot in mission.robots:
        if robot.id == name:
            return robot
    hint = did_you_mean(name, [robot.id for robot in mission.robots])
    raise ParameterError(f"--robot: {name!r}; expected a robot of the mission{hint}")


def _answer(found: Path | NoPath) -> dict[str, Any]:
    if isinstance(found, NoPath):
        return {"no_path": _reason(found)}
    return {"length_m": found.length_m, "points": found.points.tolist()}


def _reason(found: NoPath) -> str:
    return f"{found.reason}: {found.detail}" if found.detail else found.reason


def _print(found: Path | NoPath, mission: Mission, body: Body, planner: str, driven: dict[str, Any]) -> None:
    import numpy as np

    from muster.cli.tables.table import print_table
    from muster.mission.texts.counting import counted

    if isinstance(found, NoPath):
        click.echo(f"no path: {_reason(found)}")
        return
    if driven:
        click.echo(f"{mission.name}: {found.length_m:.3f} m, {_driving(driven)}; {_facts(body, planner)}")
        if driven.get("corners"):
            click.echo(corners_of(driven))
        return
    turns = found.turns
    legs = np.linalg.norm(np.diff(turns, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(legs)])
    columns = (*(f"{axis} [m]" for axis in "xyz"[: turns.shape[1]]), "so far [m]")
    rows = [tuple(f"{value:.3f}" for value in (*point, far)) for point, far in zip(turns, along, strict=True)]
    print_table(columns, rows, right=columns)
    pieces = counted(len(legs), "straight piece")
    click.echo(f"{mission.name}: {found.length_m:.3f} m in {pieces}; {_facts(body, planner)}")


def _driving(driven: dict[str, Any]) -> str:
    from muster.mission.texts.counting import counted

    if "scans" in driven:
        return f"{driven['scans']} scans, {counted(driven['ways'], 'way')} planned; by laser"
    if "law" not in driven:
        return bends_of(driven)
    end = "" if driven["arrived"] else ", not arrived"
    off = f"off the path {driven['max_cross_track_m']:.3f} m at most, {driven['rms_cross_track_m']:.3f} m rms"
    return f"{driven['duration_s']:.2f} s{end}, {off}; {driven['law']}, {driven['kinematics']}"


def _facts(body: Body, planner: str) -> str:
    return f"{planner}, {body.kind}, radius {body.radius_m:g} m"


def _draw(
    mission: Mission,
    world: World | None,
    body: Body,
    found: Path | NoPath,
    ends: tuple[list[float], list[float]],
    planner: str,
    file: File,
) -> None:
    from muster.report.figures.files import save_figure
    from muster.report.maps.path_picture import plot_way

    start, goal = (tuple(end) for end in ends)
    image = None if world is None else world.image
    save_figure(plot_way(mission, found, start, goal, facts=_facts(body, planner), image=image), file)
