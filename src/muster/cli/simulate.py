"""`muster simulate`: carry a plan out in a simulated world; the report compares it with the plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from muster.cli.auction_options import method_options
from muster.cli.backend import Backend, server_option
from muster.cli.drone_options import IN_THIS_PROCESS, conditions_of, drone_options
from muster.cli.duty_options import duty_options, standing_of
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.film_options import draw_footage, footage_of, require_filmable
from muster.cli.live_output import foxglove_option, print_event_line, shown_live
from muster.cli.localisation_options import localise_of, pose_options
from muster.cli.options import (
    Finite,
    MissionFile,
    accept_partial_option,
    avoidance_option,
    format_option,
    mission_argument,
    quiet_option,
    require_complete_option,
    say_of_plan,
    traffic_option,
)
from muster.cli.outputs import require_drawable, require_folder, require_writable
from muster.cli.planning_options import ctrl_c_interrupts, planning_options, request_of
from muster.cli.record_output import drawing_options, kept_record, record_option
from muster.cli.report_tables import print_report
from muster.cli.whole_work import whole_work
from muster.client.server_plan import ServerPlan
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean
from muster.mission.plan import Plan, json_text
from muster.mission.plan_reader import read_plan
from muster.motion.laws import LAWS
from muster.planning.options import PlanningOptions
from muster.planning.request import Request

if TYPE_CHECKING:
    from muster import Negotiation
    from muster.exchange.mission_control import World
    from muster.report.camera_pictures import CameraPictures
    from muster.simulation import Noise

_FILE = click.Path(path_type=Path)
_OF_A_PLAN = (
    *("plan", "ignore", "time_limit", "iterations", "allocator", "objective", "threads", "ray"),
    *("bound", "start", "fixed", "rewire", "stay", "until", "orders"),
)
_OF_A_NEGOTIATION = ("method", "transport")
_IN_THIS_PROCESS = (
    *_OF_A_NEGOTIATION,
    "ray",
    "negotiate",
    "found",
    "cameras",
    "film",
    "film_speed",
    "still",
    "foxglove",
    "orders",
    *IN_THIS_PROCESS,
)


def _world(_: click.Context, __: click.Parameter, value: str) -> str:
    from muster.running.worlds import WORLDS

    if value not in WORLDS:
        hint = did_you_mean(value, WORLDS)
        raise click.BadParameter(f"{value!r} is not one of {', '.join(WORLDS)}{hint}", param_hint="'--world'")
    return value


@click.command()
@mission_argument
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that the allocator makes]")
@planning_options(time_limit_s=2.0, carries_out=True)
@click.option("--negotiate", is_flag=True, help="No plan: each robot is a process, and they agree among themselves.")
@click.option(
    "--world",
    callback=_world,
    default="kinematic",
    show_default=True,
    metavar="WORLD",
    help="kinematic, physics, or a world of an installed package.",
)
@avoidance_option
@traffic_option
@click.option("--law", type=click.Choice(LAWS), default="profile", show_default=True, help="How robots move.")
@click.option("--dt", type=Finite(0.001, 1.0), default=0.1, show_default=True, metavar="S", help="Step, 0.001 to 1.")
@click.option(
    "--speed",
    type=Finite(0.001, 1e6),
    metavar="X",
    help="X times real time, printing events.  [default: at once; 1 with --foxglove; with --negotiate 1, at most 10]",
)
@click.option(
    "--noise",
    "noises",
    multiple=True,
    metavar="KIND=AMOUNT",
    help="Noise of motion and telemetry; see docs/simulation.md.",
)
@duty_options
@drone_options
@pose_options
@record_option
@drawing_options
@click.option("--found", type=_FILE, metavar="FILE", help="Draw what cameras found (.png, .svg, .pdf).")
@click.option(
    "--cameras", type=_FILE, metavar="DIR", help="Write what cameras saw of each tag, largest; with --world physics."
)
@click.option("--film", type=_FILE, metavar="FILE", help="Film it, in the physics world (.mp4, .gif).")
@click.option(
    "--film-speed", type=Finite(0.01, 1e6), metavar="X", help="X times real time.  [default: a film of at most 24 s]"
)
@click.option("--still", type=_FILE, metavar="FILE", help="Draw how it ended from above, in the physics world (.png).")
@foxglove_option
@method_options
@require_complete_option
@accept_partial_option
@format_option
@quiet_option
@server_option(*_IN_THIS_PROCESS)
def command(
    backend: Backend,
    mission: MissionFile,
    plan: Path | None,
    options: PlanningOptions,
    start: Path | None,
    fixed: Path | None,
    negotiate: bool,
    world: World,
    avoidance: str,
    traffic: str,
    law: str,
    dt: float,
    speed: float | None,
    noises: tuple[str, ...],
    stay: bool,
    until: float | None,
    orders: Path | None,
    wind: str | None,
    gusts: float | None,
    rotors: bool,
    batteries: tuple[str, ...],
    drain: tuple[str, ...],
    pose: str | None,
    sensors: tuple[str, ...],
    record: Path | None,
    html: Path | None,
    plot: Path | None,
    gantt: Path | None,
    found: Path | None,
    cameras: Path | None,
    film: Path | None,
    film_speed: float | None,
    still: Path | None,
    method: str,
    transport: str,
    foxglove: int | None,
    require_complete: bool,
    accept_partial: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Carry out a plan of a MISSION in a simulated world, in virtual time, and report its cost.

    Robots keep their speeds and avoid each other. The mission's events happen, and the tasks left are planned again.

    With --stay a fleet stays on duty when its tasks are done, for orders that come: see docs/standing-fleets.md.

    With --negotiate there is no plan and no centre: robots agree as in `muster auction`, over the same network, and
    each decides for itself what to do next. They exchange messages in real time.
    """
    _check_together(negotiate)
    require_writable(None, (record, html, plot, gantt, film, still, found), mission.files, (plan, start, fixed))
    require_drawable(plot, gantt, found)
    require_filmable(world, film, film_speed, still)
    noise, localise = noise_of(noises), localise_of(sensors)
    conditions = conditions_of(wind, gusts, batteries, drain, rotors=rotors)
    standing = standing_of(orders, until, stay=stay)
    speed = 1.0 if foxglove is not None and speed is None else speed
    loaded = mission.load(verbose=verbose)
    if localise is not None:
        _require_possible(localise, loaded)
    looks = _looks(loaded, world, found, cameras)
    planned: Plan | Negotiation
    if negotiate:
        planned, speed = _negotiation(loaded, method, transport, options), speed or 1.0
    elif plan is not None:
        planned = read_plan(plan, loaded)
        say_of_plan(planned, plan, loaded, options.ignore, quiet=quiet, verbose=verbose)
        planned = _judged(loaded, planned, plan, options.ignore, quiet=quiet)
    else:
        planned = _plan(backend, request_of(options, loaded, start, fixed), quiet=quiet)
    if isinstance(planned, Plan):
        planned.require_whole(accept_partial=accept_partial)
    footage = footage_of(loaded) if film is not None or still is not None else None
    rules = {} if negotiate else {"ignore": options.ignore, "planning": options, "standing": standing}
    with kept_record(record, html, plot, gantt) as file, shown_live(loaded, foxglove, quiet=quiet) as observers:
        report, interrupted_s = backend.simulate(
            loaded,
            planned,
            world=world,
            seed=options.seed,
            dt_s=dt,
            avoidance=avoidance,
            traffic=traffic,
            law=law,
            noise=noise,
            pose=pose,
            localise=localise,
            speed=speed,
            record=file,
            on_line=print_event_line if speed is not None and not quiet else None,
            observers=observers,
            film=footage,
            on_look=looks,
            **conditions,
            **rules,
        )
    if found is not None and looks is not None:
        looks.plot(loaded, found)
    if form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    else:
        print_report(report.as_dict(), loaded, with_tasks=verbose)
    if footage is not None:
        draw_footage(footage, film, film_speed, still, quiet=quiet)
    if interrupted_s is not None:
        click.echo(f"interrupted at {interrupted_s:.1f} s of the mission", err=True)
    return exit_code_if(
        (Ending.INTERRUPTED, interrupted_s is not None), (Ending.LEFT_OUT, require_complete and report.tasks_lost)
    )


