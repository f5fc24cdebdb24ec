"""Carries a plan out, in a simulated world or with real robots. Heavy parts are imported where they are used."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from muster.mission.errors import ParameterError
from muster.mission.keywords import require_known
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.value_types import shown
from muster.planning.request import require_mission
from muster.running.simulation_options import SimulationOptions

if TYPE_CHECKING:
    import threading

    from muster.bridges.fleet import Fleet
    from muster.execution import ExecutionEvent, Recorder, Report
    from muster.report.film import Footage
    from muster.running.negotiated.simulation import Negotiation


def simulate(
    mission: Mission,
    plan: Plan | Negotiation,
    *,
    seed: int = 0,
    record: str | Path | None = None,
    film: str | Path | Footage | None = None,
    observers: Sequence[Recorder] = (),
    **how: Unpack[SimulationOptions],
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
        as `Simulation` takes it: `world`, `dt_s`, `avoidance`, `noise`, `on_look`, `on_world`; `ignore`, rules that do
        not hold, whatever the plan says of itself; and `speed`, times real time, `on_event`, which is called with each
        event, and `halt`, which ends it when it is set.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have; if a film is wanted of another world.
    InputError, RenderingError
        if a film cannot have that ending, or nothing draws here: before the mission is carried out.
    MissingExtraError
        where an extra is not installed that is needed; a negotiation needs `net`, the physics world `physics`.
    """
    require_known(how, (*SimulationOptions.__annotations__, "seed", "record", "film", "observers"))
    require_mission(mission)
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
    ignore: str | Collection[str] = (),
    record: str | Path | None = None,
    observers: Sequence[Recorder] = (),
    on_event: Callable[[ExecutionEvent], None] | None = None,
    halt: threading.Event | None = None,
) -> Report:
    """Carry a plan out with real robots, in real time, to its end; what is left is planned again when robots fail.

    Parameters
    ----------
    fleet
        the robots, behind a bridge of `muster.bridges`; stays open.
    seed
        of planning anew.
    ignore
        rules that do not hold, whatever the plan says of itself.
    record
        a file (.mcap) that is to hold what happened; needs the extra `record`.
    observers
        who else is told, such as `muster.report.live.FoxgloveServer`.
    on_event
        is told what happens, as it happens.
    halt
        where it is set, by another thread or by `on_event`, robots stop where they are, and it ends.

    Returns
    -------
    its remarks say so if a record broke off, as on a full disk: robots are not left alone for that.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a robot has no port.
    """
    from muster.running.live import carry_out_live

    require_mission(mission)
    remarks: list[str] = []
    with _recorded(mission, record, observers, lambda error: remarks.append(f"no more is kept: {error}")) as recorder:
        report = carry_out_live(
            mission, plan, fleet, seed=seed, ignore=ignore, recorder=recorder, on_event=on_event, halt=halt
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
            told.attempt(file.close)


def _footage(mission: Mission, film: str | Path | Footage) -> Footage:
    from muster.report.film import Footage, check_film

    if isinstance(film, Footage):
        return film
    check_film(film)
    return Footage(mission)


def _carrying_out(mission: Mission, plan: Plan | Negotiation) -> Callable[..., Report]:
    if isinstance(plan, Plan):
        from muster.running.simulation import carry_out

        return partial(carry_out, mission, plan)
    from muster.allocation.problem import Problem
    from muster.running.negotiated.simulation import Negotiation, negotiate_and_carry_out

    if not isinstance(plan, Negotiation):
        raise ParameterError(f"plan: {shown(plan)}; expected a Plan or a Negotiation")
    return partial(negotiate_and_carry_out, Problem.compile(mission).ready(), plan)
