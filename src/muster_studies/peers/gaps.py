"""Gaps to a reference, in per cent: the cells and columns of solvers, and the mean over missions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import fmean

from muster_studies.peers.contest import OWN, PEERS, Result, Standing
from muster_studies.tables import Cell, Notes

Gap = Callable[[Result, float], float | str]
"""How far a plan is behind a reference, in per cent; a word where they cannot be compared."""


def above(result: Result, reference: float) -> float | str:
    """How far the objective is above the reference; a plan that leaves tasks out has its number of tasks instead."""
    if result.tasks < result.tasks_total:
        return f"{result.tasks} tasks"
    return 100 * (result.value / reference - 1)


def below(result: Result, reference: float) -> float:
    """How far the weight of the tasks done is below the reference."""
    return 100 * (1 - result.weight / reference)


def gap_columns(solvers: Sequence[str]) -> tuple[str, ...]:
    """A column for each solver, and one for the worst of each that is random."""
    return tuple(column for s in solvers for column in ((s, f"{s}, worst") if _is_random(s) else (s,)))


def gap_cells(standings: Sequence[Standing], reference: float, gap: Gap, notes: Notes) -> list[Cell]:
    """The mean gap of each solver, and of one that is random the worst too."""
    cells: list[Cell] = []
    for standing in standings:
        mean, worst = _mean_and_worst(standing, reference, gap, notes)
        cells += [mean, worst] if _is_random(standing.results[0].run.solver) else [mean]
    return cells


def mean_cells(rows: Sequence[Sequence[Cell]]) -> list[Cell]:
    """The mean of each column, over the rows in which each cell is a number; empty where there is no such row."""
    whole = [row for row in rows if all(isinstance(cell, float) for cell in row)]
    if not whole:
        return [None] * len(rows[0])
    return [fmean(cell for cell in column if isinstance(cell, float)) for column in zip(*whole, strict=True)]


def _mean_and_worst(standing: Standing, reference: float, gap: Gap, notes: Notes) -> tuple[Cell, Cell]:
    fault = standing.fault
    if fault is not None:
        return f"{fault.split(':')[0]} {notes.number(fault)}" if ":" in fault else fault, None
    worst = gap(standing.worst, reference)
    if isinstance(worst, str):
        return worst, None
    gaps = [float(gap(result, reference)) for result in standing.results]
    return fmean(gaps), max(gaps)


def _is_random(solver: str) -> bool:
    return solver == OWN or (solver in PEERS and PEERS[solver].random)