def _check_together(negotiate: bool) -> None:
    """Refuse options that go only with --negotiate, or only without it."""
    context = click.get_current_context()
    given = {name for name in context.params if context.get_parameter_source(name) is ParameterSource.COMMANDLINE}
    wrong = given.intersection(_OF_A_PLAN if negotiate else _OF_A_NEGOTIATION)
    for name in sorted(wrong):
        option = "--set" if name == "settings" else f"--{name.replace('_', '-')}"
        raise ParameterError(f"{option} given; expected it {'without' if negotiate else 'together with'} --negotiate")


def _require_possible(localise: Mapping[str, Mapping[str, str]], mission: Mission) -> None:
    """Refuse sensors before anything is planned."""
    from muster.running.localisation import require_possible, sensors_of

    require_possible(sensors_of(localise), mission)


def _looks(mission: Mission, world: str, found: Path | None, cameras: Path | None) -> CameraPictures | None:
    """What collects the pictures of cameras; None where no option asks for them."""
    if found is None and cameras is None:
        return None
    from muster.report.camera_pictures import CameraPictures

    option = "--found" if cameras is None else "--cameras"
    if not mission.tags:
        raise ParameterError(
            f"{option}: {mission.name} has no tags; expected a mission in which there is something to find"
        )
    if cameras is not None and world != "physics":
        raise ParameterError(f"--cameras: no pictures in the {world} world; expected --world physics")
    require_folder(cameras, "--cameras")
    return CameraPictures(cameras)


