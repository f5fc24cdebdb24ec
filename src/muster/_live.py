"""A plan carried out by real robots, through any bridge, in real time: the executor and a fleet wired together."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from muster.bridges.fleet import Fleet, reason_of
from muster.execution import Executor, Observer, Reallocation, report_of, travel_of, way_of
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.roads import Roads

if TYPE_CHECKING:
    from muster.execution.executor import Happening
    from muster.execution.report import Report

LOOK_S = 0.2
"""Seconds between two looks at the robots, where nothing is heard before."""


def carry_out_live(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    *,
    seed: int = 0,
    observer: Observer | None = None,
    on_happening: Callable[[Happening], None] | None = None,
    halt: threading.Event | None = None,
) -> Report:
    """Let a fleet carry a plan out to its end, or until `halt` is set: then robots stop where they are.

    Parameters
    ----------
    fleet
        has a port for each robot of the mission, and stays open.
    seed
        of planning anew.
    observer
        is told all that happens, such as a record's writer.
    on_happening
        is told what happens, as it happens.

    Raises
    ------
    ParameterError
        if the plan names robots or tasks that the mission does not have, or a robot has no port.
    """
    roads = Roads.of(mission) if mission.travel_rule == "map" else None
    travel = travel_of(mission, roads)
    executor = Executor(
        mission,
        plan,
        fleet.ports,
        way=way_of(mission, roads),
        travel=travel,
        replan=Reallocation(travel=travel, seed=seed),
        observer=observer,
        now=fleet.time_s,
    )
    halt, told = halt or threading.Event(), 0
    executor.tick(fleet.time_s)
    try:
        while not executor.done and not halt.is_set():
            for event in fleet.advance(min(fleet.time_s + LOOK_S, executor.due_s)):
                executor.report_if_it_fits(event, reason_of(event))
            executor.tick(fleet.time_s)
            if on_happening is not None:
                for happening in executor.happenings[told:]:
                    on_happening(happening)
                told = len(executor.happenings)
    finally:
        if not executor.done:
            fleet.stop()
    return report_of(executor.account, contacts=0, min_distance_m=None)
