"""Events of the run as a whole: its plans, its orders, and what people had done."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any, Self

from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.state import words
from muster.state.event import ExecutionEvent, happens
from muster.state.reasons import reasons_in_one_line

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState

IMPROVED = "improved"
"""The cause of a new plan that a search in the background has found."""


@happens("mission_begins", words.mission_begins)
class MissionBegins(ExecutionEvent):
    """A run of real robots begins: `zero_s` is when the mission's clock was 0, seconds since 1970.

    `places` are by robot where it begins: its coordinates in the map frame, metres, and its heading, degrees.
    """

    zero_s: float
    starts_at: str | None = None
    after_s: float = 0.0
    places: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def change(self, state: MissionState) -> None:
        state.zero_s = self.zero_s
        for robot, (*position, heading_deg) in self.places.items():
            state.robots[robot].begin_at(tuple(position), heading_deg)


@happens("mission_ended", "the mission is over")
class MissionEnded(ExecutionEvent):
    """All is done that can be; `ended_s` is when the last robot was, where that was before now."""

    ended_s: float | None = None

    def change(self, state: MissionState) -> None:
        state.ended_s = self.time_s if self.ended_s is None else self.ended_s


@happens("plan", words.plan)
class PlanAdopted(ExecutionEvent):
    """A plan holds from now on.

    `routes` are by robot the tasks that lie ahead, of those robots alone for which they have changed; `left_out` is by
    task that no robot is to do why, None of one that has a robot again. In format 1 `plan` is the whole plan.
    """

    routes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    left_out: Mapping[str, str | None] = field(default_factory=dict)
    plan: Mapping[str, Any] | None = None

    @classmethod
    def of(cls, plan: Plan, state: MissionState) -> Self:
        """What a plan of the whole mission changes."""
        is_open = {task.id for task in state.ledger.open}
        ahead = {route.robot: tuple(name for name in route.tasks if name in is_open) for route in plan.routes}
        told = (item for item in plan.unassigned if item.task in is_open and item.reasons)
        why = {item.task: reasons_in_one_line(item.reasons) for item in told}
        routes = {name: ahead.get(name, ()) for name, one in state.robots.items() if not one.out}
        gone = {name: None for name in state.left_out if name not in why}
        return cls(
            routes={name: route for name, route in routes.items() if route != state.routes.get(name, ())},
            left_out=gone | {task: because for task, because in why.items() if because != state.left_out.get(task)},
        )

    def change(self, state: MissionState) -> None:
        if self.plan is not None:
            PlanAdopted.of(plan_from(self.plan, "the log"), state).change(state)
        state.adopt(self.routes, self.left_out)


@happens("replanned", words.replanned, mark=words.replanned_mark)
class Replanned(ExecutionEvent):
    """The rest was planned again: causes, and by task the robots before and now."""

    written = ("moved", "forced", "added", "dropped", "left_out")
    causes: tuple[Mapping[str, Any], ...] = ()
    moved: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    forced: tuple[str, ...] = ()
    added: Mapping[str, str] = field(default_factory=dict)
    dropped: Mapping[str, str] = field(default_factory=dict)
    left_out: Mapping[str, str] = field(default_factory=dict)

    def change(self, state: MissionState) -> None:
        state.replanned += 1
        state.go_on()
        for task in self.added:
            state.orders.route(task, self.time_s)
        state.orders.improved += any(cause["kind"] == IMPROVED for cause in self.causes)


@happens("event_refused", words.event_refused, mark=words.ALARM)
class EventRefused(ExecutionEvent):
    """An event of the mission, or an order, does not fit."""

    event: Mapping[str, Any] = field(default_factory=dict)
    reason: str

    def change(self, state: MissionState) -> None:
        if self.event:
            state.orders.refuse(self.event, self.reason, self.time_s)


@happens("resumed", words.resumed, mark=words.CHANGE)
class Resumed(ExecutionEvent):
    """A run goes on after a stop; work on `again` is begun again. `used` is by robot its usage, where that is known."""

    written = ("again",)
    how: str = ""
    again: tuple[str, ...] = ()
    used: Mapping[str, float] = field(default_factory=dict)

    def change(self, state: MissionState) -> None:
        state.resume()
        for robot, used in self.used.items():
            state.note_used(robot, used)