def _negotiation(mission: Mission, method: str, transport: str, options: PlanningOptions) -> Negotiation:
    """How robots agree; a mission on which they cannot is refused before any file is opened."""
    from muster import Negotiation
    from muster.allocation.allocator import make_parameters
    from muster.negotiation.capabilities import refuse_mission
    from muster.negotiation.methods import method_named

    chosen = method_named(method)
    refuse_mission(mission, chosen.can)
    terms = make_parameters(chosen.allocator, dict(options.parameters))
    return Negotiation(method=method, transport=transport, params=terms)


def _judged(mission: Mission, plan: Plan, file: Path, ignore: tuple[str, ...], *, quiet: bool) -> Plan:
    """The plan with the judge's objective. A plan that breaks rules is simulated after a warning that names them."""
    from muster.verification import verify

    verdict = verify(mission, plan, ignore, plan.objective)
    if not verdict.valid and not quiet:
        click.echo(f"warning: {file}: the judge rejects this plan: {verdict.first_violations}", err=True)
    return replace(plan, objective=verdict.objective_name, objective_value=verdict.value())


def _plan(backend: Backend, request: Request, *, quiet: bool) -> Plan:
    """A plan as requested.

    Raises
    ------
    KeyboardInterrupt
        if Ctrl-C ended planning: nothing is carried out then.
    """
    from muster.cli.progress import progress_bar

    interrupt = whole_work()
    with ctrl_c_interrupts(interrupt), progress_bar(not quiet, request.mission) as on_progress:
        plan = backend.plan(request, on_progress, interrupt).plan
    if interrupt.interrupted:
        kept = f"plan {plan.id} is kept at the server; " if isinstance(plan, ServerPlan) else ""
        click.echo(f"interrupted: {kept}nothing was started", err=True)
        raise KeyboardInterrupt
    return plan


def noise_of(noises: tuple[str, ...]) -> Noise:
    """The noise of `--noise KIND=AMOUNT`."""
    from muster.simulation import Noise

    kinds = [field.name for field in fields(Noise)]
    amounts: dict[str, float] = {}
    for text in noises:
        kind, _, amount = text.partition("=")
        if kind not in kinds or kind in amounts:
            raise ParameterError(f"--noise: {text}; expected each of {', '.join(kinds)} at most once, =AMOUNT")
        try:
            amounts[kind] = float(amount)
        except ValueError:
            raise ParameterError(f"--noise: {text}; expected a number after {kind}=") from None
    return Noise(**amounts)
