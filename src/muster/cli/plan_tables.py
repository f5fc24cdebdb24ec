"""Tables of plans and verdicts; all figures are the judge's."""

from __future__ import annotations

import click

from muster.cli.tables import number, print_table, sequence
from muster.mission.plan import Plan, gap
from muster.mission.texts.counting import counted
from muster.verification import Verdict

OPTIMAL = 1e-6
"""A gap below which a plan is as good as its bound: the rounding that proofs allow for."""


def print_plan(plan: Plan, verdict: Verdict) -> None:
    """Print the routes, the figures, and the tasks left out."""
    unit = verdict.usage_unit
    limited = any(route.capacity is not None for route in verdict.routes)
    columns = ["robot", "tasks in order", f"usage [{unit}]", *([f"capacity [{unit}]"] if limited else [])]
    rows = [
        [r.robot, sequence(r.order), number(r.usage), *([number(r.capacity)] if limited else [])]
        for r in verdict.routes
    ]
    title = f"{plan.mission}: {plan.allocator}, seed {plan.seed}"
    print_table(columns, rows, title=title, right=columns[2:])
    print_figures(verdict)
    if plan.time_without_traffic_s is not None:
        print_traffic_times(plan.time_with_traffic_s, plan.time_without_traffic_s)
    _print_bound(plan.lower_bound, verdict)
    if plan.book is not None:
        messages = "" if plan.book.messages is None else f", {plan.book.messages} messages"
        click.echo(f"rounds            {plan.book.rounds}{messages}")
    if plan.cut_short:
        click.echo(f"cut short         {plan.cut_short_line}")
    if plan.unassigned:
        left_out = [item.task for item in plan.unassigned]
        click.echo(f"left out          {sequence(left_out)}  (`muster explain` says why)")
    _print_ignored(verdict)


def print_traffic_times(with_s: float | None, without_s: float | None) -> None:
    """Print how long a plan takes where robots pass in turn; it is not known where somebody finds no way at once."""
    with_traffic = "not known" if with_s is None else number(with_s, "s")
    click.echo(f"time with traffic {with_traffic}, {number(without_s, 's')} without; ways home included")


def _print_bound(bound: float | None, verdict: Verdict, note: str = "") -> None:
    value = verdict.value()
    if bound is None or value is None:
        return
    off = gap(value, bound)
    unit = "s" if verdict.objective_name in ("makespan", "lateness") else verdict.usage_unit
    said = "the plan is optimal" if abs(off) < OPTIMAL else f"gap {100 * off:.2f} %"
    if off <= -OPTIMAL:
        said = "above the objective"
    click.echo(f"lower bound       {number(bound, unit)}  ({said}{note})")


def _print_ignored(verdict: Verdict) -> None:
    if verdict.ignored:
        click.echo(f"ignored           {', '.join(verdict.ignored)}")


def print_figures(verdict: Verdict) -> None:
    """Print the figures, one per line."""
    unit = verdict.usage_unit
    own_unit = "s" if verdict.objective_name in ("makespan", "lateness") else unit
    click.echo(f"objective         {number(verdict.value(), own_unit)}  ({verdict.objective_name})")
    click.echo(f"tasks completed   {verdict.tasks_completed} of {verdict.tasks_total}")
    click.echo(f"total cost        {number(verdict.total_cost, unit)}")
    click.echo(f"greatest usage    {number(verdict.max_usage, unit)}")
    click.echo(f"makespan          {number(verdict.makespan_s, 's')}")
    click.echo(f"waiting           {number(verdict.waiting_s, 's')}")
    if verdict.station_visits:
        charged = f", {number(verdict.charged, unit)} charged" if verdict.charged else ""
        click.echo(f"at stations       {counted(verdict.station_visits, 'time')}{charged}")
    if verdict.lateness and verdict.objective_name != "lateness":
        click.echo(f"lateness          {number(verdict.lateness, 's')}")
    click.echo(f"equality index    {number(verdict.equality_index)}")


def print_verdict(plan: Plan, verdict: Verdict) -> None:
    """Print whether a plan is valid, and every violation. A stated bound is compared, not proven again."""
    print_figures(verdict)
    click.echo(f"weight completed  {verdict.weight_completed:g}")
    _print_ignored(verdict)
    _print_bound(plan.lower_bound, verdict, "; stated in the plan")
    if verdict.reasons_undecided:
        click.echo(f"reasons           {verdict.reasons_undecided} for tasks left out not decided")
    if verdict.valid:
        click.echo("valid             yes")
        return
    click.echo(f"valid             no: {counted(len(verdict.violations), 'violation')}")
    rows = [(v.kind, v.robot or "-", v.task or "-", v.detail) for v in verdict.violations]
    print_table(("kind", "robot", "task", "detail"), rows)
