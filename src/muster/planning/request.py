"""The one planning request that Python, the command and the server's worker make."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.mission.value_types import shown
from muster.planning.options import PlanningOptions, options_from


@dataclass(frozen=True, kw_only=True)
class Request(PlanningOptions):
    """What is planned, and how.

    Parameters
    ----------
    mission
        the question.
    start
        a plan to go on from.
    fixed
        a plan whose routes stay as the beginnings of the new ones; `search` and `greedy` alone.

    Raises
    ------
    ParameterError
        as `PlanningOptions` does; for a mission or plan that is none.
    """

    mission: Mission
    start: Plan | None = None
    fixed: Plan | None = None

    def __post_init__(self) -> None:
        require_mission(self.mission)
        for name, plan in (("start", self.start), ("fixed", self.fixed)):
            if not isinstance(plan, Plan | None):
                raise ParameterError(f"{name}: {shown(plan)}; expected a Plan")
        super().__post_init__()

    @classmethod
    def of(
        cls, options: PlanningOptions, mission: Mission, start: Plan | None = None, fixed: Plan | None = None
    ) -> Request:
        """The request for a mission with these options."""
        given = {f.name: getattr(options, f.name) for f in fields(PlanningOptions)}
        return cls(mission=mission, start=start, fixed=fixed, **given)


def request_from(mission: Mission, data: Mapping[str, Any]) -> Request:
    """The request for a mission with options, and plans `start` and `fixed`, as plain data.

    Raises
    ------
    MusterError
        if one is wrong.
    """
    plans = {name: plan_from(data[name], name) for name in ("start", "fixed") if data.get(name) is not None}
    options = options_from({name: value for name, value in data.items() if name not in ("start", "fixed")})
    return Request.of(options, mission, **plans)


def require_mission(mission: object) -> None:
    """Refuse what is no mission.

    Raises
    ------
    ParameterError
    """
    if not isinstance(mission, Mission):
        raise ParameterError(
            f"mission: {shown(mission)}; expected a Mission: muster.load makes one from a file or name"
        )
