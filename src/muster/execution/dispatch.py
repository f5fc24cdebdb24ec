"""Dispatch: sends each robot to its next task, to its work and to its end, and tracks its progress."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from muster.execution.deadlocks.way_round import way_aside, way_round
from muster.execution.peers import Gathering, Peers
from muster.execution.record import Tell
from muster.execution.robots.monitor import exceeds
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.robots.station_calls import Call, as_one, next_call
from muster.execution.robots.task_motion import Work, along, travel_s, work_of
from muster.execution.robots.work_orders import delayed, least_s, least_usage, stop_work, usage_home, work_for
from muster.execution.stations.energy_watch import EnergyWatch
from muster.execution.stations.slots import AT_STATION
from muster.execution.stations.station_service import StationService
from muster.execution.timing.beginning import Beginning
from muster.execution.timing.forecast import Forecast
from muster.mission.system.clock import TIME_ROUNDING_S
from muster.model.rules.team import waits_for_team, waits_to_start_with
from muster.motion.actions import Impossible
from muster.motion.port import Place, Waypoint
from muster.state import MissionState
from muster.state.mission_state import AT_MOST_ONCE
from muster.state.robot_events import NoWayToEnd, Returns, RobotAtEnd, RobotGoesRound, RobotMakesRoom
from muster.state.station_events import StationUnreachable
from muster.state.task_events import Arrives, Ends, SetsOut, Starts, TaskRefused, Waits


class Dispatch:
    """Sends robots to their next task, one robot a call.

    Parameters
    ----------
    known, crew
        the state of the mission; the robots.
    beginning
        says whether work may begin.
    capacity
        how much a robot can use; None: any amount.
    forecast
        says how long ways and works take, and when a robot leaves its start.
    emit, ask
        receive every event; those that ask for a new plan.
    peers
        the other robots, where they have a say: then a robot stops at its task and asks; None: the ledger alone says
        whether it may begin.
    """

    def __init__(
        self,
        known: MissionState,
        crew: Mapping[str, RobotState],
        beginning: Beginning,
        capacity: Callable[[RobotState], float | None],
        forecast: Forecast,
        emit: Tell,
        ask: Tell,
        peers: Peers | None = None,
    ) -> None:
        self._known, self._ledger, self._goods = known, known.ledger, known.goods
        self.service: StationService | None = None  # of missions with stations
        self.energy: EnergyWatch | None = None
        self._crew = crew
        self._beginning = beginning
        self._capacity = capacity
        self._forecast, self._plan_motion, self._way = forecast, forecast.plan_motion, forecast.way
        self._emit, self._ask = emit, ask
        self._peers = peers
        self.ahead: Mapping[str, Mapping[str, float]] = {}  # by the plan in force: see `Revision`

    def advance(self, state: RobotState, now: float) -> None:
        """Check whether a robot has arrived, or ended its work."""
        if self.service is not None:
            self.service.advance(state, now)
        if state.activity is Activity.DRIVING and state.passed >= state.to_task:
            self._arrive(state, now)
        if state.activity is Activity.WORKING and state.arrived:
            self._end_work(state, now)
        if state.activity is Activity.RETURNING and state.arrived:
            state.sent_again = 0
            state.begin_activity(now, Activity.IDLE)
            if not state.makes_room:
                state.at_home = True
                self._emit(RobotAtEnd(robot=state.robot.id))

    def send_on(self, state: RobotState, now: float) -> None:
        """Send a robot on that is available, or may begin; ask for a new plan if it cannot."""
        if now < max(state.aside_until_s, state.rests_until_s - TIME_ROUNDING_S):
            return
        if state.activity is Activity.WAITING:
            self._begin_or_wait(state, state.route[0], now)
        elif state.activity is Activity.QUEUEING and self.service is not None:
            self.service.serve_or_wait(state, now)
        elif (call := self._call_to_make(state, now)) is not None and self.service is not None:
            if not self._leaves_later(state, now):
                self.service.set_out(state, call, now)
        elif state.available and state.route and now >= state.robot.available_from_s:
            self._to_task(state, state.route[0], now)
        elif self.goes_home(state) and state.home is not None:
            self._send_home(state, state.home, now)

    def _call_to_make(self, state: RobotState, now: float) -> Call | None:
        """The station to which a robot goes next: by its plan, or of itself where it has nothing to do and is low."""
        if not state.available or now < state.robot.available_from_s:
            return None
        free = state.activity is Activity.IDLE and not state.route and not state.calls
        if free and self.energy is not None and (own := self.energy.own_call(state)) is not None:
            state.calls = [own]
        return state.call

    def _send_home(self, state: RobotState, home: Place, now: float) -> None:
        way = self.way(state, home)
        if way is None or (self.energy is not None and not self.energy.gets_home(state)):
            self.end_here(state, now)
        elif not state.rests(travel_s(state.times, state.position, along(way)), now):
            state.send(now, Activity.RETURNING, along(way))
            self._emit(Returns(robot=state.robot.id))

    def goes_home(self, state: RobotState) -> bool:
        """Whether a robot without tasks has yet to go where its route ends."""
        free = state.activity is Activity.IDLE and not state.route and not state.calls
        return free and not state.at_home and state.home is not None

    def end_here(self, state: RobotState, now: float) -> None:
        """A robot cannot get to where its route ends."""
        if state.activity is Activity.RETURNING:
            state.stop(now)
        state.at_home = state.cut_off = True
        self._emit(NoWayToEnd(robot=state.robot.id))

    def leave_station(self, state: RobotState, reason: str, now: float) -> None:
        """A robot cannot get to a station: nobody is sent there before ways open."""
        state.stop(now)
        self._ask(StationUnreachable(station=state.station, robot=state.robot.id, reason=reason))

    def again(self, state: RobotState, now: float) -> None:
        """Send a robot without progress once more, by a new path if it drives."""
        state.sent_again += 1
        if state.activity is Activity.WORKING:
            state.send_again(now)
        else:
            state.stop(now)

    def stand_aside(self, state: RobotState, until_s: float, now: float) -> None:
        """Let a robot under way stop for a while; without an order it makes room for others."""
        state.stop(now)
        state.aside_until_s = until_s

    def take_route(self, state: RobotState, tasks: Sequence[str], now: float, calls: Sequence[Call] = ()) -> None:
        """Give a robot another route; it goes on with its work, and with its order if that is for the same task.

        An order that holds work is none for a task that has meanwhile got more to wait for, such as one to begin with.
        """
        state.rests_until_s = -math.inf
        if state.activity is Activity.WORKING:
            state.route, state.calls = [state.route[0], *tasks], list(calls)
            return
        if state.activity in AT_STATION:
            self._take_route_at_station(state, tasks, calls, now)
            return
        first = next_call(tasks, calls)
        kept = state.route[:1] == list(tasks[:1]) and first is None and not self._begins_unasked(state)
        if state.activity in (Activity.DRIVING, Activity.WAITING) and not kept:
            state.stop(now)
        state.route, state.calls = list(tasks), list(calls)
        state.warned_of = state.warned_of if kept else ""

    def _take_route_at_station(
        self, state: RobotState, tasks: Sequence[str], calls: Sequence[Call], now: float
    ) -> None:
        """A robot that is served stays for it, and one on the way to a station where it is still to go goes on."""
        current, first = state.call, next_call(tasks, calls)
        is_next = first is not None and first.station == state.station
        own = current is not None and not current.planned and not tasks and not calls
        state.route, state.calls = list(tasks), list(calls)
        if current is not None and state.activity is Activity.SERVED and first is not None and is_next:
            state.calls = [as_one(current, first), *(call for call in calls if call is not first)]
            if self.service is not None:
                self.service.extend(state, now)
        elif current is not None and (state.activity is Activity.SERVED or own):
            state.calls = [replace(current, before=tasks[0] if tasks else None), *calls]
        elif current is None or not is_next:
            state.stop(now)

    def _begins_unasked(self, state: RobotState) -> bool:
        """Whether a robot on the way would begin its task at once, and the task must wait for more than it did."""
        return (
            state.activity is Activity.DRIVING and state.works and self._beginning.must_ask(state.route[0], state.robot)
        )

    def refuse(self, state: RobotState, task: str, reason: str, now: float) -> None:
        """A robot cannot do a task of its route."""
        self.leave(state, TaskRefused(task=task, robot=state.robot.id, reason=reason), now)

    def leave(self, state: RobotState, refused: TaskRefused, now: float) -> None:
        """Let a robot leave the task that it refuses; robots of its team that wait there stay."""
        if state.activity is Activity.WORKING:
            stop_work(self._crew, self._ledger, refused.task, now)
        elif state.activity is not Activity.IDLE:
            state.stop(now)
        self._ask(refused)

    def _leave_misfit(self, state: RobotState, task: str, reason: str, now: float) -> None:
        """A task does not fit what a robot has on board now: it may have it later, but not twice in vain."""
        robot = state.robot.id
        for_now = (robot, task) not in self._known.misfits
        self.leave(state, TaskRefused(task=task, robot=robot, reason=reason, for_now=for_now), now)

    def go_round(self, state: RobotState, standing: RobotState, now: float) -> bool:
        """Send a robot round one that stands; returns whether it has not tried that yet, and there is a way."""
        under_way = state.activity in (Activity.DRIVING, Activity.RETURNING, Activity.TO_STATION)
        if not under_way or standing.robot.id in state.went_round:
            return False
        others = [(one.position, one.robot.radius_m) for one in self._crew.values() if one.out and one is not standing]
        about, begin = (standing.position, standing.robot.radius_m), self._free_place(state)
        way = way_round(self._way, state.robot, begin, state.next_stop, about, others)
        if way is None:
            return False
        if begin != state.position:
            way = [Waypoint(begin), *way]
        state.turn_off(now, way, standing.robot.id)
        self._emit(RobotGoesRound(robot=state.robot.id, round=standing.robot.id))
        return True

    def make_room(self, state: RobotState, asker: RobotState, now: float) -> None:
        """Send a robot that has nothing to do off the way of another, where there is a place for it."""
        others = [(one.position, one.robot.radius_m) for one in self._crew.values() if one is not state]
        needed = [asker.position, *asker.points_left]
        way = way_aside(self._way, state.robot, state.position, needed, asker.robot.radius_m, others)
        if way is None:
            return
        state.send(now, Activity.RETURNING, along(way))
        state.at_home, state.makes_room = False, True
        self._emit(RobotMakesRoom(robot=state.robot.id, makes_room_for=asker.robot.id))

    def way(self, state: RobotState, goal: Place) -> Sequence[Waypoint] | None:
        """The way from where a robot is; by way of the last place known to be free, if it stands where it cannot."""
        found = self._way(state.robot, state.position, goal)
        begin = self._free_place(state) if found is None else state.position
        if begin == state.position:
            return found
        onward = self._way(state.robot, begin, goal)
        return None if onward is None else [Waypoint(begin), *onward]

    def go_other_ways(self, state: RobotState, now: float) -> float | None:
        """Send a robot under way to what is left of its stops by the ways that there are now.

        Returns
        -------
        by how many metres the way is longer than it was; None where there is none, and the robot keeps its order.
        """
        before, ways, at = state.way_left_m, list[Sequence[Waypoint]](), state.position
        for stop in state.stops_left:
            way = self._way(state.robot, at, stop.position) if ways else self.way(state, stop.position)
            if way is None:
                return None
            ways.append(way)
            at = stop.position
        state.go_other_ways(now, ways)
        return state.way_left_m - before

    def _free_place(self, state: RobotState) -> Place:
        """Where a robot is; the last place known to be free, if it stands where it cannot."""
        stands = self._way(state.robot, state.position, state.position) is not None
        return state.position if stands else state.refuge

    def _to_task(self, state: RobotState, task: str, now: float) -> None:
        work = work_of(self._ledger.tasks[task], state.robot, self._plan_motion, self._way, state.times)
        if isinstance(work, Impossible):
            self.refuse(state, task, work.reason, now)
            return
        way = self.way(state, work.entry)
        home = self._way_home(state, work)
        if way is None or home is None:
            reason = "there is no way" if way is None else "there is no way from it to the end of the route"
            self.refuse(state, task, f"unreachable: {reason}", now)
            return
        wrong = self._goods.refusal(self._ledger.tasks[task], state.robot) or self._aboard_too_long(state, task)
        if wrong:
            self._leave_misfit(state, task, wrong, now)
            return
        there = along(way, task)
        delay = self._ledger.delays_s.get(task, 0.0)
        lasts = work.lasts_s + delay
        home_usage, home_s = usage_home(state, work, home)
        least = least_usage(state, work, there, lasts) + home_usage
        if exceeds(least, self._capacity(state)):
            self.refuse(state, task, f"capacity: {least:.2f} used with it, of {self._capacity(state):.2f}", now)
            return
        state.work, state.work_s, state.delay_s = work, lasts, delay
        state.home_usage, state.home_s = home_usage, home_s
        way_s = travel_s(state.times, state.position, there)
        if state.rests(way_s, now) or self._leaves_later(state, now):
            state.work = None
            return
        late = self._too_late(state, task, now + least_s(state, state.position, there), leaves_s=now)
        if state.limits.set_out(now, way_s) == math.inf:
            late = state.limits.never("the way there")
        if late:
            state.work = None
            self.refuse(state, task, late, now)
            return
        may_begin = self._ledger.may_begin(task) and not self._beginning.must_ask(task, state.robot)
        state.refilled_idle = False
        once = self._ledger.tasks[task].across_partition == AT_MOST_ONCE  # its begin is known before work is ordered
        state.works = self._peers is None and may_begin and not once
        state.at_home = False
        state.usage_to_task = state.used - state.used_before + self._planned_usage(state, task)
        waypoints = [*there, *(delayed(work, delay) if state.works else ())]
        state.send(now, Activity.DRIVING, waypoints, to_task=len(there))
        self._emit(SetsOut(robot=state.robot.id, task=task, used=state.used))

    def _aboard_too_long(self, state: RobotState, task: str) -> str:
        """Why what a robot takes on board at a task of its route would be there for too long; empty: it would not."""
        model = self._ledger.model
        for delivery in model.soon_after([task]):
            if delivery in state.route and model.delivers(delivery, task):
                takes_s = self._forecast.between_s(state, task, delivery)
                if wrong := model.too_long_between(task, delivery, takes_s):
                    return wrong
        return ""

    def _leaves_later(self, state: RobotState, now: float) -> bool:
        """Whether a robot does not leave its start yet, as its duty would last too long."""
        if state.limits.lasts_most_s == math.inf or state.known.left_s is not None:
            return False
        leaves = self._forecast.leaves_s(state, now)
        if leaves <= now + TIME_ROUNDING_S:
            return False
        state.rests_until_s = leaves
        return True

    def _arrive(self, state: RobotState, now: float) -> None:
        task = state.route[0]
        state.sent_again = 0
        self._emit(Arrives(robot=state.robot.id, task=task, used=state.used))
        if state.works:
            self._begin(task, [state], (state.robot.id,))
            state.begin_activity(now, Activity.WORKING)
        else:
            state.begin_activity(now, Activity.WAITING)

    def _begin_or_wait(self, state: RobotState, task: str, now: float) -> None:
        """Begin a task, and those that begin with it, with all their robots; or say for what a robot waits."""
        if self._peers is not None and self._ledger.is_joint(task):
            self._begin_with_peers(state, task, self._peers, now)
            return
        wait = self._beginning.wait(task, now)
        if wait is not None:
            self._say_wait(state, task, wait.cause, wait.words)
            return
        unit = self._ledger.unit(task)
        if self._peers is not None and not self._peers.may_begin(task):
            return
        teams = {name: self._beginning.present(name) for name in unit}
        late = [(one, name, self._too_late(one, name, now)) for name, team in teams.items() for one in team]
        for one, name, reason in late:
            if reason:
                self.refuse(one, name, reason, now)
        if not any(reason for _, _, reason in late):
            for name, team in teams.items():
                self._work(name, team, now)

    def _begin_with_peers(self, state: RobotState, task: str, peers: Peers, now: float) -> None:
        """Tell the others that a robot is at a task that several begin; begin it when that is agreed."""
        self._count_delay(state, task)
        wait, earliest_s = self._beginning.wait(task, now), self._beginning.earliest_s(task, now)
        if wait is not None:
            self._say_wait(state, task, wait.cause, wait.words)
        if earliest_s == math.inf:
            return
        unit = self._ledger.unit(task)
        opens = partial(self._ledger.model.next_begin_s, unit)
        found = peers.gather(task, unit, earliest_s, state.work_s, opens)
        late = self._too_late(state, task, earliest_s if found.begin_s == math.inf else found.begin_s)
        if late:
            self.refuse(state, task, late, now)
        elif wait is None and found.absent:
            self._say_wait(state, task, *_words_for_absent(task, found.absent))
        elif found.begin_s <= now:
            peers.begin_together(task)
            self._work_with_peers(state, task, found, now)

    def _say_wait(self, state: RobotState, task: str, cause: str, words: str) -> None:
        said, state.wait_cause, state.wait_words = state.wait_words, cause, words
        if cause != "prerequisite" and words != said:
            self._emit(Waits(robot=state.robot.id, task=task, cause=cause, words=words))

    def _too_late(self, state: RobotState, task: str, begin_s: float, leaves_s: float | None = None) -> str:
        """Why a robot that is at a task at a time cannot do it, by its times and the robot's; else empty."""
        left_s = leaves_s if state.known.left_s is None else state.known.left_s
        return self._ledger.model.too_late(task, state.limits, begin_s, state.work_s, state.home_s, left_s)

    def _work(self, task: str, team: Sequence[RobotState], now: float) -> None:
        for state in team:
            self._count_delay(state, task)
        self._begin(task, team, tuple(state.robot.id for state in team))
        slowest = max(state.work_s for state in team)
        for state in team:
            work_for(state, slowest, now, stands=len(team) > 1)

    def _work_with_peers(self, state: RobotState, task: str, agreed: Gathering, now: float) -> None:
        """The robot's part of what several have agreed to begin."""
        self._begin(task, [state], agreed.team, agreed.begin_s)
        lasts_s = max(state.work_s, agreed.begin_s + agreed.lasts_s - now)
        work_for(state, lasts_s, now, stands=len(agreed.team) > 1)

    def _count_delay(self, state: RobotState, task: str) -> None:
        """The work takes longer by what the task was delayed since the robot set out."""
        delay = self._ledger.delays_s.get(task, 0.0)
        state.delay_s, before = delay, state.delay_s
        state.work_s += state.delay_s - before

    def _begin(
        self, task: str, team: Sequence[RobotState], robots: tuple[str, ...], from_s: float | None = None
    ) -> None:
        """Robots of the crew begin a task, of all the robots that do it."""
        for state in team:
            state.wait_cause = state.wait_words = ""
        routed = {name for state in self._crew.values() if not state.out for name in state.route}
        tell = self._ask if routed.intersection(self._ledger.model.alternatives(task)) else self._emit
        tell(Starts(task=task, robot=robots[0], team=_team(robots), used=self._used(robots[0]), from_s=from_s))

    def _used(self, robot: str) -> float | None:
        """The usage of a robot, if it is of the crew."""
        return self._crew[robot].used if robot in self._crew else None

    def _end_work(self, state: RobotState, now: float) -> None:
        """The work has ended, unless it was delayed meanwhile, or others of the team are still at it."""
        task = state.route[0]
        longer = self._ledger.delays_s.get(task, 0.0) - state.delay_s
        if longer > 0 and state.work is not None:
            begun = state.begun_s
            state.delay_s += longer
            state.work_s += longer
            state.send(now, Activity.WORKING, [replace(state.work.waypoints[-1], hold_s=longer, uses=0.0)])
            state.begun_s = begun
            return
        team = self._team_at_work(state, task)
        if not all(one.arrived and one.delay_s >= self._ledger.delays_s.get(task, 0.0) for one in team):
            return
        if self._peers is None or not self._ledger.is_joint(task) or self._peers.end_together(task):
            self._end_for_all(task, team, now)

    def _team_at_work(self, state: RobotState, task: str) -> list[RobotState]:
        """The robots of the crew that are at a task."""
        return [self._crew[name] for name in self._ledger.teams.get(task, (state.robot.id,)) if name in self._crew]

    def _end_for_all(self, task: str, team: Sequence[RobotState], now: float) -> None:
        robots = self._ledger.teams.get(task) or tuple(state.robot.id for state in team)
        for state in team:
            state.end_work()
        usage = sum(state.usage_to_task for state in team), sum(state.used - state.used_before for state in team)
        parts = {state.robot.id: (state.usage_to_task, state.used) for state in team} if len(robots) > 1 else {}
        for state in team:
            state.used_before = state.used
            state.route.pop(0)
            state.warned_short = 0.0
            state.begin_activity(now, Activity.IDLE)
        used = self._used(robots[0])
        self._emit(Ends(task=task, robot=robots[0], team=_team(robots), used=used, parts=parts, usage=usage))

    def end_unheard(self, state: RobotState) -> None:
        """Count a task that a robot has done while it was not heard, unless others are at it or have done it."""
        task, robot = state.take_done_unheard(), state.robot.id
        ledger = self._ledger
        if not task or not ledger.is_open(task) or ledger.at_work(task) or not ledger.may_begin(task):
            return
        usage = state.usage_to_task, state.used - state.used_before
        state.used_before = state.used
        self._emit(Arrives(robot=robot, task=task, used=state.used))
        self._begin(task, [state], (robot,))
        self._emit(Ends(task=task, robot=robot, used=state.used, usage=usage))

    def _planned_usage(self, state: RobotState, task: str) -> float:
        """What a task costs by the plan in force, from the task before it or from where that plan was made."""
        ahead = self.ahead.get(state.robot.id, {})
        before = state.done[-1] if state.done and state.done[-1] in ahead else ""
        return ahead.get(before, 0.0) - ahead.get(task, 0.0)

    def _way_home(self, state: RobotState, work: Work) -> list[Waypoint] | None:
        """The way from the exit of a task to where the route ends; None where there is none."""
        if state.home is None:
            return []
        way = self._way(state.robot, work.exit, state.home)
        return None if way is None else along(way)


def _team(robots: tuple[str, ...]) -> tuple[str, ...]:
    """The team, as events name it: where there are more robots than the first."""
    return robots if len(robots) > 1 else ()


def _words_for_absent(task: str, absent: Sequence[tuple[str, str]]) -> tuple[str, str]:
    """The cause of waiting for robots elsewhere, and the words for it."""
    own = [robot for robot, name in absent if name == task]
    if own:
        return "team", waits_for_team(", ".join(own))
    first = absent[0][1]
    return "start", waits_to_start_with(first, ", ".join(robot for robot, name in absent if name == first))
