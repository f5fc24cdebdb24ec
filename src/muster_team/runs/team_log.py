"""The log of a negotiated mission, put together from the robots' reports: events, the state, plans, figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, replace
from typing import Any

from muster.execution import Observer
from muster.execution.replanning.reallocation import why_left_out
from muster.execution.reports.report import Account
from muster.execution.reports.robot_report import RobotReport
from muster.mission.model import Event
from muster.mission.plan import Plan, Unassigned, teams_of
from muster.mission.yaml_writer import plain
from muster.model.problem import Problem
from muster.motion.port import Telemetry
from muster.state import ExecutionEvent, MissionState, OtherEvent, event_of
from muster.state.event import KINDS
from muster.state.robot_events import RobotReturns, RobotSilent, RobotStuck, TrafficJam, WayClosed
from muster.state.run_events import MissionEnded, PlanAdopted, Replanned
from muster.state.task_events import (
    CancelTask,
    DelayTask,
    Ends,
    Lost,
    MoveTask,
    PartEnds,
    Starts,
    TaskMissed,
    TaskRefused,
    Twice,
    WorkBrokenOff,
)
from muster.verification import verify

_SAME_JAM_S = 30.0
"""Seconds within which two robots tell of one jam."""
_CAUSES = (RobotStuck, RobotReturns, TaskRefused, WorkBrokenOff, TaskMissed, WayClosed)
"""What robots tell that makes them agree anew."""
_NEW_AGREEMENT = {"kind": "new_agreement"}
"""Robots agreed anew, and told of nothing that has happened: they lost each other, or met again."""


class TeamLog:
    """Records events and forwards them to an observer. It contains more than each robot knows, and no robot sees it.

    Parameters
    ----------
    problem
        the mission that the team negotiates about.
    observer
        receives events, telemetry and plans.
    on_event
        receives events.
    late
        robots that are absent before they join.
    """

    def __init__(
        self,
        problem: Problem,
        observer: Observer,
        on_event: Callable[[ExecutionEvent], None],
        late: Collection[str] = (),
    ) -> None:
        present = [robot.id for robot in problem.mission.robots if robot.id not in late]
        self.state = MissionState(problem.mission, problem.ignored, own=present)
        self.events: list[ExecutionEvent] = []
        self.used = dict.fromkeys(present, 0.0)
        self._problem = problem
        self._observer, self._on_event = observer, on_event
        self._jams_s: dict[frozenset[str], float] = {}  # when they were told
        self._plans: list[Plan] = []
        self._causes: list[dict[str, Any]] = []
        self._now_s = 0.0

    def is_out(self, robot: str) -> bool:
        """Whether a robot has failed or is stuck, as far as is known."""
        return robot in self.state.gone

    @property
    def open_tasks(self) -> bool:
        return bool(self.state.ledger.open)

    def take(self, robot: str, at_s: float, kind: str, data: Mapping[str, Any], used: float) -> None:
        """Process an event that a robot reports of itself."""
        self.used[robot] = used
        event = event_of(at_s, kind, {"used": used, **data} if data.get("robot") == robot else data)
        if not self._is_news(robot, event):
            return  # another robot has told it
        if isinstance(event, _CAUSES):
            self._causes.append({"kind": kind, **event.data})
        self.tell(event)

    def take_event(self, event: Event, now_s: float) -> bool:
        """Process an event of the mission; return whether it changes anything."""
        happens = _happens(event)
        if isinstance(happens, CancelTask | MoveTask | DelayTask) and not self.state.ledger.is_open(happens.task):
            self.tell(OtherEvent(time_s=now_s, kind="without_effect", content=plain(event)))
            return False
        if event.robot_joins is not None:
            self.used[event.robot_joins.id] = 0.0
        self._causes.append({"kind": happens.kind, **happens.data})
        self.tell(happens.at(now_s))
        return True

    def see(self, robot: str, telemetry: Telemetry, now_s: float) -> None:
        """Process a robot's telemetry."""
        self._now_s = max(self._now_s, now_s)
        self._observer.on_telemetry(self._now_s, robot, telemetry)

    def agreed(self, plan: Plan, now_s: float) -> None:
        """Process the plan of the whole mission on which robots have agreed."""
        self._plans.append(plan)
        if len(self._plans) > 1:
            causes, self._causes = self._causes or [_NEW_AGREEMENT], []
            self.tell(Replanned(time_s=now_s, causes=tuple(causes), **_difference(*self._plans[-2:])))
        self._now_s = max(now_s, self._now_s)
        self.state.apply(PlanAdopted.of(plan, self.state).at(self._now_s))
        self._observer.on_plan(self._now_s, plan)

    def tell(self, event: ExecutionEvent) -> None:
        """Record an event. Late reports get the time at which they arrive, so that times never decrease."""
        self._now_s = max(self._now_s, event.time_s)
        self.state.apply(event)
        event = event.at(self._now_s)
        self.events.append(event)
        self._observer.on_event(self._now_s, event.kind, event.data)
        self._on_event(event)

    def end(self) -> None:
        """The mission is over, since the last robot was done."""
        self._now_s = self.events[-1].time_s if self.events else 0.0
        for task, reason in self.lost().items():
            self.tell(Lost(time_s=self._now_s, task=task, reason=reason))
        self.tell(MissionEnded(time_s=self._now_s))

    def lost(self) -> dict[str, str]:
        """Every task that is not done, and why."""
        ledger = self.state.ledger
        left_out = {task: Unassigned(task, ()) for task in ledger.refusals}  # also by robots that agree no more
        left_out |= {item.task: item for item in self._plans[-1].unassigned} if self._plans else {}
        reasons = {task: self._why(item) for task, item in left_out.items()}
        return ledger.lost(lambda task: ledger.expired.get(task) or reasons.get(task) or "not done", self.state.gone)

    def _why(self, item: Unassigned) -> str:
        """Why a task is left out by the robots that take part: what kept them from it, which no plan knows, first."""
        present = self.used.keys() - self.state.gone.keys()
        if not present:
            return "no robot takes part any more"
        reasons = tuple(reason for reason in item.reasons if reason.robot in present)
        return why_left_out(replace(item, reasons=reasons), self.state.ledger.refusals.get(item.task, {}))

    @property
    def account(self) -> Account:
        """The figures so far, or of the whole mission."""
        planned, usages = None, dict[str, float]()
        if self._plans:
            planned = self._plans[0].objective_value
            usages = {
                route.robot: route.usage
                for route in verify(self._problem.mission, self._plans[0], self._problem.ignored).routes
            }
        return Account(
            objective=self._problem.objective,
            objective_planned=planned,
            ledger=self.state.ledger,
            lost=self.lost(),
            robots={name: RobotReport(name, usages.get(name, 0.0), used) for name, used in self.used.items()},
            mission_time_s=self._now_s,
            reallocations=len(self._plans) - 1,
            done_twice=self.state.done_twice,
            traffic=self.state.traffic,
        )

    def _is_news(self, robot: str, event: ExecutionEvent) -> bool:
        """Whether no other robot of a team, or of a jam, has told it."""
        if isinstance(event, TrafficJam):
            return not self._is_told_of_jam(frozenset(event.robots), event.time_s)
        if isinstance(event, Starts):
            return self._is_new_start(robot, event)
        if isinstance(event, Ends):
            return self._is_new_end(robot, event)
        if isinstance(event, WorkBrokenOff):
            return robot in self.state.ledger.at_work(event.task)
        return True

    def _is_told_of_jam(self, robots: frozenset[str], at_s: float) -> bool:
        told_s, self._jams_s[robots] = self._jams_s.get(robots, -math.inf), at_s
        return at_s - told_s < _SAME_JAM_S

    def _is_new_start(self, robot: str, event: Starts) -> bool:
        ledger, team = self.state.ledger, event.team or (robot,)
        others = ledger.members(event.task) or team
        if others != team:
            self.tell(Twice(time_s=event.time_s, task=event.task, robots=(*others, *team)))
        return others != team or len(team) == 1 or not (event.task in ledger.ends_s or ledger.at_work(event.task))

    def _is_new_end(self, robot: str, event: Ends) -> bool:
        """A task counts for those that end it first, even if others were at it; each of a team tells of its part."""
        ledger, team = self.state.ledger, event.team or (robot,)
        if event.task not in ledger.ends_s or len(team) == 1 or ledger.members(event.task) != team:
            return True
        self.tell(PartEnds(time_s=event.time_s, task=event.task, robot=robot, usage=event.usage or (0.0, 0.0)))
        return False


def _happens(event: Event) -> ExecutionEvent:
    """What happens by an event of a mission, if it happens."""
    ((kind, said),) = ((key, value) for key, value in plain(event).items() if key != "at_s")
    if event.robot_silent is not None:
        return RobotSilent(robot=said, goes_on=True)
    named = {fields(KINDS[kind])[1].name: said}  # `time_s` comes first
    return event_of(math.nan, kind, said if isinstance(said, dict) and "id" not in said else named)


def _difference(before: Plan, after: Plan) -> dict[str, Any]:
    """The changes between two plans, as `execution.Revision.difference` lists them."""
    old, new = _robots(before), _robots(after)
    left_out = {item.task: ", ".join(reason.reason for reason in item.reasons) for item in after.unassigned}
    return {
        "moved": {task: (old[task], robot) for task, robot in new.items() if old.get(task, robot) != robot},
        "forced": (),
        "added": {task: robot for task, robot in new.items() if task not in old},
        "dropped": {task: left_out.get(task, "") for task in old if task not in new},
    }


def _robots(plan: Plan) -> dict[str, str]:
    """The robots of each task in a plan, in words."""
    teams = teams_of((route.robot, route.tasks) for route in plan.routes)
    return {task: ", ".join(team) for task, team in teams.items()}
