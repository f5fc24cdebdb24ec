"""A mission carried out by robots that are processes, in a simulated world, at the pace of real time."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from muster.allocation.problem import Problem
from muster.execution import ExecutionEvent, Recorder, Report, report_of
from muster.execution.record import NoObserver
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.negotiation.keys import new_key
from muster.negotiation.methods import method_named
from muster.negotiation.process_reports import Order
from muster.negotiation.team import Team, patience_here
from muster.running.camera_search import OnLook, lookout_for, with_found
from muster.running.negotiated.robot_bodies import MOST_SPEED, Theatre
from muster.running.negotiated.robot_process import decide_for_itself
from muster.running.negotiated.team_log import Log
from muster.running.simulation import OnWorld
from muster.running.worlds import recorded_world
from muster.simulation import NO_NOISE, Noise


@dataclass(frozen=True, kw_only=True)
class Negotiation:
    """How robots agree.

    Parameters
    ----------
    method, transport
        names of METHODS and TRANSPORTS.
    params
        of the method's allocator; None: its own.
    limit_s
        real seconds within which they have to agree before the mission begins.
    """

    method: str = "auction"
    transport: str = "udp"
    params: Any = None
    limit_s: float = 60.0


def negotiate_and_carry_out(
    problem: Problem,
    negotiation: Negotiation,
    *,
    world: str = "kinematic",
    seed: int = 0,
    dt_s: float = 0.1,
    avoidance: str = "orca",
    noise: Noise = NO_NOISE,
    speed: float | None = None,
    recorder: Recorder | None = None,
    on_world: OnWorld | None = None,
    on_event: Callable[[ExecutionEvent], None] | None = None,
    halt: threading.Event | None = None,
    on_look: OnLook | None = None,
) -> Report:
    """Let robots agree, and carry out what they agree on, each for itself; the mission's events happen meanwhile.

    The mission begins when all have agreed for the first time.

    Parameters
    ----------
    problem
        what about, without robots that join later.
    speed
        how many times as fast as real time robots move, at most 10; None: once. They talk in real time: the faster
        they move, the longer their talk takes in the mission's time.
    others
        as `_carrying_out.carry_out` takes them.

    Raises
    ------
    ParameterError
        if robots are to move faster than that.
    MusterError
        if there is no agreement in time, or a robot cannot take part.
    """
    if speed is not None and speed > MOST_SPEED:
        raise ParameterError(f"speed: {speed:g}; expected at most {MOST_SPEED:g}, as robots talk in real time")
    with ExitStack() as stack:
        memory = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        bodies = recorded_world(
            world, problem.mission, recorder, seed=seed, dt_s=dt_s, avoidance=avoidance, noise=noise
        )
        if on_world is not None:
            on_world(bodies)
        order = order_of(problem, negotiation, memory)
        log = Log(order.problem, recorder or NoObserver(), on_event or (lambda event: None), order.late)
        theatre = Theatre(problem.mission, bodies, order, log)
        lookout = lookout_for(problem.mission, bodies, theatre.ports, noise=noise, seed=seed, on_look=on_look)
        if lookout is not None:
            stack.callback(lookout.close)
            theatre.lookout = lookout
        theatre.team = stack.enter_context(Team(order, theatre.hear))
        halt = halt or threading.Event()
        theatre.agree_first(negotiation.limit_s, halt)
        while not halt.is_set() and not theatre.over:
            theatre.go_on(1.0 if speed is None else speed)
        if theatre.over:
            log.end()
        report = report_of(log.account, contacts=len(bodies.contacts), min_distance_m=bodies.min_distance_m)
        report = with_found(report, lookout)
        if recorder is not None:
            recorder.on_report(report.as_dict())
        return report


def order_of(problem: Problem, negotiation: Negotiation, memory: Path) -> Order:
    """What the robots' processes are to do: robots that join, or start again, have theirs from the beginning, too."""
    mission = problem.mission
    joining = [event.robot_joins for event in mission.events if event.robot_joins is not None]
    whole = Problem.compile(mission.at_once(robots=(*mission.robots, *joining)), problem.objective, problem.ignored)
    method = method_named(negotiation.method)
    return Order(
        problem=whole.ready(),
        terms=method.allocator.parameters() if negotiation.params is None else negotiation.params,
        key=new_key(),
        method=negotiation.method,
        transport=negotiation.transport,
        patience=patience_here(len(whole.robots)),
        late=frozenset(robot.id for robot in joining),
        lives=_lives(mission.events),
        memory=memory,
        part=decide_for_itself,
    )


def _lives(events: Sequence[Event]) -> dict[str, int]:
    """How often those robots start that start again after they have failed."""
    failed, lives = set[str](), dict[str, int]()
    for event in sorted(events, key=lambda event: event.at_s):
        if event.robot_fails is not None:
            failed.add(event.robot_fails)
        elif event.robot_returns in failed and event.robot_returns is not None:
            failed.remove(event.robot_returns)
            lives[event.robot_returns] = lives.get(event.robot_returns, 1) + 1
    return lives
