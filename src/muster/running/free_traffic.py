"""How long a plan takes in free traffic: a simulated run without events, beside which reservation is judged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from typing import Any, Protocol

from muster.execution.reports.report import Report
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.running.observed_run import ObservedRun
from muster.running.run_request import RunRequest
from muster.traffic.names import FREE


class Trial(Protocol):
    """A `Simulation`."""

    @property
    def done(self) -> bool: ...

    @property
    def time_s(self) -> float: ...

    def advance(self, until_s: float) -> Sequence[Any]: ...

    def result(self) -> Report: ...

    def close(self) -> None: ...


def free_s(
    simulation: Callable[[Mission, Plan, ObservedRun], Trial],
    mission: Mission,
    request: RunRequest,
    plan: Plan,
    within_s: float,
) -> float:
    """Return the seconds that a plan takes in free traffic if nothing happens.

    Returns inf if it takes longer than `within_s`, a task is lost, or robots touch.
    """
    how = ObservedRun(traffic=FREE, dt_s=request.dt_s, seed=request.seed, ignore=request.ignore)
    with closing(simulation(replace(mission, events=()), plan, how)) as trial:
        while not trial.done and trial.time_s < within_s:
            trial.advance(within_s)
        report = trial.result()
    is_well = trial.done and not report.contacts and not report.tasks_lost
    return trial.time_s if is_well else math.inf
