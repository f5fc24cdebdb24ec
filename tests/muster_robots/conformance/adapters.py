"""A right adapter of robots in this process, in virtual time, and how it is broken: one fault for each clause."""

import math
import os
import threading
from contextlib import suppress
from dataclasses import replace

from muster.execution.fleet import Failure
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Settings, record, spec
from muster.mission.system.clock import VirtualClock
from muster.mission.value_types import Number, Text
from muster.motion.port import TranslatedPort
from muster.running.fleet_type import FleetType
from muster_robots.conformance.stand import Stand
from muster_robots.goal_fleet import GoalFleet, RobotPose

PLACES = {"r_0": (5.0, 1.0), "r_1": (5.0, 4.0)}
SPEED_MPS = 1.0
KEPT = []
"""Files that broken adapters leave open."""


@record
class YardSettings(Settings):
    """Where the robots are."""

    site: str = spec(Text(), "name of the site")
    arrival_m: float = spec(Number(minimum=0.01), "distance at which a way point counts as reached", default=0.2)


class Body:
    """A robot that drives straight to its goal."""

    def __init__(self, place):
        self.place, self.goal, self.silent, self.said, self.said_s = place, None, False, None, 0.0

    def drive(self, seconds):
        if self.goal is not None:
            left_m = math.dist(self.goal, self.place)
            share = 1.0 if left_m <= SPEED_MPS * seconds else SPEED_MPS * seconds / left_m
            self.place = tuple(a + (b - a) * share for a, b in zip(self.place, self.goal, strict=True))


class Yard:
    """Robots that live on, whoever is connected to them; a `RobotLink`."""

    def __init__(self):
        self.clock = VirtualClock()
        self.bodies = {name: Body(place) for name, place in PLACES.items()}
        self.orders, self._moved_s, self.until_s = [], 0.0, math.inf

    def renew(self, seconds):
        self.move()
        self.until_s = self.clock.now() + seconds

    def poses(self):
        self.move()
        now = self.clock.now()
        for body in self.bodies.values():
            if not body.silent:
                body.said, body.said_s = body.place, now
        return {name: self.pose(name, body) for name, body in self.bodies.items() if body.said is not None}

    def pose(self, name, body):
        return RobotPose(x=body.said[0], y=body.said[1], age_s=self.clock.now() - body.said_s, charge=0.9)

    def go(self, robot, to):
        self.order(robot, to.position[:2])

    def stop(self, robot):
        self.order(robot, None)

    def order(self, robot, goal):
        self.move()
        if self.bodies[robot].silent:
            raise TimeoutError(f"{robot} does not answer")
        self.orders.append((robot, goal))
        self.bodies[robot].goal = goal

    def silence(self, robot):
        self.bodies[robot].silent = True

    def wake(self, robot):
        self.bodies[robot].silent = False

    def move(self):
        now = self.clock.now()
        for body in self.bodies.values():
            body.drive(max(0.0, min(now, self.until_s) - self._moved_s))
            body.goal = body.goal if now < self.until_s else None
        self._moved_s = now


def opened(yard, mission, settings, fleet=GoalFleet):
    """Open the fleet of a yard as the right adapter does."""
    if settings.site != "yard":
        raise NetworkError(f"site: {settings.site}; expected yard")
    made = fleet(mission, yard, arrival_m=settings.arrival_m, clock=yard.clock, wait=yard.clock.advance)
    for robot, why in made.robots_not_ready().items():
        raise NetworkError(f"robot {robot}: {why}; expected its pose")
    return made, lambda: None


