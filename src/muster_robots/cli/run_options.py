"""What the verbs for real robots were asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from muster.planning.options import PlanningOptions
    from muster.running.observed_run import ObservedRun


@dataclass(frozen=True, kw_only=True)
class RealRunOptions:
    """The values of `real_robots.real_options`: the request of the run, and what is no part of it but the mission."""

    request: ObservedRun
    plan: Path | None
    planning: PlanningOptions
    start: Path | None = None
    fixed: Path | None = None
    record: Path | None
    html: Path | None
    plot: Path | None
    gantt: Path | None
    foxglove: int | None
    require_complete: bool
    form: str
    quiet: bool
    verbose: bool
    resume: str | None = None
