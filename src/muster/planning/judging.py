"""Judging of plans: those that are given, and each plan before it leaves planning."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.request import Request, require_mission

if TYPE_CHECKING:
    from muster.verification import Verdict

_MOST_SHOWN = 3


def verify(
    mission: Mission,
    plan: Plan,
    ignore: str | Collection[str] = (),
    objective: str | None = None,
    fixed: Plan | None = None,
) -> Verdict:
    """Judge a plan from scratch, by code that no allocator uses.

    Parameters
    ----------
    ignore
        rules that do not hold, as for `solve`. What the plan says of itself in `ignored` has no effect.
    objective
        the one that the plan was to minimise; the mission's by default.
    fixed
        a plan whose routes the routes were to begin with.

    Raises
    ------
    ParameterError, NotSupportedError
    """
    from muster.verification import verify as judge

    require_mission(mission)
    return judge(mission, plan, ignore, objective, fixed)


def judged(request: Request, plan: Plan) -> Verdict:
    """The verdict on the plan that an allocator has made for a request.

    Raises
    ------
    MusterError
        if the judge rejects it, which is an error of the allocator.
    """
    verdict = verify(request.mission, plan, request.ignore, request.objective, request.fixed)
    if not verdict.valid:
        details = "; ".join(f"{v.kind} {v.detail}" for v in verdict.violations[:_MOST_SHOWN])
        raise MusterError(f"internal error: the judge rejects the plan of {plan.allocator}: {details}")
    return verdict


def plot(mission: Mission, plan: Plan, *, ax: Any = None) -> Any:
    """Draw a plan's routes; returns the matplotlib Axes (`ax`, if given). Needs the extra `plot`."""
    from muster.report import plot_routes

    return plot_routes(mission, plan, verify(mission, plan, plan.ignored, plan.objective), ax=ax)
