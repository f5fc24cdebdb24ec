"""The work of verbs, done in this process."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.cli.whole_work import time_left_s
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.system.interrupts import ctrl_c_halts

if TYPE_CHECKING:
    from muster.allocation.stop import Progress, Stop
    from muster.execution import ExecutionEvent, Report
    from muster.library import MissionSummary
    from muster.planning.explaining import Possible
    from muster.planning.explaining.tables import Explanation
    from muster.planning.export_formats import ExportOptions, Files
    from muster.planning.request import Request
    from muster.planning.solving import Solution
    from muster.running.coordination import Coordination
    from muster.running.observed_run import ObservedRun
    from muster.verification import Verdict

OnLine = Callable[[float, str], None]
"""Gets what happens, with its time in seconds."""


def open_local(
    url: str | None, token_file: Path | None, say: Callable[[str], None], note: Callable[[str], None]
) -> AbstractContextManager[LocalBackend]:
    """Open this process as a backend, which needs nothing but `note`."""
    return nullcontext(LocalBackend(note))


class LocalBackend:
    """See `Backend`; `note` gets lines for -v."""

    def __init__(self, note: Callable[[str], None]) -> None:
        self._note = note

    def version(self) -> str:
        from muster.mission.system.installation import installed_version

        return installed_version()

    def missions(self) -> tuple[Sequence[Mapping[str, Any]], Sequence[Mapping[str, str]]]:
        from muster.library import mission_names, mission_path, mission_summary

        names = mission_names()
        folders = sorted({str(path.parent) for name in names if (path := mission_path(name))})
        self._note(f"{len(names)} missions in {', '.join(folders)}")
        found = [mission_summary(name) for name in names]
        return [asdict(entry) for entry in found], [_row(entry) for entry in found]

    def check(self, mission: Mission, ignore: Sequence[str], time_limit: float) -> Possible:
        from muster.planning.explaining import possible

        return possible(mission, ignored=ignore, time_limit=time_left_s(time_limit))

    def plan(self, request: Request, on_progress: Callable[[Progress], None] | None, interrupt: Stop) -> Solution:
        from muster.planning.solving import answer

        solution = answer(request, on_progress=on_progress, interrupt=interrupt)
        self._note(f"{solution.iterations} iterations in {solution.plan.elapsed_s or 0.0:.3f} s")
        return solution

    def kept(self, plan: Plan) -> str | None:
        return None

    def verify(self, mission: Mission, plan: Plan, ignore: Sequence[str], objective: str | None) -> Verdict:
        from muster.verification import verify

        return verify(mission, plan, ignore, objective)

    def explain(
        self, mission: Mission, plan: Plan, task: str | None, ignore: Sequence[str], file: str, time_limit: float
    ) -> Explanation:
        from muster.planning.explaining.tables import explained

        return explained(mission, plan, task, ignore, file, time_left_s(time_limit))

    def export(
        self, mission: Mission, plan: Plan, form: str, ignore: Sequence[str], options: ExportOptions, file: str
    ) -> Files:
        from muster.planning.exporting import exported
        from muster.verification.required import require_admissible

        return exported(mission, require_admissible(mission, plan, file, ignore), form, options, plan)

    def simulate(
        self, mission: Mission, plan: Plan | Coordination, request: ObservedRun, on_line: OnLine | None
    ) -> tuple[Report, float | None]:
        from muster.running.simulate import simulated
        from muster.state.words import DETAIL

        def report(event: ExecutionEvent) -> None:
            if on_line is not None and event.mark != DETAIL:
                on_line(event.time_s, event.line)

        with ctrl_c_halts() as halt:
            on_event = None if on_line is None else report
            # What is accepted of a plan is the verb's to check.
            here = replace(request, accept_partial=True, halt=halt, on_event=on_event)
            outcome = simulated(mission, plan, here)
        return outcome, outcome.mission_time_s if halt.is_set() else None


def _row(entry: MissionSummary) -> dict[str, str]:
    robots = "-" if entry.robots is None else str(entry.robots)
    return {"mission": entry.name, "robots": robots, "tasks": str(entry.tasks), "what it is": entry.description}
