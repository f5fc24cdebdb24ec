"""The state of one robot during execution: its activity, its order, its telemetry and its usage.

The availability `a_i` of [tcf-thesis], 5.3.1: a robot is busy while it moves to a task or does it.
"""

from __future__ import annotations

import math
from collections.abc import Container, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import takewhile

from muster.execution.robots.robot_energy import RobotEnergy
from muster.execution.robots.station_calls import Call, next_call, without_tasks
from muster.execution.robots.task_motion import Work, along, path_length, place, travel_s
from muster.mission.model import Robot
from muster.model.robot_limits import NO_LIMITS, RobotLimits
from muster.motion.leg_times import LegTimes
from muster.motion.port import Place, RobotPort, Telemetry, Waypoint
from muster.state.robot_events import RobotFails, RobotRemoved
from muster.state.robots import KnownRobot

_ROUNDING_S = 1e-6


class Activity(Enum):
    """What a robot is doing."""

    IDLE = "idle"  # available
    DRIVING = "driving"  # to the first task of its route; an order may hold the work too
    WAITING = "waiting"  # at the task: for other tasks, for the clock, for its team ...
    WORKING = "working"
    RETURNING = "returning"  # to where its route ends
    TO_STATION = "driving to station"
    QUEUEING = "queueing"  # for a slot at a station, there or elsewhere
    SERVED = "served"  # at a station


MOVING = (Activity.DRIVING, Activity.WORKING, Activity.RETURNING, Activity.TO_STATION)


