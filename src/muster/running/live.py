"""A plan carried out by real robots, through any bridge, in real time: the executor and a fleet wired together."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from muster.execution import (
    Executor,
    Recorder,
    Status,
    compared_in_part,
    report_of,
    status_of,
    travel_of,
    way_of,
)
from muster.execution.fleet import Fleet, has_simulated_time, is_paused, limits_of, reason_of, refusals_of
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.supported_features import require_supported
from muster.mission.system.clock import Clock
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import RobotPort
from muster.running.fleet_clock import BeforeOrderAt, FleetWithMissionClock, clock_of, start_of
from muster.running.fleet_in_traffic import FleetInTraffic
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import HOLDS
from muster.running.mapped_ground import mapped_ground_for
from muster.running.observed_run import ObservedRun
from muster.running.replanning import planning_of
from muster.running.run_request import OPEN_FLEET, RunRequest
from muster.running.traffic_choice import manager_for
from muster.running.wall_time import MissionStart, has_time_limits, require_time_left
from muster.state import MissionState
from muster.state.ground_events import GroundUnknown
from muster.state.run_events import MissionBegins
from muster.traffic.names import FREE
from muster.verification.required import require_geometry, require_open_ways

if TYPE_CHECKING:
    from muster.execution import Report
    from muster.execution.standing import EventLog

LOOK_S = 0.2
"""Seconds between two looks at the robots, where nothing is heard before."""
LATE_S = 1.0
"""Seconds after its start from which a mission that begins is planned again."""
_WAIT_S = 10.0
"""Seconds for which maps are waited for where the settings of a fleet do not say how long robots are."""
ELSEWHERE_M = 0.5
"""Metres from where a mission says that a robot starts, from which it stands elsewhere."""
NAMED_AFTER_S = 1.5
"""Seconds after which robots that are waited for are named: less than 2, more than their discovery usually takes."""
_log = logging.getLogger(__name__)


def carry_out_live(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    request: ObservedRun | None = None,
    *,
    recorder: Recorder | None = None,
    before_order: BeforeOrderAt | None = None,
    **how: Any,
) -> Report:
    """Let a fleet carry a plan out to its end, or until `halt` is set; then robots stay where they are.

    The mission's clock is the wall clock, see `muster.running.wall_time`. Robots wait for a start that is to come.

    Parameters
    ----------
    fleet
        has a port for each robot of the mission, and stays open.
    request
        how the plan is carried out; without it the fields of `ObservedRun` are keyword arguments.
    recorder
        receives all events, and the positions that robots report.
    before_order
        as of `Live`; of a run with a journal that receives orders.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, a robot has no port, or the mission's time is
        over.
    """
    request = ObservedRun(**{"world": OPEN_FLEET, **how}) if request is None else request
    journal = request.journal
    live = Live(
        mission,
        plan,
        fleet,
        request,
        recorder=recorder,
        state=None if journal is None else journal.state,
        wall=request.wall,
        before_order=before_order if journal is None else journal.on_order,
    )
    halt, on_event, told = request.halt or threading.Event(), request.on_event, 0
    try:
        while not halt.is_set():
            live.look()
            if on_event is not None:
                for event in live.events.since(told):
                    on_event(event)
                told = live.events.total
            if live.done:
                break
            live.hear(live.time_s + LOOK_S)
    finally:
        live.stop()
    report = live.result()
    if request.save_map is not None:
        try:
            live.save_map(request.save_map)
        except OSError as error:  # robots have still to get their last orders
            report = replace(report, remarks=(*report.remarks, f"the map is not written: {error}"))
    return live.tell_report(report)


class Live:
    """A plan that is being carried out by real robots: telemetry is received, and the executor advanced, in turn.

    Parameters
    ----------
    fleet
        has a port for each robot of the mission, and stays open.
    request
        how the plan is carried out; without it the fields of `RunRequest` are keyword arguments.
    recorder
        receives all events, and the positions that robots report.
    state
        what is known of a mission that goes on after a stop.
    wall
        the wall clock; by default the machine's, or of a fleet with simulated time that clock alone.
    before_order
        receives each order before the robot does: when, whose, and its way points, none where the robot is to stay.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, a robot has no port, or the mission's time is
        over; as `MappedGround`.
    NetworkError
        if robots are to go by the maps that they tell, and one tells none that is tied to the mission's frame.
    """

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        fleet: Fleet,
        request: RunRequest | None = None,
        *,
        recorder: Recorder | None = None,
        state: MissionState | None = None,
        wall: Clock | None = None,
        before_order: BeforeOrderAt | None = None,
        **how: Any,
    ) -> None:
        request = ObservedRun(**{"world": OPEN_FLEET, **how}) if request is None else request
        seed = request.seed
        clock = clock_of(fleet, wall)
        zero_s = None if state is None else state.zero_s
        self.start = (
            start_of(mission, fleet, request.starts, wall) if zero_s is None else MissionStart.at(mission, zero_s)
        )
        mission, begin_s = self.start.mission, self.start.seconds(clock)
        ground = self._ground = mapped_ground_for(mission, fleet, request)
        if ground is not None:
            halt = getattr(request, "halt", None) or threading.Event()
            wait_for_robots(ground.fleet, halt, getattr(request.settings, "wait_s", _WAIT_S), "its map")
            mission = ground.mission
        if state is None:
            require_time_left(mission, begin_s)
            require_open_ways(mission, plan)  # later each robot stands anywhere, and a leg is checked when it is sent
        else:
            begin_s = max(begin_s, state.now_s)
        require_supported(mission)
        require_geometry(mission, "a run of real robots")
        self._kind = FLEETS.get(request.world)
        if self._kind is not None:
            self._kind.require_able(mission, resumes=state is not None)
        known_paths = RobotPaths.of(mission) if ground is None and mission.has_paths else None
        robot_paths = known_paths if ground is None else ground.paths
        traffic = request.traffic if ground is None and not self._lacks(HOLDS) else FREE
        world = None if robot_paths is None else robot_paths.world
        in_thread = not has_simulated_time(fleet)
        manager = manager_for(traffic, mission, seed=seed, world=world, real=True, in_thread=in_thread)
        managed = fleet if manager is None else FleetInTraffic(fleet, manager, mission)
        of_day = None if has_simulated_time(fleet) else clock
        self._fleet = FleetWithMissionClock(managed, begin_s, of_day, before_order)
        self._robots, self._recorder, self._stood = fleet, recorder, False
        travel = travel_of(mission, robot_paths)
        replan, self._standing = planning_of(mission, request.duty, request.planning, travel, seed, repeatable=False)
        way = way_of(mission, robot_paths)
        self.executor = Executor(
            mission,
            replace(plan, ignored=request.ignore),
            self._fleet.ports,
            way=way,
            travel=travel,
            replan=replan,
            observer=recorder,
            now=self._fleet.time_s,
            state=state,
            standing=self._standing,
            limits=limits_of(fleet),
            on_doors=lambda closed: None if manager is None else manager.close(closed),
            leader=manager,
        )
        for robot, task, reason in refusals_of(fleet, mission, plan, way):
            self.executor.refuse(robot, task, reason)
        if manager is not None:
            manager.expect(self.executor.outlook)
        if state is None:
            self._say_start(mission, begin_s)
        else:
            self._stop_those_sent()
        if ground is not None:
            self.executor.plan_again(GroundUnknown(cell_m=ground.cell_m))
            ground.begin(self._fleet.ports, self.executor)

    @property
    def state(self) -> MissionState:
        """What is known of the mission; to look at."""
        return self.executor.state

    @property
    def time_s(self) -> float:
        """The mission's clock; it goes on in a pause."""
        return self._fleet.time_s

    @property
    def done(self) -> bool:
        """Whether the mission is over."""
        return self.executor.done

    @property
    def events(self) -> EventLog:
        """All that has happened so far; of a standing fleet the last of it."""
        return self.executor.events

    @property
    def status(self) -> Status:
        """What each robot does now, and how far each task is."""
        return status_of(self.executor)

    def look(self) -> None:
        """See how far robots are, and send them on; before the mission's start, and in a pause, they stay."""
        if self._fleet.waits_s > 0 or is_paused(self._robots):
            self._stood = True
            self.tell_places()
            return
        if self._stood:
            self._stood = False
            self.executor.pass_over(self.time_s)
        self.executor.tick(self.time_s)
        self.executor.clock_lag.add(self.time_s - self.executor.now_s)
        if self._ground is not None:
            self._ground.look(self.executor.now_s)
        self.tell_places()

    def hear(self, until_s: float) -> None:
        """Send and receive until a time of the mission's clock, or until something is due."""
        for event in self._fleet.advance(min(until_s, self.executor.due_s)):
            if event.robot_joins is not None and event.robot_joins.id in self.executor.crew:
                continue  # it joined before a restart
            self.executor.report_if_it_fits(event, reason_of(event))

    def tell_places(self) -> None:
        """Tell the recorder where robots say that they are."""
        if self._recorder is not None:
            _tell_places(self._recorder, self.time_s, self.state.robots, self._fleet.ports)

    def tell_report(self, report: Report) -> Report:
        """Tell the recorder what it took, and return that."""
        if self._recorder is not None:
            self._recorder.on_report(report.as_dict())
        return report

    def pause(self) -> None:
        """Robots stop where they are until `resume`; the mission's clock goes on.

        Raises
        ------
        ParameterError
            if the fleet declares that its robots do not stop when they are told to.
        """
        if why := self._lacks(HOLDS):
            raise ParameterError(f"pause: not possible; expected a run whose robots hold: {why}")
        self.executor.pause()

    def resume(self) -> None:
        """Robots go on."""
        self.executor.pass_over(self.time_s)
        self.executor.resume()

    def stop(self) -> None:
        """Robots stay where they are, and nothing is searched for any more."""
        self._fleet.stop()
        if self._standing is not None and self._standing.improver is not None:
            self._standing.improver.close()

    def _lacks(self, ability: str) -> str:
        """Return why what needs an ability is refused; empty for a fleet that is open: it is not known by name."""
        return "" if self._kind is None else self._kind.lacks(ability)

    def _stop_those_sent(self) -> None:
        """Robots that the run before has sent off stay where they are until they are sent again: nobody led them.

        Who is not heard takes no part until it is.
        """
        for robot in self.executor.crew.values():
            if robot.known.left_s is not None:
                robot.stop(self.executor.now_s)
        self.executor.take_out_unheard()

    def _say_start(self, mission: Mission, begin_s: float) -> None:
        """Emit when the mission starts; begun late, what is left in time is planned again."""
        begins = MissionBegins(
            zero_s=round(self.start.zero_s, 6),
            starts_at=mission.starts_at,
            after_s=round(begin_s, 6),
            places={robot.id: (*robot.position, robot.heading_deg) for robot in mission.robots},
        )
        if begin_s > LATE_S and has_time_limits(mission):
            self.executor.plan_again(begins)
        else:
            self.executor.emit(begins)

    def result(self) -> Report:
        """What it took, so far or in all."""
        report = report_of(self.executor.account)
        if not self.done:
            left = ", ".join(task.id for task in self.executor.ledger.open)
            report = compared_in_part(report, self.executor.account)
            report = replace(report, remarks=(*report.remarks, f"interrupted; not done: {left or 'the ways home'}"))
        return report if self._ground is None else self._ground.with_ground(report)

    def save_map(self, file: str | Path) -> None:
        """Write the map that was merged of those of the robots; see `TeamGround.save`.

        Raises
        ------
        ParameterError
            if the robots have a map.
        """
        if self._ground is None:
            raise ParameterError(f"save_map: {file}; expected robots without a map")
        self._ground.save(Path(file))


