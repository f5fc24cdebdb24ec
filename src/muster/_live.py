"""A plan carried out by real robots, through any bridge, in real time: the executor and a fleet wired together."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from muster._from_zero import FromZero
from muster.bridges.fleet import Fleet, reason_of
from muster.execution import Executor, Reallocation, Recorder, report_of, travel_of, way_of
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.port import RobotPort
from muster.motion.roads import Roads

if TYPE_CHECKING:
    from muster.execution import Happening, Report

LOOK_S = 0.2
"""Seconds between two looks at the robots, where nothing is heard before."""
ELSEWHERE_M = 0.5
"""Metres from where a mission says that a robot starts, from which it stands elsewhere."""


def carry_out_live(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    *,
    seed: int = 0,
    recorder: Recorder | None = None,
    on_happening: Callable[[Happening], None] | None = None,
    halt: threading.Event | None = None,
) -> Report:
    """Let a fleet carry a plan out to its end, or until `halt` is set; then robots stay where they are.

    The mission's clock begins now.

    Parameters
    ----------
    fleet
        has a port for each robot of the mission, and stays open.
    seed
        of planning anew.
    recorder
        is told all that happens, and where robots say that they are.
    on_happening
        is told what happens, as it happens.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a robot has no port.
    """
    fleet = FromZero(fleet)
    roads = Roads.of(mission) if mission.travel_rule == "map" else None
    travel = travel_of(mission, roads)
    executor = Executor(
        mission,
        plan,
        fleet.ports,
        way=way_of(mission, roads),
        travel=travel,
        replan=Reallocation(travel=travel, seed=seed),
        observer=recorder,
    )
    halt, told = halt or threading.Event(), 0
    try:
        while not halt.is_set():
            executor.tick(fleet.time_s)
            if recorder is not None:
                _tell_places(recorder, fleet.time_s, executor.crew, fleet.ports)
            if on_happening is not None:
                for happening in executor.happenings[told:]:
                    on_happening(happening)
                told = len(executor.happenings)
            if executor.done:
                break
            for event in fleet.advance(min(fleet.time_s + LOOK_S, executor.due_s)):
                executor.report_if_it_fits(event, reason_of(event))
    finally:
        fleet.stop()
    report = report_of(executor.account)
    if not executor.done:
        left = ", ".join(task.id for task in executor.ledger.open)
        report = replace(report, remarks=(*report.remarks, f"interrupted; not done: {left or 'the ways home'}"))
    if recorder is not None:
        recorder.on_report(report.as_dict())
    return report


def from_where_they_stand(mission: Mission, fleet: Fleet) -> Mission:
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
    """A line for each robot that does not stand where the mission says; `there` is by `from_where_they_stand`."""
    lines = []
    for says, stands in zip(mission.robots, there.robots, strict=True):
        far = math.dist(says.position[: len(stands.position)], stands.position)
        if far > ELSEWHERE_M:
            at, start = (", ".join(f"{c:.2f}" for c in robot.position) for robot in (stands, says))
            lines.append(f"robot {says.id} begins at ({at}), where it stands, not at ({start}): {far:.2f} m away")
    return lines


def _tell_places(recorder: Recorder, now: float, robots: Iterable[str], ports: Mapping[str, RobotPort]) -> None:
    """A step of a record, by what robots last said; NaN of those that were not heard."""
    rows = []
    for robot in robots:
        said = ports[robot].telemetry()
        rows.append([np.nan] * 7 if said is None else [*said.position, said.heading, *said.velocity])
    states = np.array(rows, dtype=float).reshape(-1, 7)
    recorder.on_step(now, states[:, :3], states[:, 3], states[:, 4:])
