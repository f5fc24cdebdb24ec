"""Simulates a mission that robots carry out without a central planner, one process per robot, in real time."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from muster.allocation.auctions.auction_terms import Terms
from muster.execution import Recorder, Report, report_of
from muster.execution.record import NoObserver
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.model.problem import Problem
from muster.running.camera_search import camera_search_for, with_found
from muster.running.observed_run import ObservedRun
from muster.running.recorded_world import recorded_world, with_tracking
from muster.running.state_estimation import EstimatedWorld, with_state_estimation
from muster.running.true_places import with_truth
from muster.traffic.names import RESERVE
from muster_team.network.keys import new_key
from muster_team.processes.process_reports import TeamSetup
from muster_team.processes.team import Team, timeouts_for
from muster_team.runs.robot_bodies import MOST_SPEED, RobotBodies
from muster_team.runs.robot_process import run_robot_process
from muster_team.runs.scanned_ground import ScannedGround
from muster_team.runs.team_log import TeamLog


def negotiate_and_carry_out(
    mission: Mission,
    request: ObservedRun,
    recorder: Recorder | None,
    *,
    method: str,
    terms: Terms,
    transport: str,
    limit_s: float,
) -> Report:
    """Let robots agree and execute their tasks, while the mission's events happen.

    The mission begins when all have agreed for the first time.

    Parameters
    ----------
    request
        its `speed` is at most 10, and 1 without one: messages travel in real time, so that the faster robots move, the
        longer communication takes in the mission's time. Its traffic is auto or free: nobody says which robot passes
        first.
    method, terms, transport
        as in `TeamSetup`.
    limit_s
        real seconds within which robots have to agree before the mission begins.

    Raises
    ------
    ParameterError
        if `speed` is larger, or traffic by reservation is asked for; as `ScannedGround`.
    MusterError
        if there is no agreement in time, or a robot cannot take part.
    """
    _refuse_request(mission, request)
    speed = request.speed
    with ExitStack() as stack:
        memory = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        ground = ScannedGround(mission) if request.unknown else None
        bodies = recorded_world(mission, request, recorder)
        if request.on_world is not None:
            request.on_world(bodies)
        how: dict[str, Any] = {"method": method, "terms": terms, "transport": transport}
        setup = setup_of(mission if ground is None else ground.mission, memory, speed or 1.0, **how)
        setup = setup if ground is None else replace(setup, ground=ground.known)
        log = TeamLog(setup.problem, recorder or NoObserver(), request.on_event or (lambda event: None), setup.late)
        robots = with_state_estimation(bodies, mission, pose=request.pose, localise=request.localise, seed=request.seed)
        robot_bodies = RobotBodies(mission, bodies, robots, setup, log, ground)
        camera_search = camera_search_for(
            mission,
            bodies,
            robots,
            noise=request.noise,
            seed=request.seed,
            on_look=request.on_look,
        )
        if camera_search is not None:
            stack.callback(camera_search.close)
            robot_bodies.camera_search = camera_search
        robot_bodies.team = stack.enter_context(Team(setup, robot_bodies.take_report))
        halt = request.halt or threading.Event()
        if ground is not None:
            ground.begin_in(bodies, robots, log)
        robot_bodies.await_agreement(limit_s, halt)
        while not halt.is_set() and not robot_bodies.over:
            robot_bodies.step(setup.speed)
        if ground is not None:
            ground.follow(over=True)
        if robot_bodies.over:
            log.end()
        report = report_of(log.account, contacts=len(bodies.contacts), min_distance_m=bodies.min_distance_m)
        report = replace(report, team=robot_bodies.watch.report())
        if isinstance(robots, EstimatedWorld):
            report = replace(report, remarks=(*report.remarks, robots.remark))
        report = with_truth(with_found(report, camera_search), mission, robot_bodies.true_places.done)
        report = with_tracking(report, bodies)
        report = report if ground is None else ground.with_all(report, robot_bodies.ways_closed)
        if recorder is not None:
            recorder.on_report(report.as_dict())
        if ground is not None and request.save_map is not None:
            ground.save(Path(request.save_map))
        return report


def _refuse_request(mission: Mission, request: ObservedRun) -> None:
    """Raise ParameterError for what robots cannot do without a centre, or not in real time."""
    speed, traffic = request.speed, request.traffic
    if speed is not None and speed > MOST_SPEED:
        raise ParameterError(f"speed: {speed:g}; expected at most {MOST_SPEED:g}, as robots talk in real time")
    if traffic == RESERVE:
        raise ParameterError(f"traffic: {traffic}; expected free: without a centre nobody plans for all")
    for event in mission.events:
        if event.door is not None:
            raise ParameterError(
                f"events: door {event.door}; expected none without a centre, where nobody tells of doors"
            )


def setup_of(
    mission: Mission, memory: Path, speed: float = 1.0, *, method: str, terms: Terms, transport: str
) -> TeamSetup:
    """Return the setup of the robots' processes, with those of robots that join later or restart."""
    whole = Problem.compile(mission.at_once(robots=mission.all_robots))
    return TeamSetup(
        problem=whole.ready(),
        terms=terms,
        key=new_key(),
        method=method,
        transport=transport,
        timeouts=timeouts_for(len(whole.robots)),
        late=frozenset(robot.id for robot in mission.newcomers),
        starts=_starts(mission.events),
        memory=memory,
        part=run_robot_process,
        speed=speed,
    )


def _starts(events: Sequence[Event]) -> dict[str, int]:
    """The number of starts of each robot that restarts after a failure."""
    failed, starts = set[str](), dict[str, int]()
    for event in sorted(events, key=lambda event: event.at_s):
        if (down := event.robot_fails or event.robot_removed) is not None:
            failed.add(down)
        elif event.robot_returns in failed and event.robot_returns is not None:
            failed.remove(event.robot_returns)
            starts[event.robot_returns] = starts.get(event.robot_returns, 1) + 1
    return starts
