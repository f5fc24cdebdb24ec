"""The function `simulate` of the package: a plan carried out in a simulated world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.value_types import shown
from muster.planning.request import require_mission
from muster.running.coordination import Coordination
from muster.running.observed_run import ObservedRun, keywords_of_run
from muster.running.recorded import recorded
from muster.running.run_outputs import RUN_OUTPUTS

if TYPE_CHECKING:
    from muster.execution import Recorder, Report


def simulated(mission: Mission, plan: Plan | Coordination, request: ObservedRun) -> Report:
    """Carry a plan out in a simulated world, in virtual time; the mission's events happen.

    Parameters
    ----------
    plan
        what is carried out; or a coordination, such as a `Negotiation`, by which each robot is a process that decides
        for itself, without a centre: then time passes as in reality.
    request
        the world, and how the plan is carried out: the fields of `RunRequest` and `ObservedRun`, by name.

    Raises
    ------
    CutShortError
        if the plan was cut short, and that is not accepted.
    PlanError
        if a route enters an area that is closed to its robot.
    ParameterError
        if the plan names robots or tasks that the mission does not have; if a film of another world is asked for; if a
        negotiation is to keep rules of times, teams or relations that robots cannot agree on, or lateness.
    InputError, RenderingError
        before the run, if a film cannot have that suffix, or nothing can draw it on this machine.
    MissingExtraError
        if an extra is missing: a negotiation needs `net`, the physics world `physics`.
    """
    require_mission(mission)
    if request.is_real:
        raise ParameterError(f"world: {request.world}; expected a simulated one: muster.carry_out has real robots")
    _require_possible(mission, plan, request)
    asked = request.film is not None
    film = RUN_OUTPUTS.named("film").begin(mission, request.world, {"film": request.film}) if asked else None
    if film is not None:
        request = request.observed_by([film])
    with recorded(mission, request.record, request.observers) as recorder:
        report = _carry_out(mission, plan, request, recorder)
    if film is not None:
        film.write(lambda line: None)
    return report


simulate = keywords_of_run.in_world(simulated)


def _require_possible(mission: Mission, plan: Plan | Coordination, request: ObservedRun) -> None:
    """Refuse, before any file is opened, what is no plan and no coordination, and what neither can carry out."""
    request.require_place_of_map()
    if isinstance(plan, Plan):
        plan.require_whole(accept_partial=request.accept_partial)
    elif isinstance(plan, Coordination):
        if request.explore:
            raise ParameterError(
                "explore: true; expected a plan, or no explore: without a centre nobody makes frontiers"
            )
        plan.refuse_mission(mission)
    else:
        raise ParameterError(f"plan: {shown(plan)}; expected a Plan or a Negotiation")


def _carry_out(mission: Mission, plan: Plan | Coordination, request: ObservedRun, recorder: Recorder | None) -> Report:
    if isinstance(plan, Coordination):
        return plan.carry_out(mission, request, recorder)
    from muster.running.simulation import carry_out

    return carry_out(mission, plan, request, recorder=recorder)
