"""The function `carry_out` of the package: a plan carried out by real robots. Heavy modules are imported where used."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.request import require_mission
from muster.running.observed_run import ObservedRun, keywords_of_run
from muster.running.recorded import recorded

if TYPE_CHECKING:
    from muster.execution import Report
    from muster.execution.fleet import Fleet


def carried_out(mission: Mission, plan: Plan, fleet: Fleet | str, request: ObservedRun) -> Report:
    """Carry a plan out with real robots, in real time, to its end. The tasks left are planned again when robots fail.

    With `recover` robots are brought home, and no task is done.

    Parameters
    ----------
    fleet
        the robots, as a `muster.execution.fleet.Fleet`, which stays open; or the name of a registered fleet, which is
        opened with the `settings` of the request, and closed.
    request
        how the plan is carried out: the fields of `RunRequest` and `ObservedRun`, by name.

    Returns
    -------
    The report. A remark says if the record broke off, as on a full disk: the run goes on without it. Another one says
    if the map could not be written.

    Raises
    ------
    CutShortError
        if the plan was cut short, and that is not accepted.
    PlanError
        if a route enters an area that is closed to its robot.
    ParameterError
        if the plan names robots or tasks that the mission does not have, a robot has no port, or the mission's time is
        over; if another run on this machine commands the robots of a fleet that is named.
    """
    from muster.running.bring_home import brought_home
    from muster.running.live import carry_out_live

    require_mission(mission)
    request.require_place_of_map()
    plan.require_whole(accept_partial=request.accept_partial)
    remarks: list[str] = []
    request = request if request.halt else replace(request, halt=threading.Event())
    with (
        _opened(fleet, mission, request) as (robots, at_end),
        recorded(
            mission, request.record, request.observers, lambda error: remarks.append(f"no more is kept: {error}")
        ) as others,
    ):
        recorder = others if request.journal is None else request.journal.with_others(others)
        if request.recover:
            report = brought_home(mission, plan, robots, request)
        else:
            report = carry_out_live(mission, plan, robots, request, recorder=recorder)
            _note_last_order(request)
        at_end()
    return replace(report, remarks=(*report.remarks, *remarks))


def _note_last_order(request: ObservedRun) -> None:
    """Write what robots do at the end, of fleets that have that as a setting, unless they stay where they are."""
    at_end = getattr(request.settings, "at_end", "hold")
    if request.journal is not None and at_end != "hold" and not (request.halt and request.halt.is_set()):
        request.journal.on_last_order(at_end)


carry_out = keywords_of_run.with_fleet(carried_out)


@contextmanager
def _opened(fleet: Fleet | str, mission: Mission, request: ObservedRun) -> Iterator[tuple[Fleet, Callable[[], None]]]:
    """The robots that are commanded, and what is called when all is done."""
    if not isinstance(fleet, str):
        yield fleet, lambda: None
        return
    from muster.running.claimed_fleet import claimed_fleet

    assert request.halt is not None
    goes_on = request.recover or (request.journal is not None and request.journal.state is not None)
    with claimed_fleet(mission, request, request.halt, again=goes_on) as opened:
        yield opened