@dataclass
class RobotState:
    """Working state of one robot.

    Parameters
    ----------
    robot, known, port
        who it is, what is known of it by events, and how it is reached.
    home
        where its route must end; None: anywhere.
    times
        how long legs take it.
    in_time
        whether usage is time.
    route
        tasks that it is still to do, the current one first.
    calls
        at stations, on that route.
    energy
        what it holds; None: usage does not empty it.
    limits
        what rules ask of it, whatever it does.
    """

    robot: Robot
    known: KnownRobot
    port: RobotPort
    home: Place | None
    times: LegTimes
    in_time: bool
    last_heard_s: float
    route: list[str] = field(default_factory=list)
    calls: list[Call] = field(default_factory=list)
    energy: RobotEnergy | None = None
    limits: RobotLimits = NO_LIMITS
    station: str = ""  # where it is or goes to, on a call
    queued_s: float = 0.0  # since when it waits for a slot there, or did
    away: bool = False  # whether it waits for that where it is, not at the station
    service_s: float = 0.0  # how long its service takes
    visits: int = 0  # so often it was served at a station
    slot_wait_s: float = 0.0  # for so long it waited for slots
    refilled_idle: bool = False  # whether it has gone for energy of itself, and has done no task since
    out_at: Place | None = None  # where it was when it was out
    aside_until_s: float = -math.inf  # until when it stands aside for others in a jam
    rests_until_s: float = -math.inf  # until when it does not set out: its shift ends too soon, or its duty would
    activity: Activity = Activity.IDLE
    telemetry: Telemetry | None = None
    work: Work | None = None  # at state
    to_task: int = 0  # way points of the last order that lead to its task, or to where it goes without one
    works: bool = False  # whether the order holds the work too
    delay_s: float = 0.0  # that the current work was ordered with
    at_home: bool = True
    cut_off: bool = False  # whether it found no way to where its route ends
    begun_s: float = 0.0  # the activity
    wait_cause: str = ""  # of `beginning.Wait`, while it waits
    wait_words: str = ""
    work_s: float = 0.0  # how long the current work takes, delays included
    stayed: float = 0.0  # usage of works that ended, as far as it was not travelled
    used_before: float = 0.0  # usage at the end of the last task
    usage_to_task: float = 0.0  # from then to the end of the current task, as planned
    busy_s: float = 0.0
    since_s: float = 0.0  # up to when `busy_s` counts
    nearest_m: float = math.inf  # least way left of this order, and when it was reached, or it last waited in traffic
    nearest_s: float = 0.0
    nearest_at: Place = (math.inf, math.inf, math.inf)  # where it was then
    went_round: frozenset[str] = frozenset()  # robots that stand, on this way
    makes_room: bool = False  # whether it was last sent off the way of another
    sent_again: int = 0  # so often for want of progress, to the current goal
    warned_of: str = ""  # the task on the way to which its capacity was found too small
    warned_short: float = 0.0  # by how much its energy was found too little, on its route as it is
    left: Place | None = None  # the last place known to be free: a way point passed
    home_usage: float = 0.0  # from the exit of the current task to `home`, in the mission's unit
    home_s: float = 0.0  # at least, for the same
    unheard: tuple[int, int, str] | None = None  # order, way points, task of an order that held the whole work
    _order: int = 0
    _waypoints: tuple[Waypoint, ...] = ()

    @property
    def out(self) -> str:
        """The kind of the event after which it takes no part; empty if it does."""
        return self.known.out

    @property
    def done(self) -> list[str]:
        """The tasks that it did."""
        return self.known.done

    @property
    def available(self) -> bool:
        """Whether it can take a task: `a_i` of [tcf-thesis], 5.3.1."""
        return not self.out and self.activity in (Activity.IDLE, Activity.RETURNING)

    @property
    def call(self) -> Call | None:
        """Its next call, where that comes before its next task."""
        return next_call(self.route, self.calls)

    def rests(self, way_s: float, now: float) -> bool:
        """Whether it does not set out yet on a way of so many seconds, as a later shift lasts until its end."""
        begins = self.limits.set_out(now, way_s)
        if begins == math.inf or begins <= now + _ROUNDING_S:
            return False
        self.rests_until_s = begins
        return True

    def leave_out(self, gone: Container[str]) -> None:
        """Take tasks out of its route; the energy that it was to get before them it gets before the next."""
        self.route, self.calls = without_tasks(self.route, self.calls, gone)

    @property
    def position(self) -> Place:
        return self.telemetry.position if self.telemetry is not None else place(self.robot.position)

    @property
    def refuge(self) -> Place:
        """A place near by that is known to be free."""
        return self.left if self.left is not None else place(self.robot.position)

    @property
    def order(self) -> int:
        """The number of its last order."""
        return self._order

    @property
    def takes_orders(self) -> bool:
        """Whether it has accepted its last order."""
        return self._said is not None

    @property
    def _said(self) -> Telemetry | None:
        """What it last said, if that is of its last order."""
        return self.telemetry if self.telemetry is not None and self.telemetry.order == self._order else None

    @property
    def passed(self) -> int:
        """How many way points of the last order it has passed."""
        return 0 if self._said is None else self._said.passed

    @property
    def refused(self) -> str:
        """Why the robot will not reach the next way point of its last order; empty while it makes progress."""
        return "" if self._said is None else self._said.refused

    @property
    def suspended(self) -> str:
        """Why it takes no part for now, by its last telemetry; empty if it does."""
        return "" if self.telemetry is None else self.telemetry.suspended

    @property
    def arrived(self) -> bool:
        """Whether it has carried out the last order."""
        return self.passed >= len(self._waypoints)

    def note_unheard(self) -> None:
        """Remember the order that is replaced while it is not heard: it may be carried out all the same."""
        whole = self.works and self.route and self.activity in (Activity.DRIVING, Activity.WORKING)
        self.unheard = (self._order, len(self._waypoints), self.route[0]) if whole else None

    def take_done_unheard(self) -> str:
        """Return the task that it has done while it was not heard, once; empty if there is none."""
        told = None if self.telemetry is None else self.telemetry.carried_out
        if self.unheard is None or told is None or told[0] != self.unheard[0] or told[1] < self.unheard[1]:
            return ""
        task, self.unheard = self.unheard[2], None
        return task

    def recall(self, used: float) -> None:
        """Set its usage before the first telemetry, in the mission's unit."""
        said = self.port.telemetry()
        self.busy_s, self.stayed = used, used - (said.odometry_m if said is not None else 0.0)
        self.used_before = used

    def recall_known(self) -> None:
        """Take over what is known of the time before, of a robot that has taken part before."""
        if self.known.used is not None:
            self.recall(self.known.used)
        if (left := self.known.energy_left) is not None and self.energy is not None:
            self.energy.recall(*left)
        self.at_home = self.at_home and not self.done
        said = self.port.telemetry()
        if self.out and self.out not in (RobotFails.kind, RobotRemoved.kind) and said is not None:
            self.out_at = said.position

    def hear(self, now: float) -> Telemetry | None:
        """Its telemetry, if that is new."""
        if self.activity in MOVING and not self.out:
            self.busy_s += now - self.since_s
        self.since_s = now
        said = self.port.telemetry()
        if said is None or (self.telemetry is not None and said.time_s <= self.telemetry.time_s):
            return None
        self.telemetry, self.last_heard_s = said, now
        if self.passed:
            self.left = self._waypoints[self.passed - 1].position
        return said

    def send(
        self, now: float, activity: Activity, waypoints: Sequence[Waypoint], *, to_task: int | None = None
    ) -> None:
        """Order it to pass way points, of which so many lead to where it is to go: all of them, if None."""
        self._waypoints = tuple(waypoints)
        self.to_task = len(self._waypoints) if to_task is None else to_task
        self._order = self.port.send(self._waypoints)
        self.went_round, self.makes_room = frozenset(), False
        self.begin_activity(now, activity)

    def send_again(self, now: float) -> None:
        """Order what is left of the last order."""
        self._order_instead(now, self._waypoints[self.passed :], max(0, self.to_task - self.passed))

    @property
    def next_stop(self) -> Place:
        """The place of the next way point of its order that does not only mark a way. There must be one."""
        return self._waypoints[self.passed + self._marks_next].position

    def turn_off(self, now: float, way: Sequence[Waypoint], broken: str) -> None:
        """Order it to go another way round a robot to its next stop, and then what is left to do."""
        went_round, done = self.went_round | {broken}, self.passed + self._marks_next
        stop = self._waypoints[done]
        marks = along(way, stop.label)[:-1]
        self._order_instead(now, [*marks, *self._waypoints[done:]], self.to_task + len(marks) - done)
        self.went_round = went_round

    def go_other_ways(
        self, now: float, ways: Sequence[Sequence[Waypoint]], stops: Sequence[Waypoint] | None = None
    ) -> None:
        """Order it to pass stops by other ways, one to each, the stop included: by default what is left of its own."""
        stops = self.stops_left if stops is None else stops
        entry = self._waypoints[self.to_task - 1] if self.passed < self.to_task else None
        waypoints, to_task = list[Waypoint](), 0
        for stop, way in zip(stops, ways, strict=True):
            waypoints += [*along(way, stop.label)[:-1], replace(stop, speed_mps=way[-1].speed_mps)]
            if stop is entry:
                to_task = len(waypoints)
        self._order_instead(now, waypoints, to_task)

    @property
    def stops_left(self) -> list[Waypoint]:
        """The way points of the last order that it has not passed, without those that only mark a way."""
        return [waypoint for waypoint in self._waypoints[self.passed :] if not waypoint.via]

    def _order_instead(self, now: float, waypoints: Sequence[Waypoint], to_task: int) -> None:
        """Order it to pass other way points, with the same to do as before."""
        begun = self.begun_s
        self.send(now, self.activity, waypoints, to_task=to_task)
        self.begun_s = begun

    def stop(self, now: float) -> None:
        """Let it stop where it is, available. Work that is broken off counts as far as it went."""
        if self.activity is Activity.WORKING and self.work_s > 0:
            self.stayed += self._stayed_cost * min(1.0, (now - self.begun_s) / self.work_s)
        self._waypoints, self.to_task = (), 0
        self._order = self.port.cancel()
        self.work, self.away = None, False
        self.wait_cause = self.wait_words = ""
        self.begin_activity(now, Activity.IDLE)

    def put(self, at: Place) -> None:
        """Take it for where somebody has put it, a free place, until it says itself where it is."""
        self.at_home, self.left = False, at
        if self.telemetry is not None:
            self.telemetry = replace(self.telemetry, position=at)

    def stand(self, now: float) -> None:
        """Stop for a pause: a robot under way is sent again later, a robot at work keeps the rest of its work."""
        if self.activity is Activity.WORKING:
            self._waypoints = self._waypoints[self.passed :]
            self._order = self.port.cancel()
        elif self.activity in (*MOVING, Activity.SERVED):
            self.stop(now)

    def begin_activity(self, now: float, activity: Activity) -> None:
        """Go on to another activity under the same order."""
        self.activity, self.begun_s = activity, now
        self.nearest_m, self.nearest_s = math.inf, now

    @property
    def points_left(self) -> list[Place]:
        """The places of the last order that it has not passed; of those that mark a way none that it may leave out."""
        return [waypoint.position for waypoint in self._waypoints[self.passed + self._marks_left :]]

    @property
    def places_of_work(self) -> list[Place]:
        """The places of the last order from the entry of its task on."""
        return [waypoint.position for waypoint in self._waypoints[max(0, self.to_task - 1) :]]

    @property
    def way_left_m(self) -> float:
        """Metres of the last order that it has not travelled, by its own navigation where that tells them."""
        told = self._told_left_m
        if told is None:
            return path_length(self.position, self._waypoints[self.passed :])
        left = self._waypoints[self.passed + self._marks_next :]
        return told + path_length(left[0].position, left[1:]) if left else 0.0

    @property
    def steered(self) -> bool:
        """Whether traffic decides when it goes on, and tells how far it has to go."""
        return self._told_left_m is not None

    @property
    def _told_left_m(self) -> float | None:
        """Metres to the next place of its order that marks no way, where its own navigation tells them."""
        return None if self._said is None else self._said.left_m

    @property
    def _marks_left(self) -> int:
        """How many of the next places of its order mark a way only, where its own navigation chooses that."""
        return 0 if self._told_left_m is None else self._marks_next

    @property
    def _marks_next(self) -> int:
        """How many of the next places of its order mark a way only."""
        return sum(1 for _ in takewhile(lambda waypoint: waypoint.via, self._waypoints[self.passed :]))

    @property
    def used(self) -> float:
        """Usage so far, in the mission's unit: by odometry and work done, or by time under way."""
        return self.busy_s if self.in_time else self.stayed + (self.telemetry.odometry_m if self.telemetry else 0.0)

    def note_energy(self) -> None:
        """Note what it holds now."""
        if self.energy is not None and self.telemetry is not None:
            self.energy.hear(self.told_share, self.used, served=self.activity is Activity.SERVED)

    @property
    def capacity(self) -> float | None:
        """How much it can use in all, in the mission's unit: by its reports too, where the mission has no energy."""
        most = self.robot.work_capacity
        if most is None or self.told_share is None or self.energy is not None:
            return most
        return min(most, self.used + self.told_share * most)

    @property
    def told_share(self) -> float | None:
        """The share of its energy that is left, as it last reported; None if it does not."""
        return None if self.telemetry is None else self.telemetry.energy_left

    @property
    def share_left(self) -> float | None:
        """The share of its energy that is left, as the mission has it, else as it last reported; None: not known."""
        return self.told_share if self.energy is None else self.energy.share

    def service_left_s(self, now: float) -> float:
        """Seconds until its service at a station ends."""
        return max(0.0, self.begun_s + self.service_s - now) if self.activity is Activity.SERVED else 0.0

    def work_left_s(self, now: float) -> float:
        """Seconds until the work under way ends, if all goes well."""
        return max(0.0, self.begun_s + self.work_s - now) if self.activity is Activity.WORKING else 0.0

    def used_after(self, now: float) -> float:
        """Usage when the current task is done, in the mission's unit; without one, now."""
        if self.work is None:
            return self.used
        works = self.activity is Activity.WORKING
        if self.in_time:
            before = 0.0 if works else self.travel_left_s
            return self.used + before + (self.work_left_s(now) if works else self.work_s)
        way = self.way_left_m if works else self.travel_left_m + self.work.way_m
        return self.used + way + self._stayed_cost

    @property
    def travel_left_s(self) -> float:
        """Seconds to the entry of the current task, for a robot under way."""
        metres = self.travel_left_m
        if self.times.along_lanes:
            left = self._waypoints[self.passed : max(self.passed, self.to_task)]
            return self.times.under_way(travel_s(self.times, self.position, left), metres)
        if self.work is None:
            return self.times.rest_seconds(metres)
        here, entry = self.position, self.work.entry
        return self.times.rest_seconds(metres, abs(entry[2] - here[2]), math.dist(here, entry))

    @property
    def travel_left_m(self) -> float:
        """Metres to the entry of the current task."""
        work_m = self.work.way_m if self.works and self.work is not None else 0.0
        return max(0.0, self.way_left_m - work_m)

    def end_work(self) -> None:
        """The current work has ended: its cost is used up, as far as it was not travelled."""
        self.stayed += self._stayed_cost
        self.work = None

    @property
    def _stayed_cost(self) -> float:
        """Usage of the current work, by distance, that is not travelled."""
        return 0.0 if self.work is None else self.work.stayed_cost_m
