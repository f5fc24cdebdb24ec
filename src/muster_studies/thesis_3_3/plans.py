"""Published plans, and the verdicts on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from muster.verification import Verdict
from muster_studies.misprints import corrected, printed
from muster_studies.runs import Case, judged
from muster_studies.thesis_3_3.published import is_random, publication


@dataclass(frozen=True)
class PublishedPlan:
    """One plan of a table of routes, judged under the rules of its test case: as printed, and with errata corrected."""

    scenario: str
    mission: str
    allocator: str
    ignored: tuple[str, ...]
    routes: Mapping[str, Mapping[str, Any]]
    as_printed: Verdict
    as_corrected: Verdict

    def case(self, iterations: int) -> Case:
        """The case that repeats it."""
        count = iterations if is_random(self.allocator) else None
        return Case(mission=self.mission, allocator=self.allocator, ignored=self.ignored, iterations=count)


@cache
def published_plans(number: str) -> Mapping[str, PublishedPlan]:
    """The plans of a table by scenario."""
    table = publication(number)
    return {data["mission"]: _judged(data, table.ignored) for data in table.content["plans"]}


def _judged(data: Mapping[str, Any], ignored: tuple[str, ...]) -> PublishedPlan:
    mission, routes = data["run_as"], data["routes"]
    return PublishedPlan(
        scenario=data["mission"],
        mission=mission,
        allocator=data["allocator"],
        ignored=ignored,
        routes=routes,
        as_printed=judged(mission, ignored, {robot: printed(route)["tasks"] for robot, route in routes.items()}),
        as_corrected=judged(mission, ignored, {robot: corrected(route)["tasks"] for robot, route in routes.items()}),
    )
