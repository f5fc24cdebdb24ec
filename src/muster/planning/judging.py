"""Judging of plans: those that are given, and each plan before it leaves planning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.request import require_mission

if TYPE_CHECKING:
    from muster.verification import Verdict

_MOST_SHOWN = 3


def verify(mission: Mission, plan: Plan) -> Verdict:
    """Judge a plan from scratch, by code that no allocator uses."""
    from muster.verification import verify as judge

    require_mission(mission)
    return judge(mission, plan)


def judged(mission: Mission, plan: Plan) -> Verdict:
    """The verdict on a plan that an allocator has made.

    Raises
    ------
    MusterError
        if the judge rejects it, which is an error of the allocator.
    """
    verdict = verify(mission, plan)
    if not verdict.valid:
        details = "; ".join(f"{v.kind} {v.detail}" for v in verdict.violations[:_MOST_SHOWN])
        raise MusterError(f"internal error: the judge rejects the plan of {plan.allocator}: {details}")
    return verdict


def plot(mission: Mission, plan: Plan, *, ax: Any = None) -> Any:
    """Draw a plan's routes; returns the matplotlib Axes (`ax`, if given). Needs the extra `plot`."""
    from muster.report import plot_routes

    return plot_routes(mission, plan, verify(mission, plan), ax=ax)
