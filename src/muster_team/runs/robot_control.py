"""Control of one robot that decides for itself: it executes what it owns, and tells the others what it has done."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from muster.execution import ExecutionEvent, Executor, Revision, travel_of, way_of
from muster.execution.peers import Gathering
from muster.execution.replanning.reallocation import usage_ahead
from muster.execution.replanning.remaining_problem import RemainingMission
from muster.execution.reports.team_report import RefusedOrder
from muster.execution.robots.monitor import exceeds
from muster.execution.robots.robot_state import Activity
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Event, MovedTask, Task
from muster.mission.plan import Plan
from muster.mission.value_types import shown
from muster.model.problem import Problem
from muster.model.schedule import held_back_for
from muster.motion.port import RobotPort
from muster.state import OtherEvent
from muster.state.task_events import Ends, TaskRefused
from muster.state.task_ledger import moved
from muster_team.auctions.capabilities import refuse_once_together
from muster_team.knowledge.facts import deeds, in_order
from muster_team.knowledge.messages import ORDERS, Fact
from muster_team.knowledge.new_tasks import content_of, task_of
from muster_team.knowledge.orders import Orders
from muster_team.negotiators.negotiator import Negotiator
from muster_team.runs.own_events import ITS_OWN, MISSES, REFUSALS, is_back
from muster_team.runs.robot_ground import RobotGround

NOTICE_HEARTBEATS = 3.0
"""The time before a joint begin in which all have to learn of it, in heartbeats."""

LATENESS = 0.1
"""The share of the time until a task begins by which it may be late; what it must follow soon is held back for that."""

OFFER_REST_S = 5.0
"""Real seconds between two epochs that a robot opens as its way has turned out to be longer: robots have to agree."""


class RobotControl:
    """The control of one robot.

    Its executor asks the negotiator what the robot owns, and for permission to begin a task.

    Parameters
    ----------
    problem
        the mission that the team negotiates about.
    port
        the port of the robot's body, which has sent telemetry.
    negotiator
        the robot's part in the auction.
    now
        the mission's time, seconds.
    used
        the usage so far, in the mission's unit.
    speed
        by how much the mission's time goes faster than that of messages.
    ground
        the map that the robot builds with the others; None: it has one.
    """

    def __init__(
        self,
        problem: Problem,
        port: RobotPort,
        negotiator: Negotiator,
        now: float,
        used: float,
        speed: float = 1.0,
        ground: RobotGround | None = None,
    ) -> None:
        mission = problem.mission.at_once()
        robot_paths = problem.robot_paths if mission.has_paths else None
        robot_paths = robot_paths if ground is None else ground.paths
        self._travel = travel_of(mission, robot_paths)
        self._negotiator = negotiator
        self._executor = Executor(
            mission,
            Plan(mission=mission.name, ignored=problem.ignored, routes=()),
            {port.robot: port},
            way=way_of(mission, robot_paths),
            travel=self._travel,
            replan=self._owned,
            now=now,
            peers=self,
        )
        self._ground = ground
        if ground is not None:
            ground.begin(self._executor)
        self._limited = problem.holds("capacity")
        self._hand = self._executor.crew[port.robot]
        self._hand.recall(used)
        self._learned: set[Fact] = set()
        self._answered: set[Fact] = set()  # orders that were refused
        self.refused_orders: tuple[RefusedOrder, ...] = ()
        """Orders that do not count, as far as the robot knows."""
        self._dropped: set[str] = set()  # the tasks of those that were known before
        self._known = 0  # the digest of what was learned
        self._first = 0  # the number of the first event of this tick
        self._left_with: dict[str, tuple[float, float]] = {}  # the usage for tasks broken off, the last time
        self._offer_again_s, self._offer_rest_s = now, OFFER_REST_S * speed
        if ground is not None:
            negotiator.offer()  # what was agreed first counts on what nobody has seen yet
        self._notice_s = NOTICE_HEARTBEATS * negotiator.timeouts.heartbeat_s * speed

    @property
    def idle(self) -> bool:
        """Whether it has neither a task nor a path left."""
        return self._executor.idle and (bool(self._hand.out) or not self._wanted)

    @property
    def used(self) -> float:
        """The usage so far, in the mission's unit."""
        return self._hand.used

    def tick(self, now: float) -> Sequence[ExecutionEvent]:
        """Advance to a time, after its telemetry; return what the robot did and what happened to its body."""
        self._first = self._executor.events.total
        self._break_off()
        self._learn()
        self._give_back_dropped()
        if self._ground is not None:
            self._executor.set_clock(now)
            self._ground.look(now)
        wanted = self._wanted
        if not self._hand.out and (wanted != self._hand.route or any(map(self._too_late_for, wanted))):
            self._executor.plan_again(OtherEvent(kind="agreed"))
        routed = {*wanted, *self._hand.route}
        for event in self._executor.tick(now):
            if event.kind == "ends":
                self._negotiator.finish(event.data["task"])
            elif is_back(event):
                self._negotiator.come_back()
            elif event.kind == "way_closed":
                self._negotiator.offer(keeps=next(iter(self._hand.route), ""))
        if self._negotiator.offers and self._negotiator.settled and now >= self._offer_again_s:
            self._offer_again_s = now + self._offer_rest_s
            self._negotiator.open_offer()
        self._tell_unreachable()
        self._negotiator.joint.leave_all_but(self._at)
        news = [event for event in self._news if event.kind in ITS_OWN or is_back(event)]
        return [event for event in news if event.kind not in MISSES or event.data["task"] in routed]

    def _tell_unreachable(self) -> None:
        """Tell, once all is done that the robot owns, which tasks of nobody its map proves to be out of its reach."""
        ledger, hand = self._executor.ledger, self._hand
        if self._ground is None or not (self._negotiator.settled and self.idle) or hand.out:
            return
        for task in ledger.open:
            known = hand.robot.id in ledger.refusals.get(task.id, {}) or not task.is_open_to(hand.robot.id)
            if known or self._negotiator.owners([task.id]):
                continue
            if not self._ground.reaches(hand.position, task):
                self._refuse(task.id, "unreachable: there is no way")

    def take_event(self, event: Event) -> str | None:
        """Apply what an operator tells for the whole team; return the reason if it makes no sense."""
        try:
            if event.new_task is not None:
                if not self._is_known(event.new_task):  # else it was announced before
                    refuse_once_together([event.new_task], self._negotiator.rules.tied)
                    self._negotiator.announce(event.new_task)
            elif event.cancel_task is not None:
                self._negotiator.cancel(event.cancel_task)
            elif event.move_task is not None:
                self._negotiator.move(self._moved(event.move_task))
            else:
                self._executor.report(event)
                if event.robot_returns is not None:
                    self._negotiator.come_back()
        except (MissionError, ParameterError) as error:
            return str(error)
        return None

    def may_begin(self, task: str) -> bool:
        """As `execution.Peers.may_begin`."""
        return self._negotiator.begin(task)

    def gather(
        self, task: str, unit: Sequence[str], earliest_s: float, lasts_s: float, next_begin: Callable[[float], float]
    ) -> Gathering:
        """As `execution.Peers.gather`."""
        joint, now = self._negotiator.joint, self._executor.now_s
        members = self._negotiator.owners(unit)
        start = joint.start(task, members)
        if start is None and (self._negotiator.robot, task) in members:  # else a new auction is under way
            from_s = max(earliest_s, now + joint.notice_s(task, self._notice_s))
            joint.state_ready(task, unit, members, from_s, lasts_s)
            if absent := joint.absent(task, members):
                return Gathering(absent)
            start = joint.learn_start(task, members, now, next_begin)
            if start is None:
                joint.state_again(task, members, from_s, lasts_s)
        if start is None:
            return Gathering()
        return Gathering((), next_begin(start.from_s), start.lasts_s[task], start.team(task))

    def hold_until_s(self, task: str, now: float) -> float:
        """As `execution.Peers.hold_until_s`, by the schedule of all routes that the robots have agreed on."""
        ledger, spans = self._executor.ledger, self._negotiator.spans
        until_s = now
        for before in self._unit(task):
            for name in ledger.dependants_soon_after([before]):
                if name not in spans or before not in spans:
                    continue
                least_s, most_s = ledger.model.gaps(name)[before]
                (begin_s, _), (starts_s, ends_s) = spans[name], spans[before]
                late_s = held_back_for(max(0.0, begin_s - now), LATENESS, least_s, most_s)
                until_s = max(until_s, begin_s + late_s - most_s - (ends_s - starts_s))
        return min(until_s, max(now, self._latest_s(task)))

    def _latest_s(self, task: str) -> float:
        """Until when a task may be held back for others, for its own times; they are kept with time to spare."""
        ledger, latest_s = self._executor.ledger, math.inf
        for name in self._unit(task):
            begin_s, ends_s = self._negotiator.spans.get(name, (0.0, 0.0))
            latest_s = min(latest_s, ledger.model.begins_by_s(name, begin_s, ends_s - begin_s, ledger.ends_s))
        return latest_s - self._notice_s

    def begin_together(self, task: str) -> None:
        """As `execution.Peers.begin_together`."""
        self._negotiator.joint.begin(task)

    def end_together(self, task: str) -> bool:
        """As `execution.Peers.end_together`."""
        return self._negotiator.joint.end(task)

    @property
    def _news(self) -> Sequence[ExecutionEvent]:
        """The events of this tick so far."""
        return self._executor.events.since(self._first)

    @property
    def _at(self) -> str:
        """The task at which the robot waits or works; empty if at none."""
        there = self._hand.activity in (Activity.WAITING, Activity.WORKING) and not self._hand.out
        return self._hand.route[0] if there else ""

    def _unit(self, task: str) -> Sequence[str]:
        """The tasks that begin together with a task."""
        ledger = self._executor.ledger
        return ledger.unit(task) if task in ledger.tasks else (task,)

    def _break_off(self) -> None:
        """Leave tasks begun with others that are no team any more, or have to begin again."""
        joint = self._negotiator.joint
        for task in list(joint.under_way):
            members = self._negotiator.owners(self._unit(task))
            if joint.is_broken(task, members, owned=self._negotiator.owns(task)):
                joint.forget(task)
                if self._at == task:
                    hand = self._hand
                    self._left_with[task] = hand.usage_to_task, hand.used - hand.used_before
                    self._executor.break_off(task)

    @property
    def _wanted(self) -> list[str]:
        """What it owns, in order, without tasks that have to wait for more robots."""
        still = {task.id for task in self._executor.ledger.open} - self._negotiator.held
        return [claim.task for claim in self._negotiator.route if claim.task in still]

    def _learn(self) -> None:
        """Process what other robots did, and new tasks, from the facts that the robots share.

        A fact of a task that is not known yet waits until it is, and so does a new task for its prerequisites.
        """
        if self._known == self._negotiator.known:
            return
        facts, self._known = in_order(self._negotiator.facts), self._negotiator.known
        orders = self._negotiator.orders
        taken, tasks = frozenset(orders.taken), self._executor.ledger.tasks
        for fact in facts:
            holds = fact in taken if fact.kind in ORDERS else fact.task in tasks
            if fact in self._learned or not holds:
                continue
            self._learned.add(fact)
            if fact.kind == "cancelled":
                self._drop(fact.task)
            elif fact.kind == "moved":
                move = MovedTask(task=fact.task, position=task_of(fact.content).position)
                self._executor.report_if_it_fits(Event(at_s=0.0, move_task=move))
            elif fact.kind == "added" and fact.task not in tasks:
                self._executor.report_if_it_fits(Event(at_s=0.0, new_task=task_of(fact.content)))
        self._answer(orders)
        for task, times in deeds(facts).items():
            if task in tasks:
                self._count_as_done(task, times[0])
        self._negotiator.joint.leave_of_last_life(self._unit)

    def _answer(self, orders: Orders) -> None:
        """Give up orders that do not count any more; whoever was given such an order tells why."""
        self.refused_orders = tuple(
            RefusedOrder(robot=fact.robot, task=fact.task, reason=reason) for fact, reason in orders.refused.items()
        )
        for fact, reason in orders.refused.items():
            if fact in self._answered:
                continue
            self._answered.add(fact)
            if fact.robot == self._negotiator.robot:
                self._refuse(fact.task, f"order: {reason}")
            if fact in self._learned and fact.kind == "added":
                self._drop(fact.task)
                self._dropped.add(fact.task)

    def _give_back_dropped(self) -> None:
        """A task with the name of an order that was dropped is another one, which the executor cannot take in."""
        for task in filter(self._negotiator.owns, sorted(self._dropped)):
            self._refuse(task, "its name was that of an order that does not count")
            self._negotiator.release(task)

    def _drop(self, task: str) -> None:
        """A task need not be done any more."""
        self._executor.report_if_it_fits(Event(at_s=0.0, cancel_task=task))
        self._negotiator.abandon(task)

    def _count_as_done(self, task: str, by: Sequence[Fact]) -> None:
        """A task was done, as these facts say. A robot may have done its part, and hear only now that others have."""
        team = tuple(sorted(fact.robot for fact in by))
        is_new = self._executor.end_elsewhere(task, team)
        if is_new and by[0].kind == "part" and self._negotiator.robot in team:
            part = self._left_with.get(task, (0.0, 0.0))
            self._executor.emit(Ends(task=task, robot=team[0], team=team if len(team) > 1 else (), usage=part))

    def _owned(self, rest: RemainingMission) -> Revision:
        """The plan of the rest is what the robot owns. It gives back what it cannot do."""
        robot = self._negotiator.robot
        begun = {claim.task for claim in self._negotiator.route if claim.begun}
        once = self._negotiator.once
        for task in self._wanted:
            refused = rest.refusals.get(task, {}).get(robot)
            if refused and not (task in begun and task in once):
                self._refuse(task, refused)
                self._negotiator.release(task)
        for task in self._wanted:
            if why := rest.expired.get(task) or self._too_late_for(task):  # no robot can begin it any more
                self._refuse(task, why)
                self._negotiator.cancel(task)
        if not rest.crew:
            for task in begun - once:
                self._negotiator.release(task)
            for task in begun & once:  # no other robot may do it, nor tasks that wait for it
                self._negotiator.cancel(task)
            self._negotiator.withdraw()
            return _revision({}, {})
        (me,) = rest.crew
        capacity = me.robot.work_capacity if self._limited else None
        route = [task for task in self._wanted if task != me.task]
        while True:
            ahead = usage_ahead(replace(rest, routes={robot: route}), self._travel)
            most = me.used + ahead[robot][""]
            if capacity is None or not route or route[-1] in begun or not exceeds(most, capacity):
                return _revision({robot: tuple(route)}, ahead)
            self._refuse(route[-1], f"capacity: {most:.2f} used with it, of {capacity:.2f}")
            self._negotiator.release(route.pop())

    def _refuse(self, task: str, reason: str) -> None:
        """Tell why the robot gives a task back or up, unless the executor has just told it."""
        robot = self._negotiator.robot
        told = (event.data["task"] for event in self._news if event.kind in REFUSALS)
        if task not in told:
            self._executor.emit(TaskRefused(task=task, robot=robot, reason=reason))

    def _too_late_for(self, task: str) -> str:
        """Why the robot can begin a task no more where one that begins with it is done; empty where none is."""
        ledger = self._executor.ledger
        if task in self._negotiator.joint.under_way:
            return ""
        return ledger.too_late_to_begin_with([name for name in ledger.unit(task) if name in ledger.ends_s])

    def _is_known(self, task: Task) -> bool:
        """Whether the robot knows this new task, even if the task has moved since."""
        content = content_of(task)
        return any(fact.kind == "added" and fact.content == content for fact in self._negotiator.facts)

    def _moved(self, move: MovedTask) -> Task:
        ledger = self._executor.ledger
        if move.task not in ledger.tasks:
            raise ParameterError(f"move_task: {shown(move.task)}; expected the id of a task that there is by then")
        return moved(ledger.tasks[move.task], move.position)


def _revision(routes: Mapping[str, tuple[str, ...]], ahead: Mapping[str, Mapping[str, float]]) -> Revision:
    """A revision of this robot's route alone; the team knows the rest."""
    return Revision(routes=routes, ahead=ahead, moved={}, forced=frozenset(), added={}, dropped=(), left_out={})