def stand_of(yard, *, fleet=GoalFleet, opens=None, **declared):
    """A stand for the adapter of a yard, with some of it replaced."""

    def open_yard(mission, settings, halt, again):
        return opened(yard, mission, settings, fleet)

    facts = {
        "abilities": ("ground", "holds", "returns", "battery", "resumes", "leased"),
        "settings": YardSettings,
        "claims": lambda settings: [f"robots of {settings.site}"],
        **declared,
    }
    kind = FleetType(name="yard", open=opens or open_yard, **facts)
    robots = tuple(Robot(id=name, position=place, speed_mps=SPEED_MPS) for name, place in PLACES.items())
    return Stand(
        kind=kind,
        settings=kind.settings(site="yard") if kind.settings is YardSettings else kind.settings(),
        mission=Mission(robots=robots, tasks=(Task(id="t", position=(6.0, 1.0)),)),
        lease_reach_m=30.0,
        idle=yard.clock.advance,
        silence=yard.silence,
        wake=yard.wake,
        watch=yard.clock.now,
        ends_s=0.05,
    )


def right():
    return stand_of(Yard())


def ports_changed(change):
    """A fleet whose ports are other ones: `change(port, fleet)` returns each."""

    class Changed(GoalFleet):
        def __init__(self, *given, **how):
            super().__init__(*given, **how)
            self.own = self.ports
            self.ports = {name: change(port, self) for name, port in self.ports.items()}

        def _poll(self):
            return self._with_own(super()._poll)

        def _deliver(self):
            return self._with_own(super()._deliver)

        def stop(self):
            return self._with_own(super().stop)

        @property
        def not_told(self):
            return [name for name, port in self.own.items() if port.is_due]

        def _with_own(self, act):
            changed, self.ports = self.ports, self.own if hasattr(self, "own") else self.ports
            try:
                return act()
            finally:
                self.ports = changed

    return Changed


def told(change):
    """A fleet whose telemetry is changed: `change(said, fleet)`."""
    return ports_changed(lambda port, fleet: TranslatedPort(port, lambda said: change(said, fleet)))


class Accepts:
    """The kind of any value."""

    filler, expected = "", "anything"

    def read(self, value, at, faults):
        return value

    def schema(self):
        return {}


@record
class LaxSettings(Settings):
    """Settings that are not checked."""

    site: str = spec(Accepts(), "name of the site", default="yard")
    arrival_m: float = spec(Number(minimum=0.01), "distance", default=0.2)


def accepts_any_setting():
    return stand_of(Yard(), settings=LaxSettings)


def raises_an_error_of_its_own_for_a_wrong_setting():
    yard = Yard()

    def opens(mission, settings, halt, again):
        if settings.site != "yard":
            raise KeyError(settings.site)
        return opened(yard, mission, settings)

    return stand_of(yard, opens=opens)


def claims_anew_each_time():
    asked = []
    return stand_of(Yard(), claims=lambda settings: asked.append(1) or [f"connection {len(asked)}"])


def connects_to_claim():
    return stand_of(Yard(), claims=lambda settings: KEPT.append(os.open(os.devnull, 0)) or ["robots of yard"])


def claims_nothing():
    return stand_of(Yard(), claims=lambda settings: [])


class LeavesAThread(GoalFleet):
    """Its thread goes on after it is closed."""

    def __init__(self, *given, **how):
        super().__init__(*given, **how)
        self.ended = threading.Event()
        threading.Thread(target=self.ended.wait, args=(2.0,), daemon=True, name="listener").start()


def leaves_a_thread():
    return stand_of(Yard(), fleet=LeavesAThread)


def leaves_a_file():
    class LeavesAFile(GoalFleet):
        def close(self):
            KEPT.append(os.open(os.devnull, 0))

    return stand_of(Yard(), fleet=LeavesAFile)


def opens_once():
    yard, before = Yard(), []

    def opens(mission, settings, halt, again):
        if len(before) > 1:
            raise NetworkError("port 14550: in use")
        before.append(mission)
        return opened(yard, mission, settings)

    return stand_of(yard, opens=opens)


def takes_unknown_robots():
    yard = Yard()

    def opens(mission, settings, halt, again):
        known = tuple(robot for robot in mission.robots if robot.id in PLACES)
        return opened(yard, replace(mission, robots=known), settings)

    return stand_of(yard, opens=opens)


def does_not_name_unknown_robots():
    yard = Yard()

    def opens(mission, settings, halt, again):
        if any(robot.id not in PLACES for robot in mission.robots):
            raise ParameterError("bad request")
        return opened(yard, mission, settings)

    return stand_of(yard, opens=opens)