class _Heard(Protocol):
    @property
    def ports(self) -> Mapping[str, RobotPort]:
        """See `Fleet`."""
        ...

    def robots_not_ready(self) -> Mapping[str, str]:
        """Robots of the mission that cannot be sent anywhere, and what is missing: "found; expected something"."""
        ...


def wait_for_robots(
    fleet: _Heard, halt: threading.Event, wait_s: float, needed: str = "its pose", *, some: bool = False
) -> None:
    """Wait until nothing is missing of the mission's robots, or `halt` is set.

    Where more time is given, each robot is named in a warning with what is missing after `NAMED_AFTER_S`, and again
    with what else is found to be missing later.

    Parameters
    ----------
    needed : str
        What is expected of a robot whose line in `robots_not_ready` does not say so.
    some : bool
        Whether those that are ready when the time is over are enough, as of a mission that is under way.

    Raises
    ------
    NetworkError
        if something is missing when the time is over.
    """
    begin, named = time.monotonic(), set[tuple[str, str]]()
    while (robots_not_ready := fleet.robots_not_ready()) and not halt.is_set():
        waited_s = time.monotonic() - begin
        if waited_s > wait_s:
            if some and len(robots_not_ready) < len(fleet.ports):
                return
            robot, why = next(iter(robots_not_ready.items()))
            found, _, expected = why.partition("; expected ")
            more = f" (and {len(robots_not_ready) - 1} more)" if len(robots_not_ready) > 1 else ""
            raise NetworkError(f"robot {robot}: {found} within {wait_s:g} s{more}; expected {expected or needed}")
        if waited_s > NAMED_AFTER_S:
            for robot, why in sorted(robots_not_ready.items() - named):
                _log.warning("robot %s: %s; it is waited for up to %g s", robot, why, wait_s)
            named |= robots_not_ready.items()
        time.sleep(0.05)


