"""The log of a negotiated mission, put together from the robots' reports: events, task states, plans, figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import Any

from muster.allocation.problem import Problem
from muster.execution import ExecutionEvent, Observer
from muster.execution.punctuality import MISSED
from muster.execution.reallocation import why_left_out
from muster.execution.report import Account
from muster.execution.task_ledger import Ledger
from muster.execution.traffic_waits import TrafficAccount
from muster.mission.model import Event
from muster.mission.plan import Plan, Unassigned, teams_of
from muster.mission.yaml_writer import plain
from muster.motion.port import Telemetry
from muster.verification import verify

_OF_ALL_AT_WORK = ("starts", "ends", "work_broken_off")
_SAME_JAM_S = 30.0
"""Seconds within which two robots tell of one jam."""
_OF_A_TASK = ("cancel_task", "move_task", "delay_task")
_CAUSES = ("robot_stuck", "robot_returns", "task_refused", "work_broken_off", *MISSED.values())
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
        self.ledger = Ledger.of(problem.mission.tasks, problem.holds("prerequisite"), problem.ignored)
        self.events: list[ExecutionEvent] = []
        self.used = {robot.id: 0.0 for robot in problem.mission.robots if robot.id not in late}
        self._problem = problem
        self._observer, self._on_event = observer, on_event
        self._at_work: dict[str, tuple[str, ...]] = {}  # task: the robots that have begun it first
        self._came: dict[tuple[str, str], tuple[float, float]] = {}  # (robot, task): used by then, when
        self._began_s: dict[tuple[str, str], float] = {}  # (robot, task)
        self._usage: dict[tuple[str, str], tuple[float, float]] = {}  # (robot, task) done: planned, flown
        self._done_twice: dict[str, tuple[str, ...]] = {}
        self._out: dict[str, str] = {}  # robot: why
        self._traffic = TrafficAccount()
        self._jams_s: dict[frozenset[str], float] = {}  # when they were told
        self._plans: list[Plan] = []
        self._causes: list[dict[str, Any]] = []
        self._now_s = 0.0

    def is_out(self, robot: str) -> bool:
        """Whether a robot has failed or is stuck, as far as is known."""
        return robot in self._out

    @property
    def open_tasks(self) -> bool:
        return bool(self.ledger.open)

    def take(self, robot: str, at_s: float, kind: str, data: Mapping[str, Any], used: float) -> None:
        """Process an event that a robot reports of itself."""
        self.used[robot] = used
        task = str(data.get("task", ""))
        if kind == "arrives":
            self._came[robot, task] = used, at_s
        elif kind in _OF_ALL_AT_WORK and not self._is_news(robot, task, at_s, kind, tuple(data.get("team", (robot,)))):
            return  # another robot of the team has told it
        elif kind == "robot_stuck":
            self._lose(robot, f"did not get on at {at_s:g} s")
        elif kind == "robot_returns":
            self._out.pop(robot, None)
        elif kind == "task_refused":
            self.ledger.refuse(task, robot, str(data["reason"]))
        elif kind == "traffic_jam" and self._is_told_of_jam(frozenset(data["robots"]), at_s):
            return  # another robot of the jam has told it
        elif kind in MISSED.values() and data["next_s"] is None:
            self.ledger.expire(task, str(data["reason"]))
        if kind in _CAUSES:
            self._causes.append({"kind": kind, **data})
        self._traffic.take(kind, data)
        self.tell(at_s, kind, data)

    def note_usage(self, robot: str, task: str, usage: tuple[float, float]) -> None:
        """Note the planned and flown usage of a robot's part in a task that was done."""
        self._usage.setdefault((robot, task), usage)
        parts = [self._usage[one, task] for one in self.ledger.members(task) if (one, task) in self._usage]
        if parts:
            planned, flown = zip(*parts, strict=True)
            self.ledger.usage[task] = sum(planned), sum(flown)

    def take_event(self, event: Event, now_s: float) -> bool:
        """Process an event of the mission; return whether it changes anything."""
        ((kind, said),) = ((key, value) for key, value in plain(event).items() if key != "at_s")
        task = said["task"] if kind in ("move_task", "delay_task") else said
        if kind in _OF_A_TASK and (task in self.ledger.ends_s or task in self.ledger.cancelled):
            self.tell(now_s, "without_effect", plain(event))
            return False
        if event.new_task is not None:
            self.ledger.add(event.new_task)
        elif event.cancel_task is not None:
            self.ledger.withdraw(event.cancel_task, now_s)
        elif event.move_task is not None:
            self.ledger.move(event.move_task.task, event.move_task.position)
            self.ledger.refusals.pop(event.move_task.task, None)
        elif event.robot_fails is not None:
            self._lose(event.robot_fails, f"failed at {now_s:g} s")
        elif event.robot_joins is not None:
            self.used[event.robot_joins.id] = 0.0
        elif event.robot_returns is not None:
            self._out.pop(event.robot_returns, None)
        what = "task" if kind.endswith("_task") else "robot"
        data = said if kind in ("move_task", "delay_task") else {what: said}
        self._causes.append({"kind": kind, **data})
        self.tell(now_s, kind, data)
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
            self.tell(now_s, "replanned", {"causes": causes, **_difference(*self._plans[-2:])})
        self._observer.on_plan(max(now_s, self._now_s), plan)

    def tell(self, at_s: float, kind: str, data: Mapping[str, Any]) -> None:
        """Record an event. Late reports get the time at which they arrive, so that times never decrease."""
        self._now_s = max(self._now_s, at_s)
        event = ExecutionEvent(self._now_s, kind, data)
        self.events.append(event)
        self._observer.on_event(self._now_s, kind, data)
        self._on_event(event)

    def end(self) -> None:
        """The mission is over, since the last robot was done."""
        self._now_s = self.events[-1].time_s if self.events else 0.0
        for task, reason in self.lost().items():
            self.tell(self._now_s, "lost", {"task": task, "reason": reason})
        self.tell(self._now_s, "mission_ended", {})

    def lost(self) -> dict[str, str]:
        """Every task that is not done, and why."""
        reasons = {item.task: self._why(item) for item in self._plans[-1].unassigned} if self._plans else {}
        missed = {**{task.id: self._tied_to_done(task.id) for task in self.ledger.open}, **self.ledger.expired}
        return self.ledger.lost(lambda task: missed.get(task) or reasons.get(task) or "not done", self._out)

    def _why(self, item: Unassigned) -> str:
        """Why a task is left out by the robots that take part: what kept them from it, which no plan knows, first."""
        present = self.used.keys() - self._out.keys()
        if not present:
            return "no robot takes part any more"
        reasons = tuple(reason for reason in item.reasons if reason.robot in present)
        return why_left_out(replace(item, reasons=reasons), self.ledger.refusals.get(item.task, {}))

    def _tied_to_done(self, task: str) -> str:
        """Why a task cannot begin any more where one that begins with it is done; empty where none is."""
        done = [name for name in self.ledger.unit(task) if name in self.ledger.ends_s]
        return self.ledger.too_late_to_begin_with(done)

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
            ledger=self.ledger,
            lost=self.lost(),
            used=self.used,
            usage_planned=usages,
            mission_time_s=self._now_s,
            reallocations=len(self._plans) - 1,
            done_twice=self._done_twice,
            traffic=self._traffic,
        )

    def _is_told_of_jam(self, robots: frozenset[str], at_s: float) -> bool:
        told_s, self._jams_s[robots] = self._jams_s.get(robots, -math.inf), at_s
        return at_s - told_s < _SAME_JAM_S

    def _is_news(self, robot: str, task: str, at_s: float, kind: str, team: tuple[str, ...]) -> bool:
        """Process what all of a team tell when they begin, end or break off; return whether this robot is first."""
        if kind == "starts":
            return self._start(robot, task, at_s, team)
        if kind == "ends":
            return self._end(robot, task, at_s, team)
        return self._break_off(robot, task)

    def _start(self, robot: str, task: str, at_s: float, team: tuple[str, ...]) -> bool:
        self._began_s[robot, task] = at_s
        others = self.ledger.members(task) if task in self.ledger.ends_s else self._at_work.get(task, team)
        if others != team:
            robots = self._done_twice.setdefault(task, others)
            self._done_twice[task] = tuple(dict.fromkeys((*robots, *team)))
            self.tell(at_s, "twice", {"task": task, "robots": [others[0], robot]})
        elif task not in self.ledger.ends_s and task not in self._at_work:
            self._at_work[task] = team
            self._note_begun(task, team)
        elif len(team) > 1:
            self._note_begun(task, team)
            return False
        return True

    def _end(self, robot: str, task: str, at_s: float, team: tuple[str, ...]) -> bool:
        """Record the end of a task. It counts for those that end it first, even if others were at it."""
        self._at_work.pop(task, None)
        if task in self.ledger.ends_s:
            return len(team) == 1 or self.ledger.members(task) != team
        self.ledger.cancelled.pop(task, None)  # its robot has not heard that in time
        self._note_begun(task, team)
        self.ledger.end(task, team[0], at_s)
        return True

    def _break_off(self, robot: str, task: str) -> bool:
        """A robot has left what its team had begun."""
        if robot not in self._at_work.get(task, ()):
            return False
        del self._at_work[task]
        self.ledger.give_up(task)
        return True

    def _note_begun(self, task: str, team: tuple[str, ...]) -> None:
        """Note when the robots that do a task arrived and began, as far as they have told."""
        began = [self._began_s[robot, task] for robot in team if (robot, task) in self._began_s]
        if not began:
            return
        came = [self._came[robot, task] for robot in team if (robot, task) in self._came]
        self.ledger.arrive(task, max(used for used, _ in came), max(at_s for _, at_s in came))
        self.ledger.begin(task, max(began))
        self.ledger.teams[task] = team
        if len(team) > 1:
            self.ledger.team_waits_s[task] = sum(max(began) - at_s for _, at_s in came)

    def _lose(self, robot: str, why: str) -> None:
        """A robot is out: its task under way is given up."""
        self._out[robot] = why
        for task in [task for task, team in self._at_work.items() if robot in team]:
            del self._at_work[task]
            self.ledger.give_up(task)


def _difference(before: Plan, after: Plan) -> dict[str, Any]:
    """The changes between two plans, as `execution.Revision.difference` lists them."""
    old, new = _robots(before), _robots(after)
    left_out = {item.task: ", ".join(reason.reason for reason in item.reasons) for item in after.unassigned}
    return {
        "moved": {task: [old[task], robot] for task, robot in new.items() if old.get(task, robot) != robot},
        "forced": [],
        "added": {task: robot for task, robot in new.items() if task not in old},
        "dropped": {task: left_out.get(task, "") for task in old if task not in new},
    }


def _robots(plan: Plan) -> dict[str, str]:
    """The robots of each task in a plan, in words."""
    teams = teams_of((route.robot, route.tasks) for route in plan.routes)
    return {task: ", ".join(team) for task, team in teams.items()}
