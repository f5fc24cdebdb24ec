"""The executor: carries a plan out through robot ports. Sans-I/O and in virtual time: `tick(now)` does all.

Each robot takes the next task of its route when it is available ([tcf-thesis], 5.3.1: `a_i`), goes there, waits until
all prerequisites have ended, does the work, and at last goes where its route ends. The monitor and events change what
is to be done, and the rest is planned again (`reallocation`).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from muster.execution.changes import Changes, new_robot_state, require_port
from muster.execution.deadlocks.resolution import Deadlocks
from muster.execution.deadlocks.traffic_waits import TrafficWaits
from muster.execution.dispatch import Dispatch
from muster.execution.peers import Peers
from muster.execution.record import NoObserver, Observer
from muster.execution.replanning.insertion import Insertion
from muster.execution.replanning.near_robots import NearRobots
from muster.execution.replanning.reallocation import Reallocation, Revision, first_ahead
from muster.execution.replanning.remaining_problem import RemainingMission
from muster.execution.replanning.situation import Part, remaining_mission_of, required_routes, whole_plan
from muster.execution.replanning.travel import Travel, travel_of
from muster.execution.reports.report import Account
from muster.execution.reports.work_figures import back_s, overtime_s, planned_so_far, robot_row
from muster.execution.robots.monitor import Limits, moves_again
from muster.execution.robots.robot_state import MOVING, Activity, RobotState
from muster.execution.robots.task_motion import MotionPlanner, Way, straight
from muster.execution.robots.work_orders import stop_work
from muster.execution.script import Script
from muster.execution.standing import KEPT_EVENTS, KEPT_REVISIONS, UNTIL_DONE, EventLog, Forgetting, Standing
from muster.execution.stations.energy_watch import EnergyWatch
from muster.execution.stations.slots import Stations
from muster.execution.stations.station_service import StationService
from muster.execution.supervision import Leader, NoLeader, Supervisor
from muster.execution.timing.beginning import Beginning
from muster.execution.timing.forecast import Forecast
from muster.execution.timing.outlooks import Outlooks
from muster.execution.timing.punctuality import Punctuality
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.mission.system.garbage import collector_paused
from muster.mission.yaml_writer import plain
from muster.motion import actions
from muster.motion.port import RobotPort
from muster.state import ExecutionEvent, MissionState, OtherEvent
from muster.state.mission_state import AT_MOST_ONCE
from muster.state.quantiles import Quantiles
from muster.state.robot_events import RobotFails, RobotsFree, RobotSilent, RobotStuck, RobotSuspended, WayClosed
from muster.state.run_events import IMPROVED, EventRefused, MissionEnded, PlanAdopted, Replanned, Resumed
from muster.state.station_events import EMPTY
from muster.state.task_events import DoneElsewhere, Lost, NewTask, TaskRefused, WorkBrokenOff

_ABSENT = (RobotSilent.kind, RobotSuspended.kind)
"""Kinds of the events after which a robot takes no part for a while, and takes part again by itself."""
MUCH_LONGER, MUCH_LONGER_M = 0.25, 2.0
"""Share of a way, taken as longer by some metres, by which another is longer so that the rest is planned again."""


class Executor:
    """Carries out one plan of one mission.

    Parameters
    ----------
    mission, plan
        what is to be done, with the events that happen meanwhile; and how. The rules that the plan ignores do not hold.
    ports
        for each robot how it is reached. A robot that joins has its port here by then.
    plan_motion
        what a task makes a robot do; by its action by default.
    way
        the places a robot passes from one place to another, between the way points of an action too.
    travel
        how travel is measured when the rest is planned again; by the mission's rule by default.
    replan
        plans the rest again; `Reallocation` by default.
    limits
        of the monitor.
    observer
        receives all events.
    now
        seconds of the mission's clock at which it begins.
    state, used
        what is known of a mission that goes on after a stop, None: it begins; and by robot its usage then, where that
        is known better than from events.
    peers
        the other robots' say, where this is the executor of those alone that have a port: then the mission is not over
        when they have nothing to do.
    standing
        how long a fleet stays on duty when its tasks are done, and for which orders; None: not at all.
    on_doors
        receives the ids of the doors that are closed, when one closes or opens.
    leader
        who leads robots through traffic; None: nobody.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a robot has no port.
    """

    def __init__(  # noqa: PLR0913  the parts of a run, each by its name
        self,
        mission: Mission,
        plan: Plan,
        ports: Mapping[str, RobotPort],
        *,
        plan_motion: MotionPlanner = actions.plan,
        way: Way = straight,
        travel: Travel | None = None,
        replan: Callable[[RemainingMission], Revision] | None = None,
        limits: Limits | None = None,
        observer: Observer | None = None,
        now: float = 0.0,
        state: MissionState | None = None,
        used: Mapping[str, float] | None = None,
        peers: Peers | None = None,
        standing: Standing | None = None,
        on_doors: Callable[[Collection[str]], None] = lambda closed: None,
        leader: Leader | None = None,
    ) -> None:
        begins = state is None
        planned = required_routes(mission, plan)
        own = [robot.id for robot in mission.robots] if peers is None else list(ports)
        self.mission, self.planned = mission, plan
        self.state = MissionState(mission, plan.ignored, own=own) if state is None else state
        self.ledger, self.goods, self.orders = self.state.ledger, self.state.goods, self.state.orders
        for robot in mission.robots if peers is None else ():
            require_port(robot, ports)
        here = [known for name, known in self.state.robots.items() if name in ports]
        self.crew = {one.robot.id: new_robot_state(mission, one, ports, now, self.ledger) for one in here}
        self.stations = Stations.of(self.state, self.crew)
        self.clock_lag = Quantiles()
        self._standing = UNTIL_DONE if standing is None else standing
        self.events = EventLog(KEPT_EVENTS if self._standing.forgets else None)
        self.revisions: deque[Revision] = deque(maxlen=KEPT_REVISIONS if self._standing.forgets else None)
        self._plans_searched = 0
        self._travel = travel_of(mission) if travel is None else travel
        self._replan = Reallocation(travel=self._travel) if replan is None else replan
        self._insertion = Insertion(self._travel)
        self._near = NearRobots(self.ledger, self.crew)
        self._observer = NoObserver() if observer is None else observer
        self._asked: list[ExecutionEvent] = []
        leader = NoLeader() if leader is None else leader
        self._limits = limits or Limits()
        self._changes = Changes(
            mission,
            self.state,
            self.crew,
            ports,
            self._travel,
            self.stations,
            self._ask,
            way,
            on_doors,
            leader.moved,
            plan_motion,
        )
        self._alone = peers is None
        self._forecast = Forecast(self.ledger, self.crew, plan_motion, way)
        hold_until_s = self._forecast.hold_until_s if peers is None else peers.hold_until_s
        self._beginning = Beginning(self.ledger, self.crew, hold_until_s, self._alone)
        self._punctuality = Punctuality(self.ledger, self.crew, self._beginning, self.emit, self._ask)
        self._dispatch = Dispatch(
            self.state,
            self.crew,
            self._beginning,
            self._capacity,
            self._forecast,
            self.emit,
            self._ask,
            peers,
        )
        self._dispatch.service = StationService(
            self.stations, self.ledger, self.goods, self._dispatch.way, self.emit, self._ask
        )
        self._energy = self._dispatch.energy = EnergyWatch(
            self.stations,
            self.crew,
            self.ledger,
            self._dispatch.way,
            lambda: self._dispatch.ahead,
            self._ask,
            on_duty=lambda: self._on_duty,
        )
        self.outlook = Outlooks(self.ledger, self.crew, self._beginning, self._forecast)
        self.traffic = TrafficWaits(self.crew)
        self._supervisor = Supervisor(
            self.crew,
            self.ledger,
            self._dispatch,
            self._changes,
            self.traffic,
            self._capacity,
            self._limits,
            self.emit,
            self._ask,
            now,
            leader,
        )
        self._deadlocks = Deadlocks(self.ledger, self.crew, self._beginning, self._punctuality, self._ask)
        self._forgetting = Forgetting(self.ledger, self.crew, self._forecast, self._standing.keep_s, self.emit)
        self._script = self._script_after(-math.inf if begins else self.state.now_s)
        self.now_s = now
        if begins:
            self.state.apply(PlanAdopted.of(plan, self.state).at(now))
        else:
            self._recall(used or {})
        for name, hand in self.crew.items():
            hand.route = [] if hand.out else list(self.state.routes.get(name, ()))
        ahead = first_ahead(self._rest(), self._travel, planned if begins else {})
        for name, one in ahead.items():
            self.crew[name].calls = list(one.calls)
        self._dispatch.ahead = {name: one.usage for name, one in ahead.items()}
        self._punctuality.expect(self._forecast, now)
        planned_ahead = {name: ahead[""] for name, ahead in self._dispatch.ahead.items() if math.isfinite(ahead[""])}
        self.usage_planned = {
            name: hand.known.planned + planned_ahead.get(name, 0.0) for name, hand in self.crew.items()
        }
        if not begins:
            self._follow_script()  # what was due while nothing ran
        self._observer.on_plan(now, self.plan if not begins else plan)

    @property
    def plan(self) -> Plan:
        """The plan of the whole mission as it is now: what each robot did, does and will do."""
        return whole_plan(self.mission, self.planned, self.crew, self.ledger, self.state.left_out)

    @property
    def done(self) -> bool:
        """Whether the mission is over."""
        return self.state.ended_s is not None and not self._asked

    @property
    def idle(self) -> bool:
        """Whether no robot has a task left, or is under way."""
        ways = [state for state in self._present if state.activity is not Activity.IDLE]
        return not ways and not any(
            state.route or state.calls or self._dispatch.goes_home(state) for state in self._present
        )

    @property
    def due_s(self) -> float:
        """When the clock alone brings something next: an event of the mission, a robot available; inf if nothing."""
        available = [state.robot.available_from_s for state in self._present if state.route]
        standing = (self._script.next_s, self._improvement_due_s, self._standing.stays_until_s)
        resting = [state.rests_until_s for state in self._present]
        times = [*standing, *available, *resting, *self._punctuality.times(self.now_s)]
        return min((time for time in times if time > self.now_s), default=math.inf)

    def report(self, event: Event, reason: str = "", came_s: float | None = None) -> None:
        """Let something happen that the mission file did not foresee; its `at_s` does not count.

        A mission that was over goes on if that changes anything. Why a robot fails may be said, in words, and when a
        task was ordered, if that was before now.

        Raises
        ------
        ParameterError
            if the event does not fit (see `Changes.apply`).
        """
        asked = len(self._asked)
        self._changes.apply(self._due_at_once(event), self.now_s, reason, came_s)
        if event.door is not None:
            self.forget_ways()
        if len(self._asked) == asked and event.robot_silent is None:
            self.emit(OtherEvent(kind="without_effect", content=plain(event)))

    def _due_at_once(self, event: Event) -> Event:
        """An order to a standing fleet that says not when it is due is due when it comes, where lateness counts."""
        task = event.new_task
        if task is None or task.due_s is not None or not self._standing.forgets or self._objective != "lateness":
            return event
        return replace(event, new_task=replace(task, due_s=self.now_s))

    def pause(self) -> None:
        """Let robots stop where they are; nothing is to be asked of this until `resume`."""
        for state in self._present:
            state.stand(self.now_s)

    def resume(self) -> None:
        """Let robots go on with work that they stopped; at the next tick those go on that were under way."""
        for state in self._present:
            if state.activity is Activity.WORKING:
                state.send_again(self.now_s)

    def take_out_unheard(self) -> None:
        """Let robots that have not said where they are take no part until they are heard, as silent ones."""
        for state in self._present:
            if state.port.telemetry() is None:
                self._changes.exclude(state, RobotSilent, self.now_s)

    def require_room(self, event: Event) -> None:
        """Raise ParameterError where an event brings a robot that cannot join, or puts one where it cannot stand.

        The port of one that joins need not be there yet.
        """
        if event.robot_joins is not None:
            self._changes.require_newcomer(event.robot_joins)
        elif event.robot_moved is not None:
            self._changes.require_place(event.robot_moved)
        elif event.robot_returns is not None:
            self._changes.require_return(event.robot_returns)

    def report_if_it_fits(self, event: Event, reason: str = "", came_s: float | None = None) -> bool:
        """As `report`, but an event that does not fit is refused, with the event `event_refused`."""
        try:
            self.report(event, reason, came_s)
        except ParameterError as error:
            self.emit(EventRefused(event=plain(event), reason=str(error)))
            return False
        return True

    def plan_again(self, cause: ExecutionEvent) -> None:
        """Have the rest planned again at the next tick, because of something that is known elsewhere."""
        self._ask(cause)

    def refuse(self, robot: str, task: str, reason: str) -> None:
        """Note that a robot cannot do an open task, as is known before it is sent there: others do it, if they can."""
        if robot in self.crew and self.ledger.is_open(task) and robot not in self.ledger.refusals.get(task, {}):
            self._ask(TaskRefused(task=task, robot=robot, reason=reason))

    def forget_ways(self) -> None:
        """Forget what was found of ways: they are others from now on."""
        self._forecast.forget()
        self._energy.forget_ways()

    def go_other_ways(self, robots: Collection[str]) -> None:
        """Ways of robots under way turn out to be closed: they go by others, and stop where there are none.

        The rest is planned again where that costs much.
        """
        for name in robots:
            state = self.crew[name]
            if state.out or state.activity not in MOVING:
                continue
            before_m = state.way_left_m
            longer_m = self._dispatch.go_other_ways(state, self.now_s)
            if longer_m is None:
                self._changes.leave_way(state, self.now_s)
            if longer_m is None or longer_m > MUCH_LONGER * (before_m + MUCH_LONGER_M):
                self._ask(WayClosed(robot=name, longer_m=None if longer_m is None else round(longer_m, 3)))

    def end_elsewhere(self, task: str, robots: Sequence[str]) -> bool:
        """Robots have done a task, as others say; return whether that is new. Work of the crew on it continues."""
        at_work = any(state.activity is Activity.WORKING and state.route[0] == task for state in self.crew.values())
        if is_new := not at_work and task not in self.ledger.ends_s:
            self.emit(DoneElsewhere(task=task, robots=tuple(robots)))
        return is_new

    def break_off(self, task: str) -> None:
        """Robots elsewhere have left a task that they and the crew had begun together: the crew leaves it too."""
        robots = [state.robot.id for state in self.crew.values() if state.route[:1] == [task]]
        for name in stop_work(self.crew, self.ledger, task, self.now_s):
            self._ask(WorkBrokenOff(task=name, robot=robots[0]))

    def tick(self, now: float) -> Sequence[ExecutionEvent]:
        """Go on to a time, not before the last, in seconds; returns what happened.

        To be called once at the beginning and after each step of the world, or whenever telemetry may have come.
        """
        first = self.events.total
        self.set_clock(now)
        self._hear()
        for state in self._present:
            self._dispatch.advance(state, now)
        for state in self._present:
            state.note_energy()
        self._follow_script()
        self._supervisor.look(now)
        self._look_at_energy()
        self._punctuality.look(now)
        self._go_on()
        self._get_on()
        self._improve()
        self._forget()
        self._end_if_over()
        return self.events.since(first)

    def set_clock(self, now: float) -> None:
        """Advance the clock without reading telemetry: reports and orders that follow happen at this time."""
        before_s = self.now_s
        self._set_clock(now)
        self._punctuality.count_waits(now - before_s)

    def come_to(self, now: float) -> None:
        """Advance the clock as `set_clock` does, and let what is due by then happen."""
        self.set_clock(now)
        self._follow_script()

    def pass_over(self, now: float) -> None:
        """Advance the clock over a pause: robots had nothing to do meanwhile, and count as neither busy nor stuck."""
        self._set_clock(now)
        for state in self.crew.values():
            state.since_s = state.nearest_s = now
        self._supervisor.pass_over(now)

    def _set_clock(self, now: float) -> None:
        if now < self.now_s:
            raise ParameterError(f"now: {now:g}; expected at least {self.now_s:g}: time does not go back")
        self.now_s = now

    @property
    def _present(self) -> list[RobotState]:
        return [state for state in self.crew.values() if not state.out]

    def _hear(self) -> None:
        for state in self.crew.values():
            if (said := state.hear(self.now_s)) is not None:
                self._observer.on_telemetry(self.now_s, state.robot.id, said)
                if state.out in _ABSENT and not state.suspended:
                    self._changes.readmit(state, self.now_s)
                    self._dispatch.end_unheard(state)
                elif state.out == RobotStuck.kind and moves_again(state):
                    self._changes.readmit(state, self.now_s, "it moves again")

    def _look_at_energy(self) -> None:
        """Who is empty fails; who runs low is planned again."""
        for state in list(self._energy.empty()):
            self._changes.exclude(state, RobotFails, self.now_s, EMPTY)
        self._energy.look(self.now_s)

    def _follow_script(self) -> None:
        """Let those events of the mission file, and orders, happen that are due."""
        for event in self._script.due(self.now_s):
            self.report_if_it_fits(event, came_s=event.at_s)

    def _script_after(self, time_s: float) -> Script:
        """What is to happen after a time: events of the mission file, and orders."""
        standing = self._standing
        return Script(
            self.mission.events,
            standing.orders,
            batch_s=standing.batch_s,
            since_s=time_s,
            until_s=standing.takes_orders_until_s,
        )

    @property
    def _on_duty(self) -> bool:
        """Whether it stays though all may be done, so that orders come."""
        return self.now_s < self._standing.stays_until_s

    @property
    def _objective(self) -> str:
        return self.planned.objective or self.mission.rules.objective

    def _capacity(self, state: RobotState) -> float | None:
        return None if "capacity" in self.planned.ignored else state.capacity

    def _recall(self, used: Mapping[str, float]) -> None:
        """Robots keep the open tasks of their routes; all of them are planned again from the robots' positions."""
        at_work = [task for name, task in self.ledger.tasks.items() if self.ledger.at_work(name)]
        again = tuple(task.id for task in at_work if task.across_partition != AT_MOST_ONCE)
        self._ask(Resumed(how="from where robots stand", again=again, used=used))
        for robot in self.crew.values():
            robot.recall_known()
        if self.state.doors.known:
            self._changes.close_doors()

    def _get_on(self) -> None:
        """When no robot gets on, or has a task any more, see what another plan can do."""
        if not self._alone:
            return
        if self._deadlocks.look(self.now_s):
            self._go_on()
        left = self._deadlocks.left_out_to_try(self.state.left_out)
        if left and any(self._replan(self._rest()).routes.values()):
            self._ask(RobotsFree(left_out=tuple(left)))
            self._go_on()

    def _go_on(self) -> None:
        """Plan the rest again if that is due, and send robots on, until no robot refuses its task."""
        while True:
            if self._asked:
                self._plan_again()
            for state in self._present:
                self._dispatch.send_on(state, self.now_s)
            if not self._asked:
                return

    def _ask(self, cause: ExecutionEvent) -> None:
        """Have the rest planned again because of something that happens now."""
        self._asked.append(cause)
        self.emit(cause)

    def _rest(self, part: Part | None = None) -> RemainingMission:
        return remaining_mission_of(
            self.mission,
            self.planned,
            self.crew,
            self.ledger,
            self.now_s,
            self.stations,
            self.goods,
            on_duty=self._on_duty,
            part=part,
        )

    @collector_paused()
    def _plan_again(self) -> None:
        asked, self._asked = self._asked, []
        revision = self._with_orders([cause.task_id for cause in asked if isinstance(cause, NewTask)], asked)
        revision = self._replan(self._rest()) if revision is None else revision
        self._adopt(revision, [{"kind": cause.kind, **cause.data} for cause in asked])

    def _with_orders(self, orders: Sequence[str], asked: Sequence[ExecutionEvent]) -> Revision | None:
        """New orders put into routes of robots near them, if nothing else has happened; None: that is not enough."""
        if not isinstance(self._replan, Insertion) or len(orders) < len(asked) or self.mission.stations:
            return None
        part = self._near.part(orders)
        revision = None if part is None else self._replan(self._rest(part))
        return None if revision is None or revision.left_out else replace(revision, is_part=True)

    def _adopt(self, revision: Revision, causes: Sequence[Mapping[str, Any]]) -> None:
        """Go on by a new plan of the rest."""
        for state in self._present:
            robot = state.robot.id
            if robot in revision.routes or not revision.is_part:
                calls = revision.calls.get(robot, ())
                self._dispatch.take_route(state, revision.routes.get(robot, ()), self.now_s, calls)
        for state in self.crew.values():
            if state.out:
                state.route = []
        known = self.state.left_out
        fresh = revision.left_out.keys() - known.keys() - set(revision.dropped)
        left_out = {task: why for task, why in revision.left_out.items() if task in fresh}
        self._dispatch.ahead = {**self._dispatch.ahead, **revision.ahead} if revision.is_part else revision.ahead
        self._punctuality.expect(self._forecast, self.now_s)
        self.revisions.append(revision)
        self.emit(Replanned(causes=tuple(causes), **revision.difference(), left_out=left_out))
        if revision.is_part:
            routes = {name: tuple(self.crew[name].route) for name in revision.routes}
            why = {**dict.fromkeys(revision.added), **revision.left_out}
            self.state.apply(PlanAdopted(routes=routes, left_out=why).at(self.now_s))
            self._observer.on_plan(self.now_s, self.plan)
            return
        plan = whole_plan(self.mission, self.planned, self.crew, self.ledger, revision.left_out)
        self.state.apply(PlanAdopted.of(plan, self.state).at(self.now_s))
        self._observer.on_plan(self.now_s, plan)

    @property
    def _improvement_due_s(self) -> float:
        return math.inf if self._standing.improver is None else self._standing.improver.due_s

    def _improve(self) -> None:
        """Take over routes that a search in the background has found, and let it search on if the plan has changed."""
        improver = self._standing.improver
        if improver is None:
            return
        found = improver.found(self.now_s)
        better = self._better(found) if found else None
        if better is not None:
            self._adopt(better, [{"kind": IMPROVED}])
            self._go_on()
        if (
            improver.due_s == math.inf
            and self.state.replanned != self._plans_searched
            and any(s.route for s in self._present)
        ):
            self._plans_searched = self.state.replanned
            improver.begin(self._rest())

    def _better(self, found: Mapping[str, Sequence[str]]) -> Revision | None:
        """Routes that a search has found, as far as they are worth it now; None: none is."""
        part = None if self.mission.stations else self._near.around(found)
        better = self._insertion.merged(self._rest(part), found)
        return better if better is None or part is None else replace(better, is_part=True)

    def _forget(self) -> None:
        """Of a standing fleet what is long done is forgotten."""
        if self._standing.forgets:
            self._forgetting.look(self.now_s)

    def _end_if_over(self) -> None:
        if self._on_duty:
            return
        if self._alone and not self.done and self.idle and not (self._may_bring_work or self._waits_for_absent):
            last = max((event.time_s for event in self.events), default=self.begun_s)
            ended_s = max([last, *(state.begun_s for state in self._present if state.done)])
            for task, reason in self.lost().items():
                self.emit(Lost(task=task, reason=reason))
            self.emit(MissionEnded(ended_s=ended_s))

    @property
    def _may_bring_work(self) -> bool:
        cut_off = any(state.cut_off for state in self._present)
        return self._script.may_bring_work(open_tasks=bool(self.ledger.open), cut_off=cut_off)

    @property
    def _waits_for_absent(self) -> bool:
        """Whether tasks are left, and a robot that may come back is not gone for long."""
        absent = [state.known.out_s for state in self.crew.values() if state.out in _ABSENT]
        return bool(self.ledger.open) and self.now_s < max(absent, default=-math.inf) + self._limits.absent_for_s

    @property
    def _worked(self) -> list[RobotState]:
        """Robots that take part and have done something, or are at it."""
        return [state for state in self._present if state.done or state.activity is not Activity.IDLE]

    @property
    def account(self) -> Account:
        """What it took, so far or in all."""
        over_s = self.now_s if self.state.ended_s is None else self.state.ended_s
        return Account(
            objective=self._objective,
            objective_planned=self.planned.objective_value,
            ledger=self.ledger,
            lost=self.lost(),
            robots={name: robot_row(state, self.usage_planned.get(name, 0.0)) for name, state in self.crew.items()},
            planned_so_far={name: planned_so_far(state) for name, state in self.crew.items()},
            mission_time_s=over_s - self.begun_s,
            reallocations=self.state.replanned,
            orders=self.orders.report(self.now_s - self.begun_s, self._script.not_taken_from_s, self.clock_lag),
            overtime_s=overtime_s(self._worked, self.now_s),
            traffic=self.traffic.with_waits(self.state.traffic),
            waits_s=self._punctuality.waits_s,
            back_s=back_s(self._worked) if self.mission.rules.makespan_includes_return else (),
        )

    def lost(self) -> dict[str, str]:
        """Every task that is not done, and why; before the end: that is not done yet and in no route."""
        under_way = {name for state in self._present for name in state.route}
        why = self.state.left_out
        return self.ledger.lost(lambda task: why.get(task, "left out by the plan"), self.state.gone, under_way)

    @property
    def begun_s(self) -> float:
        """When the mission began."""
        return self.now_s if self.state.begun_s is None else self.state.begun_s

    def emit(self, event: ExecutionEvent) -> None:
        """Apply an event that happens now, keep it, and tell the observer."""
        event = event.at(self.now_s)
        self.state.apply(event)
        self.events.append(event)
        self._observer.on_event(self.now_s, event.kind, event.data)
