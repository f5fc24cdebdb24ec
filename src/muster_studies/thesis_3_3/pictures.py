"""Figures 3.6 to 3.23 and A.1: the objective over computing time, and the routes of plans."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np

from muster.allocation.registry import allocator_named
from muster.allocation.stop import Stop
from muster.mission.plan import Plan, Route
from muster.mission.values.arrays import Floats
from muster.model.problem import Problem
from muster.report.figures.canvas import new_figure
from muster_studies.descriptions import captioned
from muster_studies.effort import Effort
from muster_studies.misprints import corrected
from muster_studies.plan_pictures import PlanPanel, plan_figure
from muster_studies.runs import mission_named
from muster_studies.thesis_3_3.plans import PublishedPlan, published_plans
from muster_studies.thesis_3_3.published import is_random, publication
from muster_studies.thesis_3_3.trials import ALLOCATORS, AS_RUN, trial_case

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_INSTANTS = 300
_QUICK_SHARE = 10


@cache
def _solved(mission: str, allocator: str, iterations: int | None, objective: str, ignored: tuple[str, ...]) -> Plan:
    """The plan of one run, with seed 0."""
    problem = Problem.compile(mission_named(mission), objective, ignored).ready()
    return allocator_named(allocator).solve(problem, Stop(iterations=iterations), seed=0)


def _iterations(effort: Effort, published: int) -> int:
    if effort.iterations is not None:
        return effort.iterations
    return published // _QUICK_SHARE if effort.quick else published


# ---------- objective over computing time ----------


def _over_time(allocator: str, effort: Effort) -> tuple[Floats, Floats]:
    """Instants in seconds, and at each the objective of every run: (instants,), (runs, instants)."""
    case = trial_case(allocator + AS_RUN, effort)
    problem = Problem.compile(mission_named(case.mission), case.objective, case.ignored).ready()
    histories = []
    for seed in range(effort.seed_count):
        plan = allocator_named(case.allocator).solve(problem, Stop(iterations=case.iterations), seed=seed)
        histories.append((np.array(plan.history), plan.elapsed_s or 0.0))
    first = max(history[0, 0] for history, _ in histories)
    instants = np.geomspace(max(first, 1e-4), max(elapsed for _, elapsed in histories), _INSTANTS)
    return instants, np.array([_steps(history, instants) for history, _ in histories])


def _steps(history: Floats, instants: Floats) -> Floats:
    """The last objective found by each instant; the first one before."""
    at = np.searchsorted(history[:, 0], instants, side="right") - 1
    values: Floats = history[np.maximum(at, 0), 1]
    return values


def _finished(ax: Axes, title: str, label: str) -> None:
    ax.set(title=title, xlabel="computing time, s", ylabel=label, xscale="log")
    ax.grid(alpha=0.3)
    ax.legend(fontsize=8)


def _references(ax: Axes) -> None:
    """The greedy objective, and the benchmark's range."""
    greedy, benchmark = (
        next(row for row in publication("3.2").rows if row["allocator"] == name) for name in ("greedy", "benchmark")
    )
    ax.axhline(greedy["total+max"], color="black", linestyle="--", linewidth=1, label="greedy")
    low, high = benchmark["total+max"]
    ax.axhspan(low, high, color="gray", alpha=0.3, label="benchmark")


def _mean(effort: Effort) -> Figure:
    figure = new_figure(8.0, 5.0)
    ax = figure.add_subplot()
    for allocator in ALLOCATORS:
        instants, values = _over_time(allocator, effort)
        ax.plot(instants, values.mean(axis=0), label=allocator + AS_RUN)
    _references(ax)
    _finished(ax, f"eil51, five salesmen: mean of {effort.seed_count} runs", "F")
    return figure


