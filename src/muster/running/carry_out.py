"""The function `carry_out` of the package: a plan carried out by real robots. Heavy modules are imported where used."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.options import PlanningOptions
from muster.planning.request import require_mission
from muster.running.recorded import recorded
from muster.traffic.names import DEFAULT

if TYPE_CHECKING:
    import threading

    from muster.bridges.fleet import Fleet
    from muster.execution import ExecutionEvent, Recorder, Report, Standing
    from muster.mission.clock import Clock


def carry_out(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    *,
    seed: int = 0,
    accept_partial: bool = False,
    planning: PlanningOptions | None = None,
    ignore: str | Collection[str] = (),
    standing: Standing | None = None,
    traffic: str = DEFAULT,
    record: str | Path | None = None,
    observers: Sequence[Recorder] = (),
    on_event: Callable[[ExecutionEvent], None] | None = None,
    halt: threading.Event | None = None,
    starts: str = "given",
    wall: Clock | None = None,
) -> Report:
    """Carry a plan out with real robots, in real time, to its end. The tasks left are planned again when robots fail.

    Parameters
    ----------
    fleet
        the robots, behind a bridge of `muster.bridges`; stays open.
    seed
        of planning again.
    accept_partial
        whether a plan is carried out that was cut short.
    planning
        options with which the tasks left are planned again: allocator, parameters, `rewire`.
    ignore
        rules that do not hold, whatever the plan says of itself.
    standing
        for a fleet that stays on duty: until when, and for which orders.
    traffic
        who says which robot passes first: free, robots pass each other as they meet; reserve, in the order of one plan
        for all that drive; auto, reserve where the mission gives lanes, its map has passages for one robot, or robots
        at their ends can close others out of theirs.
    record
        a file (.mcap) for the record of the run; needs the extra `record`.
    observers
        receive every event and state, such as `muster.report.live.FoxgloveServer`.
    on_event
        is called with each event, as it happens.
    halt
        when it is set, by another thread or by `on_event`, robots stop where they are, and the run ends.
    starts
        "given": time 0 is the mission's `starts_at`, or now without one; "now": the mission starts now, all its times
        are shifted.
    wall
        the wall clock, by which the mission's clock goes; by default the machine's.

    Returns
    -------
    The report. A remark says if the record broke off, as on a full disk: the run goes on without it.

    Raises
    ------
    CutShortError
        if the plan was cut short, and that is not accepted.
    PlanError
        if a route enters an area that is closed to its robot.
    ParameterError
        if the plan names robots or tasks that the mission does not have, a robot has no port, or the mission's time is
        over.
    """
    from muster.running.live import carry_out_live

    require_mission(mission)
    plan.require_whole(accept_partial=accept_partial)
    remarks: list[str] = []
    with recorded(mission, record, observers, lambda error: remarks.append(f"no more is kept: {error}")) as recorder:
        report = carry_out_live(
            mission,
            plan,
            fleet,
            seed=seed,
            planning=planning,
            ignore=ignore,
            standing=standing,
            traffic=traffic,
            recorder=recorder,
            on_event=on_event,
            halt=halt,
            starts=starts,
            wall=wall,
        )
    return replace(report, remarks=(*report.remarks, *remarks))