def with_reported_starts(mission: Mission, fleet: Fleet) -> Mission:
    """The mission with robots that start where they say that they are, and as they head; the others as it has them."""
    said = {robot.id: fleet.ports[robot.id].telemetry() for robot in mission.robots}
    robots = (
        replace(robot, position=there.position[: mission.dimensions], heading_deg=math.degrees(there.heading))
        if (there := said[robot.id])
        else robot
        for robot in mission.robots
    )
    return replace(mission, robots=tuple(robots))


def elsewhere(mission: Mission, there: Mission) -> list[str]:
    """A line for each robot that does not stand where the mission says; `there` is by `with_reported_starts`."""
    lines = []
    for says, stands in zip(mission.robots, there.robots, strict=True):
        far = math.dist(says.position[: len(stands.position)], stands.position)
        if far > ELSEWHERE_M:
            at, start = (", ".join(f"{c:.2f}" for c in robot.position) for robot in (stands, says))
            lines.append(f"robot {says.id} begins at ({at}), where it stands, not at ({start}): {far:.2f} m away")
    return lines


def _tell_places(recorder: Recorder, now: float, robots: Iterable[str], ports: Mapping[str, RobotPort]) -> None:
    """A step of a record, by the robots' last telemetry; NaN for robots without any."""
    rows = []
    for robot in robots:
        said = ports[robot].telemetry() if robot in ports else None
        rows.append([np.nan] * 7 if said is None else [*said.position, said.heading, *said.velocity])
    states = np.array(rows, dtype=float).reshape(-1, 7)
    recorder.on_step(now, states[:, :3], states[:, 3], states[:, 4:])
