"""Refuses inadmissible plans before they are given to robots or other programs."""

from __future__ import annotations

from collections.abc import Collection

from muster.mission.errors import Finding, PlanError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.verification.judge import verify
from muster.verification.verdict import Verdict


def require_admissible(mission: Mission, plan: Plan, file: str, ignore: Collection[str] = ()) -> Verdict:
    """The verdict on a plan that breaks no rule but those to `ignore`; `file` names it in the message.

    Which objective the plan was to minimise makes no difference to that.

    Raises
    ------
    PlanError
        if it breaks one.
    """
    verdict = verify(mission, plan, ignore, plan.objective)
    if not verdict.valid:
        first, *others = verdict.violations
        more = f" and {len(others)} more" if others else ""
        parts = ", ".join(part for part in (first.robot, first.task, first.detail) if part)
        expected = f"an admissible plan of mission {mission.name}; muster verify says what is wrong"
        raise PlanError([Finding(file, None, first.kind, f"{parts}{more}", expected)])
    return verdict
