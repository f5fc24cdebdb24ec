"""Judging of plans: those that are given, and each plan before it leaves planning."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_of
from muster.planning.request import require_mission

if TYPE_CHECKING:
    from muster.verification import Verdict


def verify(
    mission: Mission,
    plan: Plan | Mapping[str, Any],
    ignore: str | Collection[str] = (),
    objective: str | None = None,
) -> Verdict:
    """Judge a plan from scratch, by code that no allocator uses.

    Parameters
    ----------
    plan
        a plan; or a mapping from robots to their tasks in order, or the content of a plan file.
    ignore
        rules that do not hold, as for `solve`. What the plan says of itself in `ignored` has no effect.
    objective
        the one that the plan was to minimise; the mission's by default.

    Raises
    ------
    ParameterError, NotSupportedError
    PlanError
        if a mapping is no plan.
    """
    from muster.verification import verify as judge

    require_mission(mission)
    return judge(mission, plan_of(plan), ignore, objective)


def admits(mission: Mission, plan: Plan, ignored: tuple[str, ...]) -> bool:
    """Return whether nothing is wrong with a plan: the `Judge` of searches and proofs."""
    from muster.verification import verify as judge

    return judge(mission, plan, ignored).valid


def judged(mission: Mission, plan: Plan, ignored: Collection[str], objective: str | None) -> Verdict:
    """The verdict on a plan that an allocator has made for an objective, some rules ignored.

    Raises
    ------
    MusterError
        if the judge rejects it, which is an error of the allocator.
    """
    from muster.allocation.registry import ALLOCATORS

    verdict = verify(mission, plan, ignored, objective)
    if not verdict.valid:
        internal = "internal error: " if plan.allocator in ALLOCATORS.shipped else ""
        raise MusterError(
            f"{internal}allocator {plan.allocator}: the judge rejects its plan: {verdict.first_violations}"
        )
    return verdict
