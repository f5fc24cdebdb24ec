"""A plan carried out in a world: executor and world wired together, as neither knows the other."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from muster.execution import Executor, Reallocation, report_of, travel_of, way_of
from muster.execution.doing import acted
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.motion.port import Telemetry
from muster.motion.roads import Roads
from muster.simulation import NO_NOISE, KinematicWorld, Noise

if TYPE_CHECKING:
    from muster.execution.report import Report
    from muster.motion.grid import Floats

LOOK_S = 0.5
"""Seconds of mission time between two looks at the robots, where nothing happens before."""


class Recorder(Protocol):
    """Who keeps what happens; see `muster.report.record.RecordWriter`."""

    def on_plan(self, now: float, plan: Plan) -> None: ...
    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None: ...
    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None: ...
    def on_report(self, report: dict[str, Any]) -> None: ...


@runtime_checkable
class Listener(Protocol):
    """A recorder that hears, besides, what robots say of themselves; where they truly are is in the steps."""

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None: ...


class _Told:
    """Passes on what the executor tells."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._listener = recorder if isinstance(recorder, Listener) else None

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        self._recorder.on_event(now, kind, dict(data))
        for task, reason in data.get("lost", {}).items() if kind == "mission-ended" else ():
            self._recorder.on_event(now, "lost", {"task": task, "reason": reason})

    def on_telemetry(self, now: float, robot: str, telemetry: Telemetry) -> None:
        if self._listener is not None:
            self._listener.on_telemetry(now, robot, telemetry)

    def on_plan(self, now: float, plan: Plan) -> None:
        self._recorder.on_plan(now, plan)


def carry_out(
    mission: Mission,
    plan: Plan,
    *,
    seed: int = 0,
    dt_s: float = 0.1,
    avoidance: str = "orca",
    noise: Noise = NO_NOISE,
    speed: float | None = None,
    recorder: Recorder | None = None,
) -> Report:
    """Carry a plan out in the kinematic world, with the mission's events, until all robots are done.

    Parameters
    ----------
    seed
        of the world and of planning anew.
    dt_s
        step of the world in seconds.
    speed
        how many times as fast as the wall clock; None: as fast as it goes.

    Raises
    ------
    ParameterError
        if the plan names what the mission does not have, or a parameter is out of range.
    """
    roads = Roads.of(mission) if mission.travel_rule == "map" else None
    travel = travel_of(mission, roads)
    world = KinematicWorld(
        mission,
        seed=seed,
        dt_s=dt_s,
        avoidance=avoidance,
        noise=noise,
        observer=None if recorder is None else recorder.on_step,
        observe_s=0.0 if recorder is None else 0.1,
    )
    executor = Executor(
        mission,
        plan,
        world.ports,
        doing=acted,
        way=way_of(mission, roads),
        travel=travel,
        replan=Reallocation(travel=travel, seed=seed),
        observer=None if recorder is None else _Told(recorder),
        now=world.time_s,
    )
    ahead = sorted(mission.events, key=lambda event: event.at_s)
    begin = time.monotonic()
    executor.tick(world.time_s)
    while not executor.done:
        world.advance(min([world.time_s + LOOK_S, *(event.at_s for event in ahead[:1])]))
        while ahead and ahead[0].at_s <= world.time_s + 1e-9:
            _happens(world, ahead.pop(0))
        executor.tick(world.time_s)
        if speed is not None:
            time.sleep(max(0.0, begin + world.time_s / speed - time.monotonic()))
    report = report_of(executor, contacts=len(world.contacts), min_distance_m=world.min_distance_m)
    if recorder is not None:
        recorder.on_report(report.as_dict())
    return report


def _happens(world: KinematicWorld, event: Event) -> None:
    """What an event does to bodies; what it does to the plan is the executor's affair."""
    if event.robot_fails is not None:
        world.fail(event.robot_fails)
    elif event.robot_silent is not None:
        world.silence(event.robot_silent)
    elif event.robot_returns is not None:
        world.recover(event.robot_returns)
    elif event.robot_joins is not None:
        world.join(event.robot_joins)