def reports_in_its_own_frame():
    x, y = PLACES["r_0"]
    change = lambda said, _: replace(said, position=(said.position[0] - x, said.position[1] - y, 0.0))  # noqa: E731
    return stand_of(Yard(), fleet=told(change))


def reports_nothing_new():
    class Stuck(Yard):
        def pose(self, name, body):
            return replace(super().pose(name, body), age_s=self.clock.now())

    return stand_of(Stuck())


def stamps_by_another_clock():
    return stand_of(Yard(), fleet=told(lambda said, _: replace(said, time_s=said.time_s + 1.7e9)))


def reports_charge_in_percent():
    return stand_of(Yard(), fleet=told(lambda said, _: replace(said, charge=90.0)))


def says_arrival_at_once():
    return stand_of(Yard(), fleet=told(lambda said, _: replace(said, passed=2)))


def does_not_go():
    class Deaf(Yard):
        def go(self, robot, to):
            pass

    return stand_of(Deaf())


def passes_without_holding():
    class Hasty(GoalFleet):
        """Leaves out what is to be done on the way."""

        def __init__(self, mission, link, **how):
            super().__init__(mission, link, **how)
            for port in self.ports.values():
                port.send = hasty(port.send)

    def hasty(send):
        return lambda waypoints: send([replace(waypoint, hold_s=0.0) for waypoint in waypoints])

    return stand_of(Yard(), fleet=Hasty)


def goes_on_with_the_order_before():
    class Queues(Yard):
        """A robot does one goal after the other."""

        def __init__(self):
            super().__init__()
            self.queued = {name: [] for name in PLACES}

        def order(self, robot, goal):
            if goal is None:
                self.queued[robot] = []
                return super().order(robot, goal)
            self.queued[robot].append(goal)
            return None

        def move(self):
            super().move()
            for name, goals in self.queued.items():
                body = self.bodies[name]
                if goals and (body.goal is None or math.dist(body.goal, body.place) < 0.01):
                    body.goal = goals.pop(0)

    class Back(Queues):
        """... and the one before is done once more."""

        def order(self, robot, goal):
            before = self.bodies[robot].goal
            super().order(robot, goal)
            if goal is not None and before is not None:
                self.bodies[robot].goal = goal
                self.queued[robot] = [before]

    return stand_of(Back())


def does_not_cancel():
    def change(port, fleet):
        class Port(TranslatedPort):
            def cancel(self):
                return port._follower.order

        return Port(port, lambda said: said)

    return stand_of(Yard(), fleet=ports_changed(change))


def does_not_stop():
    class GoesOn(GoalFleet):
        def stop(self):
            pass

    return stand_of(Yard(), fleet=GoesOn)


def sends_all_robots():
    class Together(Yard):
        def go(self, robot, to):
            x, y = to.position[0] - PLACES[robot][0], to.position[1] - PLACES[robot][1]
            for name, place in PLACES.items():
                self.order(name, (place[0] + x, place[1] + y))

    return stand_of(Together())


def freezes_fresh():
    class Frozen(Yard):
        def pose(self, name, body):
            return replace(super().pose(name, body), age_s=0.0)

    return stand_of(Frozen())


def raises_when_a_robot_is_silent():
    class Raises(Yard):
        def poses(self):
            found = super().poses()
            if any(body.silent for body in self.bodies.values()):
                raise RuntimeError("no such host")
            return found

    return stand_of(Raises())


def fails_when_a_robot_is_silent():
    class Fails(GoalFleet):
        def advance(self, until_s):
            super().advance(until_s)
            silent = [name for name, body in self._link.bodies.items() if body.silent]
            return [Failure(at_s=self.time_s, robot_fails=name, reason="no heartbeat") for name in silent]

    return stand_of(Yard(), fleet=Fails)


def waits_for_silent_robots():
    class Waits(Yard):
        def poses(self):
            found = super().poses()
            if any(body.silent for body in self.bodies.values()):
                self.clock.advance(5.0)
            return found

    return stand_of(Waits())