def _deviation(effort: Effort) -> Figure:
    figure = new_figure(8.0, 5.0)
    ax = figure.add_subplot()
    for allocator in ALLOCATORS:
        instants, values = _over_time(allocator, effort)
        ax.plot(instants, values.std(axis=0, ddof=min(1, len(values) - 1)), label=allocator + AS_RUN)
    _finished(ax, f"eil51, five salesmen: standard deviation of {effort.seed_count} runs", "standard deviation of F")
    return figure


def _each(effort: Effort) -> Figure:
    figure = new_figure(11.0, 8.0)
    for place, allocator in enumerate(ALLOCATORS, 1):
        ax = figure.add_subplot(2, 2, place)
        instants, values = _over_time(allocator, effort)
        for run, line in enumerate(values, 1):
            ax.plot(instants, line, linewidth=1, label=str(run))
        _finished(ax, allocator + AS_RUN, "F")
        ax.legend(title="run", fontsize=7, ncols=2)
    return figure


# ---------- routes ----------


def _salesmen(table: str, figures: Sequence[str], effort: Effort) -> Figure:
    """Plans of a table's rows, by the figure that shows each; without figures all but the benchmark's."""
    panels = []
    for row in publication(table).rows:
        if row["allocator"] == "benchmark" or (figures and row["figure"] not in figures):
            continue
        count = _iterations(effort, row["iterations"]) if is_random(row["allocator"]) else None
        allocator = row["allocator"] + AS_RUN if is_random(row["allocator"]) else row["allocator"]
        plan = _solved(row["run_as"], allocator, count, "total+max", ())
        after = f", {count} iterations" if count is not None else ""
        title = f"{row['mission']}, {allocator}{after}"
        panels.append(PlanPanel(title=title, mission=mission_named(row["run_as"]), plan=plan))
    return plan_figure(panels, columns=2)


def _published(table: str, effort: Effort) -> Figure:
    return plan_figure([_panel(plan) for plan in published_plans(table).values()])


def _panel(plan: PublishedPlan) -> PlanPanel:
    routes = tuple(Route(robot, tuple(map(str, corrected(route)["tasks"]))) for robot, route in plan.routes.items())
    return PlanPanel(
        title=f"{plan.scenario}, {plan.allocator}",
        mission=mission_named(plan.mission),
        plan=Plan(routes=routes, ignored=plan.ignored),
        ignored=plan.ignored,
    )


def _least_cost(table: str, effort: Effort) -> Figure:
    panels = []
    for row in publication(table).rows:
        if row["objective"] != "total":
            continue
        count = _iterations(effort, row["iterations"]) if is_random(row["allocator"]) else None
        ignored = tuple(row["ignored"])
        plan = _solved(row["run_as"], row["allocator"], count, "total", ignored)
        routes = Plan(routes=plan.routes, ignored=plan.ignored)  # without the stated objective: the judge's is F
        title = f"{row['mission']}, {row['allocator']}, least total cost"
        panels.append(PlanPanel(title=title, mission=mission_named(row["run_as"]), plan=routes, ignored=ignored))
    return plan_figure(panels)


_SALESMEN = {"3.8": ("3.8b",), **{number: (f"{number}a", f"{number}b") for number in ("3.9", "3.10", "3.11", "3.12")}}
"""By figure its panels that are drawn, the rows of Table 3.3 that name them."""
_ROUTES = {
    "3.14": "3.5",
    "3.15": "3.6",
    "3.16": "3.8",
    "3.17": "3.9",
    "3.18": "3.13",
    "3.19": "3.14",
    "3.20": "3.17",
    "3.21": "3.18",
}
"""By figure the table of the routes that it shows."""

FIGURES = captioned(
    "thesis-3.3",
    {
        "3.6": _mean,
        "3.7": _deviation,
        **{number: partial(_salesmen, "3.3", panels) for number, panels in _SALESMEN.items()},
        "3.13": partial(_salesmen, "3.4", ()),
        **{number: partial(_published, table) for number, table in _ROUTES.items()},
        "3.22": partial(_least_cost, "3.21"),
        "3.23": partial(_least_cost, "3.22"),
        "A.1": _each,
    },
)
