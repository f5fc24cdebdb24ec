"""What readers of a comparison's tables must know of single runs, in lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from muster.mission.texts.counting import counted
from muster_studies.comparison.run import Run


def cut_short_note(runs: Sequence[Run]) -> str:
    """Which allocators the time limit ended before they had come to all tasks; empty where none is."""
    counts = Counter(run.allocator for run in runs if run.cut_short)
    told = ", ".join(f"{name} {counted(count, 'run')}" for name, count in counts.items())
    return f"cut short by the time limit: {told}" if told else ""


def notes_without_plan(runs: Sequence[Run], allocators: Sequence[str]) -> list[str]:
    """A line for each allocator with runs that have no plan that counts: how many, and the first reason."""
    found = []
    for name in allocators:
        own = [run for run in runs if run.allocator == name]
        lost = [run for run in own if not run.is_done]
        if lost:
            kinds = ", ".join(f"{count} {status}" for status, count in Counter(run.status for run in lost).items())
            first = f"first {lost[0].mission}, seed {lost[0].seed}: {lost[0].reason}"
            found.append(f"{name}: {len(lost)} of {counted(len(own), 'run')} without a plan ({kinds}); {first}")
    return found
