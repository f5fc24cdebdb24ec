"""What a new plan changes of the one before: routes ahead with their lines, and tasks that no robot is to do.

The first plan of a log or a record is written whole, and of each that follows what changes. So a file does not grow
with all that was done before each plan.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from muster.mission.model import Point
from muster.mission.plan import Plan, Reason, Route, Unassigned
from muster.mission.reading.plan_reader import plan_from
from muster.report.record.routes import is_over, names_ahead
from muster.state import MissionState
from muster.state.reasons import reasons_in_one_line

Lines = Mapping[str, Sequence[Point]]


@dataclass
class ReadPlan:
    """The plan in force, as far as the plans of a log or a record were read, in order.

    Parameters
    ----------
    source
        what is read, for messages.
    plan : Plan
        The plan; after the first one without figures, and without tasks that were over before.
    lines : mapping
        By robot its way ahead when that was last written.
    """

    source: str
    plan: Plan = field(default_factory=lambda: Plan(routes=(), unassigned=()))
    lines: Lines = field(default_factory=dict)

    def take(self, data: Mapping[str, Any]) -> Plan:
        """Take over the data of the next plan, as `PlanChanges.of` or an earlier Muster made them."""
        if "plan" in data:
            self.plan, self.lines = plan_from(data["plan"], self.source), data.get("lines", {})
            return self.plan
        routes = {route.robot: route for route in self.plan.routes}
        routes |= {robot: Route(robot, tuple(tasks)) for robot, tasks in (data["routes"] | data["stops"]).items()}
        left_out = {one.task: one for one in self.plan.unassigned} | {
            task: Unassigned(task, (Reason("", "not-chosen", why or ""),)) for task, why in data["left_out"].items()
        }
        back = {task for task, why in data["left_out"].items() if why is None}
        self.lines = {**self.lines, **data["lines"]}
        kept = {name: getattr(self.plan, name) for name in ("mission", "allocator", "ignored", "objective")}
        unassigned = tuple(one for task, one in left_out.items() if task not in back)
        self.plan = Plan(**kept, routes=tuple(routes.values()), unassigned=unassigned)
        return self.plan


class PlanChanges:
    """The plan that was written last, against which the next one is compared.

    Parameters
    ----------
    whole
        whether the first plan is written whole; else, where a run is resumed, all that lies ahead counts as changed.
    """

    def __init__(self, *, whole: bool = True) -> None:
        self._whole = whole
        self._routes: dict[str, list[str]] = {}
        self._lines: dict[str, Sequence[Point]] = {}
        self._left_out: dict[str, str] = {}

    def of(self, plan: Plan, lines: Lines, mission_state: MissionState) -> dict[str, Any]:
        """Return the data of a plan: `plan` and `lines`, or what changes of `routes`, `stops`, `lines` and `left_out`.

        Tasks that are over are in none of these; stations are in `stops`, of routes that have some. A task that was
        left out and no longer is has None in `left_out`.
        """
        ahead = {route.robot: names_ahead(route.tasks, mission_state) for route in plan.routes}
        changed = [robot for robot in lines if self._is_new(robot, ahead[robot], lines[robot], mission_state)]
        left_out = {
            one.task: reasons_in_one_line(one.reasons)
            for one in plan.unassigned
            if not is_over(one.task, mission_state)
        }
        back = {task: None for task in self._left_out if task not in left_out and not is_over(task, mission_state)}
        news = {task: why for task, why in left_out.items() if self._left_out.get(task) != why}
        self._left_out = left_out
        for robot in changed:
            self._routes[robot], self._lines[robot] = ahead[robot], lines[robot]
        if self._whole:
            self._whole = False
            return {"plan": plan.as_dict(), "lines": lines}
        stops = {robot: ahead[robot] for robot in changed}
        routes = {robot: [name for name in names if name in mission_state.tasks] for robot, names in stops.items()}
        return {
            "routes": routes,
            "stops": {robot: names for robot, names in stops.items() if names != routes[robot]},
            "lines": {robot: lines[robot] if stops[robot] else [] for robot in changed},
            "left_out": news | back,
        }

    def _is_new(self, robot: str, ahead: Sequence[str], line: Sequence[Point], mission_state: MissionState) -> bool:
        """Whether a robot has another way ahead than what is left of the one before."""
        if robot not in self._routes or bool(ahead) != bool(self._routes[robot]):
            return True
        before, rest = [name for name in self._routes[robot] if not is_over(name, mission_state)], line[1:]
        known = self._lines[robot]
        return list(ahead) != before or list(rest) != list(known[len(known) - len(rest) :])
