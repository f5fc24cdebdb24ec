"""Muster from Python: load, solve, verify, simulate, carry out, plot. Heavy parts are imported where they are used."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.library import mission_names, mission_path
from muster.mission.errors import Finding, MissionError, ParameterError
from muster.mission.hints import did_you_mean
from muster.mission.kinds import shown
from muster.mission.model import Mission
from muster.mission.plan import Plan

if TYPE_CHECKING:
    import threading

    from muster._negotiated.simulation import Negotiation
    from muster.allocation.stop import Progress
    from muster.bridges.fleet import Fleet
    from muster.execution import Happening, Recorder, Report
    from muster.report.film import Footage
    from muster.verification import Verdict


DEFAULT_ALLOCATOR = "search"


def load(
    path_or_name: str | Path,
    *,
    robots: str | Path | None = None,
    suitability: str | Path | None = None,
    salesmen: int | None = None,
    depot: str = "1",
) -> Mission:
    """Read a mission: a YAML file, a task-list CSV, a TSPLIB file, QGroundControl plans, or a shipped name.

    Parameters
    ----------
    path_or_name
        a file, a folder of QGroundControl `.plan` files, or one of `muster missions`; a file of that name comes first.
    robots, suitability
        the CSV files that go with a task-list CSV.
    salesmen, depot
        how many robots, and the number of the node where they start and end, for TSPLIB.

    Raises
    ------
    MissionError
        with everything that is wrong: file, line, field, value, what was expected.
    ParameterError
        if a parameter is missing, or does not go with this kind of file.
    """
    path = _found(path_or_name)
    suffix = path.suffix.lower()
    _check_flags(path_or_name, suffix, robots=robots, suitability=suitability, salesmen=salesmen)
    if suffix == ".csv":
        from muster.mission.thesis_csv import read_csv

        return read_csv(path, Path(str(robots)), None if suitability is None else Path(suitability))
    if suffix == ".tsp":
        from muster.mission.tsplib import read_tsplib

        return read_tsplib(path, salesmen or 0, depot)
    if suffix == ".plan" or path.is_dir():
        from muster.exchange.qgc_reader import read_plan_files

        return read_plan_files(path)
    from muster.mission.yaml_reader import read_yaml

    return read_yaml(path)


def _found(path_or_name: str | Path) -> Path:
    path = Path(path_or_name)
    shipped = mission_path(str(path_or_name))
    named_as_file = path.suffix.lower() in (".yaml", ".yml", ".csv", ".tsp", ".plan")
    if path.is_file() or (shipped is None and (path.exists() or named_as_file)):
        return path
    if shipped is None:
        expected = f"a file, or the name of a shipped mission{did_you_mean(str(path_or_name), mission_names())}"
        raise MissionError([Finding(str(path_or_name), None, "", "no such file or mission", expected)])
    return shipped


_FLAGS = {".csv": ("robots", "suitability"), ".tsp": ("salesmen",)}
_NEEDED_FLAGS = {".csv": "robots", ".tsp": "salesmen"}


def _check_flags(named: str | Path, suffix: str, **given: object) -> None:
    needed = _NEEDED_FLAGS.get(suffix)
    if needed is not None and given[needed] is None:
        raise ParameterError(f"{named}: --{needed} missing; expected with a {suffix} file")
    for name, value in given.items():
        if value is not None and name not in _FLAGS.get(suffix, ()):
            raise ParameterError(f"{named}: --{name} given; expected no --{name} with this kind of mission")


def solve(
    mission: Mission,
    allocator: str = DEFAULT_ALLOCATOR,
    time_limit: float | None = None,
    seed: int = 0,
    on_progress: Callable[[Progress], None] | None = None,
    *,
    iterations: int | None = None,
    objective: str | None = None,
    ignore: Collection[str] = (),
    start: Plan | None = None,
    fixed: Plan | None = None,
    bound: str | None = None,
    **parameters: Any,
) -> Plan:
    """Plan a mission.

    Parameters
    ----------
    allocator
        one of `muster solve --list-allocators`.
    time_limit, iterations
        when an anytime allocator stops; 5 s if neither is given. With `iterations` alone the same seed gives the same
        plan.
    objective
        instead of the mission's own.
    ignore
        rules that do not hold: prerequisites, suitability, skills, capacity.
    start
        a plan to go on from.
    fixed
        a plan whose routes the routes begin with, for planning anew under way; `search` and `greedy` alone.
    bound
        `quick` or `exact`: prove how good the plan is, as its `lower_bound`.
    parameters
        of the allocator, such as `population_size`.

    Raises
    ------
    ParameterError, NotSupportedError
    """
    from muster.allocation.allocator import make_parameters
    from muster.allocation.fixed import keeping
    from muster.allocation.problem import Problem
    from muster.allocation.proofs import prove, require_provable
    from muster.allocation.registry import allocator_named
    from muster.allocation.stop import Stop, usual_time_limit

    _require_mission(mission)
    ignore = (ignore,) if isinstance(ignore, str) else ignore
    chosen = allocator_named(allocator)
    params = make_parameters(chosen, parameters)
    problem = Problem.compile(mission, objective, ignore)
    problem = (problem if fixed is None else keeping(problem, fixed)).ready()
    if bound is not None:
        require_provable(problem, bound)
    limit = usual_time_limit(chosen.anytime, time_limit, iterations)
    stop = Stop(iterations=iterations, time_limit=limit, on_progress=on_progress)
    plan = chosen.solve(problem, stop, seed=seed, params=params, start=start)
    return plan if bound is None else prove(problem, plan, bound, stop, time_limit).plan


def verify(mission: Mission, plan: Plan) -> Verdict:
    """Judge a plan from scratch, by code that no allocator uses."""
    from muster.verification import verify as judge

    _require_mission(mission)
    return judge(mission, plan)


def _require_mission(mission: object) -> None:
    if not isinstance(mission, Mission):
        raise ParameterError(
            f"mission: {shown(mission)}; expected a Mission: muster.load makes one from a file or name"
        )


def simulate(
    mission: Mission,
    plan: Plan | Negotiation,
    *,
    seed: int = 0,
    record: str | Path | None = None,
    film: str | Path | Footage | None = None,
    observers: Sequence[Recorder] = (),
    **how: Any,
) -> Report:
    """Carry a plan out with moving robots, in virtual time; the mission's events happen.

    Parameters
    ----------
    plan
        what is carried out; or how robots agree without a centre: then each robot is a process which decides for
        itself, and time goes on at the pace of real time.
    seed
        of the world and of planning anew.
    record
        a file (.mcap) that is to hold what happened; needs the extra `record`.
    film
        a file (.mp4, .gif) for a film of it, in the physics world; or a `Footage` of the mission, of which films and
        stills can be made afterwards.
    observers
        who else is told, such as `muster.report.live.FoxgloveServer`.
    how
        as `Simulation` takes it: `world`, `dt_s`, `avoidance`, `noise`; and `speed`, times real time.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have; if a film is wanted of another world.
    InputError, RenderingError
        if a film cannot have that ending, or nothing draws here: before the mission is carried out.
    MissingExtraError
        where an extra is not installed that is needed; a negotiation needs `net`, the physics world `physics`.
    """
    _require_mission(mission)
    carry_out = _carrying_out(mission, plan)
    if film is not None:
        footage = _footage(mission, film)
        observers = (*observers, footage)
        how["on_world"] = footage.on_world
    with _recorded(mission, record, observers) as recorder:
        report = carry_out(seed=seed, recorder=recorder, **how)
    if isinstance(film, str | Path):
        from muster.report.film import write_film

        write_film(film, footage)
    return report


def carry_out(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    *,
    seed: int = 0,
    record: str | Path | None = None,
    observers: Sequence[Recorder] = (),
    on_happening: Callable[[Happening], None] | None = None,
    halt: threading.Event | None = None,
) -> Report:
    """Carry a plan out with real robots, in real time, to its end; what is left is planned again when robots fail.

    Parameters
    ----------
    fleet
        the robots, behind a bridge of `muster.bridges`; stays open.
    seed
        of planning anew.
    record
        a file (.mcap) that is to hold what happened; needs the extra `record`.
    observers
        who else is told, such as `muster.report.live.FoxgloveServer`.
    on_happening
        is told what happens, as it happens.
    halt
        where it is set, by another thread or by `on_happening`, robots stop where they are, and it ends.

    Returns
    -------
    its remarks say so if a record broke off, as on a full disk: robots are not left alone for that.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a robot has no port.
    """
    from muster._live import carry_out_live

    _require_mission(mission)
    remarks: list[str] = []
    with _recorded(mission, record, observers, lambda error: remarks.append(f"no more is kept: {error}")) as recorder:
        report = carry_out_live(
            mission, plan, fleet, seed=seed, recorder=recorder, on_happening=on_happening, halt=halt
        )
    return replace(report, remarks=(*report.remarks, *remarks))


@contextmanager
def _recorded(
    mission: Mission,
    record: str | Path | None,
    observers: Sequence[Recorder],
    on_failure: Callable[[Exception], None] | None = None,
) -> Iterator[Recorder | None]:
    """Who is told of a mission while it is carried out, a file among them if one is wanted; None: nobody."""
    recorders = list(observers)
    if record is not None:
        from muster.report.record import RecordWriter

        recorders.append(file := RecordWriter(record, mission))
    if not recorders:
        yield None
        return
    from muster.report.recorders import Recorders

    told = Recorders(*recorders, on_failure=on_failure)
    try:
        yield told
    finally:
        if record is not None:
            told.forgiving(file.close)


def _footage(mission: Mission, film: str | Path | Footage) -> Footage:
    from muster.report.film import Footage, check_film

    if isinstance(film, Footage):
        return film
    check_film(film)
    return Footage(mission)


def _carrying_out(mission: Mission, plan: Plan | Negotiation) -> Callable[..., Report]:
    if isinstance(plan, Plan):
        from muster._carrying_out import carry_out

        return partial(carry_out, mission, plan)
    from muster._negotiated.simulation import Negotiation, negotiate_and_carry_out
    from muster.allocation.problem import Problem

    if not isinstance(plan, Negotiation):
        raise ParameterError(f"plan: {shown(plan)}; expected a Plan or a Negotiation")
    return partial(negotiate_and_carry_out, Problem.compile(mission).ready(), plan)


def plot(mission: Mission, plan: Plan, *, ax: Any = None) -> Any:
    """Draw a plan's routes; returns the matplotlib Axes (`ax`, if given). Needs the extra `plot`."""
    from muster.report import plot_routes

    return plot_routes(mission, plan, verify(mission, plan), ax=ax)