def gives_silent_robots_up():
    class GivesUp(Yard):
        def __init__(self):
            super().__init__()
            self.given_up = set()

        def poses(self):
            found = super().poses()
            self.given_up |= {name for name, body in self.bodies.items() if body.silent}
            return {name: pose for name, pose in found.items() if name not in self.given_up}

    return stand_of(GivesUp())


def drops_orders_after_silence():
    class Drops(Yard):
        def __init__(self):
            super().__init__()
            self.dropped = set()

        def silence(self, robot):
            super().silence(robot)
            self.dropped.add(robot)

        def order(self, robot, goal):
            if robot not in self.dropped:
                with suppress(TimeoutError):
                    super().order(robot, goal)

    return stand_of(Drops())


def begins_at_the_start_alone():
    yard = Yard()

    def opens(mission, settings, halt, again):
        for robot in mission.robots:
            body = yard.bodies.get(robot.id)
            if body is not None and math.dist(body.place, robot.position) > 0.5:
                raise ParameterError(f"{robot.id}: stands away from its start")
        return opened(yard, mission, settings)

    return stand_of(yard, opens=opens)


def reports_starts_when_it_is_opened_again():
    yard = Yard()

    def opens(mission, settings, halt, again):
        fleet, at_end = opened(yard, mission, settings, told(lambda said, _: shifted(said)) if again else GoalFleet)
        shift.clear()
        for robot in mission.robots:
            shift[robot.id] = robot.position
        return fleet, at_end

    shift = {}

    def shifted(said):
        return replace(said, position=(*PLACES["r_0"], 0.0))

    return stand_of(yard, opens=opens)


def goes_on_without_renewals():
    class Tireless(Yard):
        def renew(self, seconds):
            pass

    return stand_of(Tireless())


def stops_although_it_is_renewed():
    class Impatient(Yard):
        """Its robots take the order for what must be said again."""

        def renew(self, seconds):
            pass

        def order(self, robot, goal):
            super().order(robot, goal)
            self.until_s = self.clock.now() + 8.0

    return stand_of(Impatient())


def renews_itself():
    class Selfish(Yard):
        """Its server renews what Muster should."""

        def move(self):
            self.until_s = max(self.until_s, self.clock.now() + 10.0)
            super().move()

    return stand_of(Selfish())


def takes_no_orders_after_a_lease():
    class Locked(Yard):
        def order(self, robot, goal):
            super().order(robot, goal if self.clock.now() < self.stopped_s else None)

        def renew(self, seconds):
            if self.clock.now() > self.until_s:
                self.stopped_s = self.clock.now()
            super().renew(seconds)

        stopped_s = math.inf

    return stand_of(Locked())


BROKEN = {
    "settings": (accepts_any_setting, raises_an_error_of_its_own_for_a_wrong_setting),
    "claims": (claims_anew_each_time, connects_to_claim, claims_nothing),
    "opens": (leaves_a_thread, leaves_a_file, opens_once),
    "unknown": (takes_unknown_robots, does_not_name_unknown_robots),
    "poses": (reports_in_its_own_frame,),
    "times": (reports_nothing_new, stamps_by_another_clock),
    "charge": (reports_charge_in_percent,),
    "arrives": (says_arrival_at_once, does_not_go),
    "stays": (passes_without_holding,),
    "replaces": (goes_on_with_the_order_before,),
    "cancel": (does_not_cancel,),
    "stop": (does_not_stop,),
    "independent": (sends_all_robots,),
    "ages": (freezes_fresh,),
    "raises": (raises_when_a_robot_is_silent, fails_when_a_robot_is_silent),
    "prompt": (waits_for_silent_robots,),
    "again": (gives_silent_robots_up, drops_orders_after_silence),
    "restart": (begins_at_the_start_alone, reports_starts_when_it_is_opened_again),
    "lease": (
        goes_on_without_renewals,
        stops_although_it_is_renewed,
        renews_itself,
        takes_no_orders_after_a_lease,
    ),
}
"""Adapters by the clause that finds what they lack."""
