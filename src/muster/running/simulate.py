"""The function `simulate` of the package: a plan carried out in a simulated world."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from muster.mission.errors import ParameterError
from muster.mission.keywords import require_known
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.value_types import shown
from muster.planning.request import require_mission
from muster.running.recorded import recorded
from muster.running.simulation_options import SimulationOptions

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.report.film import Footage
    from muster.running.negotiated.simulation import Negotiation


def simulate(
    mission: Mission,
    plan: Plan | Negotiation,
    *,
    seed: int = 0,
    accept_partial: bool = False,
    record: str | Path | None = None,
    film: str | Path | Footage | None = None,
    observers: Sequence[Recorder] = (),
    **how: Unpack[SimulationOptions],
) -> Report:
    """Carry a plan out in a simulated world, in virtual time; the mission's events happen.

    Parameters
    ----------
    plan
        what is carried out; or a `Negotiation`: then each robot is a process that decides for itself, without a
        centre, and time passes as in reality.
    seed
        of the world and of planning again.
    accept_partial
        whether a plan is carried out that was cut short.
    record
        a file (.mcap) for the record of the run; needs the extra `record`.
    film
        a file (.mp4, .gif) for a film of it, in the physics world; or a `Footage` of the mission, of which films and
        stills can be made afterwards.
    observers
        receive every event and state, such as `muster.report.live.FoxgloveServer`.
    how
        as `Simulation` takes it: `world`, `dt_s`, `avoidance`, `traffic`, `law`, `noise`, `pose`, `localise`, `wind`,
        `batteries`, `drain`, `rotor_level`, `on_look`, `on_world`; `ignore`, rules that do not hold, whatever the plan
        says of itself; `planning`, the options with which the rest is planned again; `standing`, for a fleet that
        stays on duty (a `muster.execution.Standing`); and `speed`, times real time, `on_event`, which is called with
        each event, and `halt`, which ends it when it is set.

    Raises
    ------
    CutShortError
        if the plan was cut short, and that is not accepted.
    PlanError
        if a route enters an area that is closed to its robot.
    ParameterError
        if the plan names robots or tasks that the mission does not have; if a film of another world is asked for; if a
        negotiation is to keep time windows, deadlines, shifts, lags, teams, relations or lateness.
    InputError, RenderingError
        before the run, if a film cannot have that suffix, or nothing can draw it on this machine.
    MissingExtraError
        if an extra is missing: a negotiation needs `net`, the physics world `physics`.
    """
    require_known(how, (*SimulationOptions.__annotations__, "seed", "accept_partial", "record", "film", "observers"))
    require_mission(mission)
    if isinstance(plan, Plan):
        plan.require_whole(accept_partial=accept_partial)
    carry_out = _runner(mission, plan)
    if film is not None:
        footage = _footage(mission, film)
        observers = (*observers, footage)
        how["on_world"] = footage.on_world
    with recorded(mission, record, observers) as recorder:
        report = carry_out(seed=seed, recorder=recorder, **how)
    if isinstance(film, str | Path):
        from muster.report.film import write_film

        write_film(film, footage)
    return report


def _footage(mission: Mission, film: str | Path | Footage) -> Footage:
    from muster.report.film import Footage, check_film

    if isinstance(film, Footage):
        return film
    check_film(film)
    return Footage(mission)


def _runner(mission: Mission, plan: Plan | Negotiation) -> Callable[..., Report]:
    if isinstance(plan, Plan):
        from muster.running.simulation import carry_out

        return partial(carry_out, mission, plan)
    from muster.allocation.problem import Problem
    from muster.negotiation.capabilities import refuse_mission
    from muster.negotiation.methods import method_named
    from muster.running.negotiated.simulation import Negotiation, negotiate_and_carry_out

    if not isinstance(plan, Negotiation):
        raise ParameterError(f"plan: {shown(plan)}; expected a Plan or a Negotiation")
    refuse_mission(mission, method_named(plan.method).can)
    return partial(negotiate_and_carry_out, Problem.compile(mission).ready(), plan)
