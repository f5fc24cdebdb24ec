"""A plan that a server keeps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster_control.client.reading import read
from muster_control.contract import PlanEntry


@dataclass(frozen=True, kw_only=True)
class ServerPlan(Plan):
    """A plan with its number at the server; `entry` has its mission, version, author and time."""

    id: int
    entry: PlanEntry

    def as_dict(self) -> dict[str, Any]:
        """The plan as its file holds it."""
        return Plan(**{f.name: getattr(self, f.name) for f in fields(Plan)}).as_dict()

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> ServerPlan:
        """The plan in the answer of a server.

        Raises
        ------
        PlanError
            if it is none.
        """
        entry = read(PlanEntry, data)
        plan = plan_from(entry.plan, f"plan {entry.id}")
        return cls(id=entry.id, entry=entry, **{f.name: getattr(plan, f.name) for f in fields(Plan)})
