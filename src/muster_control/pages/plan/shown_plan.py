"""The plan that a page shows, as the parts of the page below it see it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from muster_control.contract import PlanEntry


class ShownPlan(Protocol):
    """The plans of a mission, one of which is shown."""

    @property
    def mission(self) -> str:
        """The mission's name."""
        ...

    @property
    def entry(self) -> PlanEntry | None:
        """The plan that is shown."""
        ...

    @property
    def entries(self) -> Sequence[PlanEntry]:
        """The newest plans of the mission, the newest first."""
        ...

    async def show_newest(self, plan: int) -> None:
        """Show a plan that has just come."""
        ...
