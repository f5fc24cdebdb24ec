"""The published plans and measurements of the chapter, as the library holds them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.library import published
from muster_studies.misprints import corrected, printed
from muster_studies.thesis_6.flights import Flight, Routes

MEASURED = {"gazebo": "Gazebo", "real": "real"}
"""Where something was measured, and how tables here call it."""


@cache
def tables() -> Mapping[str, Any]:
    """The published tables of the chapter."""
    found: Mapping[str, Any] = published("tcf-experiments")["tables"]
    return found


@dataclass(frozen=True, eq=False)
class PublishedPlan:
    """One plan of a table of routes. `routes` is as stored, with misprints."""

    scenario: str
    mission: str
    allocator: str
    figure: str
    ignored: tuple[str, ...]
    routes: Mapping[str, Mapping[str, Any]]

    @property
    def sequences(self) -> Routes:
        """Each robot's tasks, corrected."""
        return tuple((robot, _names(corrected(route)["tasks"])) for robot, route in self.routes.items())

    def printed_tasks(self, robot: str) -> tuple[str, ...]:
        return _names(printed(self.routes[robot])["tasks"])

    def usage(self, robot: str, kind: str = "") -> float | None:
        """What the thesis calculated for a robot, corrected, or measured in `gazebo` or `real`; None: it did not."""
        value: float | None = corrected(self.routes[robot]).get(f"{kind}_usage" if kind else "usage")
        return value

    def usages(self, kind: str = "") -> tuple[float, ...]:
        """Of all robots; empty where some have none."""
        found = [self.usage(robot, kind) for robot in self.routes]
        return tuple(usage for usage in found if usage is not None) if None not in found else ()

    @property
    def with_actions(self) -> str | None:
        """The mission in which tasks are ways that are driven; None of a plan that the thesis only calculated."""
        return f"{self.scenario}-actions" if self.usages("gazebo") else None

    def flight(self, mission: str | None = None, **terms: Any) -> Flight:
        """The corrected plan carried out, in its own mission or another with the same tasks."""
        return Flight(mission=mission or self.mission, routes=self.sequences, ignored=self.ignored, **terms)


@cache
def plans(number: str) -> tuple[PublishedPlan, ...]:
    """The plans of a table of routes."""
    table = tables()[number]
    return tuple(
        PublishedPlan(
            scenario=data["mission"],
            mission=data["run_as"],
            allocator=data["allocator"],
            figure=data["figure"],
            ignored=tuple(table["ignored"]),
            routes=data["routes"],
        )
        for data in table["plans"]
    )


def excess(value: float, base: float) -> float:
    """By how much a value is more than another, per cent; 0 for what would be printed as -0.00 or 0.00."""
    off = 100 * (value / base - 1)
    return off if abs(off) >= _PRINTED else 0.0


_PRINTED = 0.005


def _names(tasks: Any) -> tuple[str, ...]:
    return tuple(map(str, tasks))
