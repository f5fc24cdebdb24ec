"""The study: `search` against solvers from elsewhere, one table for each objective and one for large missions.

The cells of a comparison: the mean, the worst and the ratio of a solver's values, or why there is none.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from statistics import fmean

from muster.mission.model import OBJECTIVES
from muster.mission.values.ranges import require_positive
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.peers.contest import (
    OWN,
    PEERS,
    Match,
    Result,
    Run,
    Standing,
    Standings,
    runs_of,
    standings_of,
    undisturbed,
)
from muster_studies.peers.machine import machine_and_versions, require_comparable
from muster_studies.repetition import Repetition, one_by_one
from muster_studies.tables import Cell, Notes, Table


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


LARGE = "large"
IGNORED = ("prerequisites", "suitability")
_FREE = "free"
_TEAMS = ("31T-6R", "31T-6R-as-run", "31T-6R50", "31T-3R44-3R26", "16T-3R", "24T-5R")
_OTHERS = ("eil51-3", "eil51-5", "eil51-7", "berlin52-5", "eil76-7", "market-rescue-20", "flood")
_LARGE = ("uniform-1000-50", "uniform-5000-200")
_QUICK = ("6T-2R", "uniform-12-3")
_QUICK_LARGE = ("uniform-40-5",)
_SEEDS, _QUICK_SEEDS = 3, 1

_SOLVERS: Mapping[str, tuple[str, ...]] = {
    "total+max": (OWN, "OR-Tools", "PyVRP", "VROOM"),
    "total": (OWN, "OR-Tools", "PyVRP", "VROOM"),
    "max": (OWN, "OR-Tools", "PyVRP", "VROOM"),
    "average": (OWN, "OR-Tools", "CP-SAT"),
    "makespan": (OWN, "OR-Tools", "CP-SAT"),
}
_LARGE_SOLVERS = ("OR-Tools", "PyVRP", "VROOM")


@dataclass(frozen=True)
class Limits:
    """Seconds that solvers have: all of them on a shipped mission; `search`, and its peers, on a large one.

    Raises
    ------
    ParameterError
        if one is not above 0.
    """

    all: float
    own_large: float
    peers_large: float

    def __post_init__(self) -> None:
        require_positive(**asdict(self))


_USUAL, _SHORT = Limits(2.0, 1.0, 60.0), Limits(0.3, 0.1, 0.5)


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """One table: an objective, or `large`. Where `limits` are given they take the place of the usual ones."""

    number: str
    limits: Limits | None = None

    def jobs(self, effort: Effort) -> list[Run]:
        limits, seeds = self.limits or _limits(effort), _seeds(effort)
        matches = _matches(self.number, effort.quick)
        if self.number != LARGE:
            return runs_of(matches, _SOLVERS[self.number], limits.all, seeds)
        own = runs_of(matches, (OWN,), limits.own_large, seeds)
        return [*own, *runs_of(matches, _LARGE_SOLVERS, limits.peers_large, 1)]

    def table(self, effort: Effort, found: Mapping[Run, Result]) -> Table:
        standings = standings_of(found[run] for run in self.jobs(effort))
        if self.number == LARGE:
            return _large_table(effort.quick, standings)
        solvers, notes = _SOLVERS[self.number], Notes()
        columns = _columns(solvers)
        rows = [_row(match, solvers, standings, notes) for match in _matches(self.number, effort.quick)]
        title = f"Objective {self.number}: each solver's values, and those by the mean of search"
        return Table(self.number, title, columns, (*rows, _mean_row(columns, rows)), notes.lines(), decimals=3)


def peers_study(limits: Limits | None = None) -> Repetition[Run, Result]:
    """`search` against OR-Tools, PyVRP and VROOM at equal time, one run at a time for equal conditions.

    `limits` take the place of the usual ones.
    """
    return Repetition(
        **description("peers"),
        reproductions=tuple(Comparison(number=number, limits=limits) for number in (*OBJECTIVES, LARGE)),
        perform=one_by_one(undisturbed),
        seeds=_seeds,
        extras=("studies",),
        check=_check,
        remarks=lambda effort, found: (*_legend(limits or _limits(effort), _seeds(effort)), shares(found.values())),
    )


def _check(effort: Effort) -> None:
    require_comparable(effort, PEERS.values())


def _limits(effort: Effort) -> Limits:
    return _SHORT if effort.quick else _USUAL


def _seeds(effort: Effort) -> int:
    return effort.seeds or (_QUICK_SEEDS if effort.quick else _SEEDS)


def _matches(number: str, quick: bool) -> list[Match]:
    if number == LARGE:
        return [Match(mission=name, objective="total+max") for name in (_QUICK_LARGE if quick else _LARGE)]
    if quick:
        return [Match(mission=name, objective=number) for name in _QUICK]
    teams = [Match(mission=name, objective=number, ignored=rules) for name in _TEAMS for rules in ((), IGNORED)]
    return [*teams, *(Match(mission=name, objective=number) for name in _OTHERS)]


def _legend(limits: Limits, seeds: int) -> list[str]:
    return [
        machine_and_versions(PEERS.values()),
        f"Every solver has {limits.all:g} s of processor time for each plan (VROOM: of wall time) and one thread, and "
        "runs alone; handing over the model comes on top (milliseconds; in the table of large missions it is a "
        "column). Whole numbers that solvers want are rounded at 1e-7 of the longest way. All values are by "
        "muster.verify, lower is better; where tasks are left out their number done is told, and their weight "
        "where priorities differ; more weight comes before a lower value.",
        f"search and PyVRP are random: mean and worst of {'seed 0' if seeds == 1 else f'seeds 0 to {seeds - 1}'}. The "
        "others are not, and run once. Columns with / hold the mean of a solver by the mean of search: above 1, search "
        "is better.",
        f"{_FREE}: with --ignore {','.join(IGNORED)}. The other missions have neither of these rules.",
        *(f"{peer.name}: {peer.settings}." for peer in PEERS.values()),
        "PyVRP and VROOM minimise the total alone. For max and total+max they have the best of a sweep over a cap on "
        "the route length, judged by the objective: at least one run without a cap and runs with caps, the time "
        "limit split over 8 of them (of VROOM, which ends by itself, as many more as fit). They cannot express "
        "prerequisites, average, or waiting: those cells are empty, and tables are left out. OR-Tools' routing "
        "library has all rules and objectives: total+max as arcs and a global span, max as a global span, average as "
        "soft bounds of 0 on the usage at each task, makespan as the global span of a time with waiting, prerequisites "
        "as precedences in that time. CP-SAT has all of it too. Who may do a task (suitability, skills, locks) is told "
        "to OR-Tools as allowed vehicles, to PyVRP as ways too long to go, to VROOM as skills, to CP-SAT as legs "
        "that are not there; capacities all have as limits of a route's length.",
    ]


def shares(results: Collection[Result]) -> str:
    shares = [result.share for result in results if result.run.solver == "VROOM"] or [1.0]
    return (
        "A run of VROOM that had less than 0.9 of a processor, because others used the machine, is repeated, at most "
        f"twice, and the one with most counts: the runs that count had {fmean(shares):.2f} of one on average, "
        f"{min(shares):.2f} at least."
    )


def _columns(solvers: tuple[str, ...]) -> tuple[str, ...]:
    columns = ["mission", OWN, f"{OWN}, worst"]
    for solver in solvers[1:]:
        columns += [solver, *([f"{solver}, worst"] if PEERS[solver].random else []), f"{solver} / {OWN}"]
    return tuple(columns)


def _row(match: Match, solvers: tuple[str, ...], standings: Standings, notes: Notes) -> tuple[Cell, ...]:
    own = standings[match, OWN]
    cells: list[Cell] = [
        match.mission + (f", {_FREE}" if match.ignored else ""),
        mean_cell(own, notes),
        worst_cell(own),
    ]
    for solver in solvers[1:]:
        standing = standings[match, solver]
        worst = [worst_cell(standing)] if PEERS[solver].random else []
        cells += [mean_cell(standing, notes), *worst, ratio_cell(standing, own)]
    return tuple(cells)


def _mean_row(columns: tuple[str, ...], rows: list[tuple[Cell, ...]]) -> tuple[Cell, ...]:
    """The mean of each column of ratios, over the missions that have one."""
    cells: list[Cell] = ["mean"]
    for k, column in list(enumerate(columns))[1:]:
        ratios = [cell for row in rows if isinstance(cell := row[k], float)]
        cells.append(fmean(ratios) if ratios and column.endswith(f"/ {OWN}") else None)
    return tuple(cells)


def _large_table(quick: bool, standings: Standings) -> Table:
    rows: list[tuple[Cell, ...]] = []
    notes = Notes()
    for match in _matches(LARGE, quick):
        own = standings[match, OWN]
        for solver in (OWN, *_LARGE_SOLVERS):
            standing = standings[match, solver]
            result = standing.results[0]
            took = max(result.cpu_s for result in standing.results)
            figures = mean_cell(standing, notes), worst_cell(standing), ratio_cell(standing, own)
            rows.append((match.mission, solver, result.run.seconds, took, result.build_s, *figures))
    columns = ("mission", "solver", "limit [s]", "took [s]", "model [s]", "F", "worst", f"/ {OWN}")
    title = "Large missions, total+max: search after a short time, the others after a long one"
    more = (
        "Tasks and robots at random places of a square of 1000 m, routes open; uniform-TASKS-ROBOTS. took: the longest "
        "run, which overruns the limit where a solver looks at the clock too seldom; model: handing over the model, "
        "beyond the limit.",
    )
    return Table(LARGE, title, columns, tuple(rows), (*more, *notes.lines()), decimals=3)
