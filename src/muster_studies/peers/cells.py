"""The cells of a comparison: the mean, the worst and the ratio of a solver's values, or why there is none."""

from __future__ import annotations

from muster_studies.peers.contest import Result, Standing
from muster_studies.tables import Cell, Notes


def mean_cell(standing: Standing, notes: Notes) -> Cell:
    """The mean over seeds where all do the same tasks, else that of the worst; a fault as a note."""
    if standing.fault is not None:
        return fault_cell(standing.fault, notes)
    if not standing.same_tasks:
        return worst_cell(standing)
    return _cell(standing.mean, standing.results[0])


def fault_cell(fault: str, notes: Notes) -> Cell:
    """Nothing where the mission cannot be expressed, which the legend tells; else what went wrong, with a note."""
    if fault.startswith("no prerequisites"):
        return None
    return f"{fault.split(':')[0]} {notes.number(fault)}" if ":" in fault or fault.startswith("claims") else fault


def worst_cell(standing: Standing) -> Cell:
    if standing.fault is not None:
        return None
    return _cell(standing.worst.value, standing.worst)


def _cell(value: float, result: Result) -> Cell:
    """The value; with what is done where that is not all."""
    if result.tasks == result.tasks_total:
        return value
    weight = "" if result.weight == result.tasks else f", weight {result.weight:g}"
    return f"{value:.3f} ({result.tasks} tasks{weight})"


def ratio_cell(standing: Standing, own: Standing) -> Cell:
    if standing.fault is not None or own.fault is not None or own.mean == 0:
        return None
    if not (standing.same_tasks and own.same_tasks) or standing.worst.weight != own.worst.weight:
        return "less done" if standing.worst.weight < own.worst.weight else "more done"
    return standing.mean / own.mean
