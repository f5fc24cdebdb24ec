"""Who watches a mission being carried out: what is told, and in what form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from muster.mission.plan import Plan
from muster.motion.port import Telemetry


class Observer(Protocol):
    """Is told everything, in the order in which it happens. Times are seconds of the mission's clock."""

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Something happened; `data` is plain: texts, numbers, lists and mappings."""
        ...

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        """A robot said something new."""
        ...

    def on_plan(self, now: float, plan: Plan) -> None:
        """From now on this is the plan: of the whole mission, what is done included."""
        ...


class NoObserver:
    """Keeps nothing."""

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        pass

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        pass

    def on_plan(self, now: float, plan: Plan) -> None:
        pass
