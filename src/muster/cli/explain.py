"""`muster explain`: why this robot, why not that one, why left out."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.options import format_option, load_mission, mission_argument, quiet_option, say_of_plan
from muster.mission.errors import Finding, ParameterError, PlanError
from muster.mission.hints import did_you_mean
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.allocation.explanations import Alternative
    from muster.allocation.problem import Problem
    from muster.mission.book import Award, Book
    from muster.verification import Verdict

_MOST_SILENT = 10  # robots that could not bid, and are named


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--task", metavar="T", help="Only this task, which may also be one that is done.")
@format_option
@quiet_option
def command(
    mission: str,
    plan: Path,
    task: str | None,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    form: str,
    quiet: bool,
    verbose: bool,
) -> None:
    """Say why tasks are left out of a PLAN; with --task, why a task is done by this robot and not by another."""
    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    given = read_plan(plan)
    _require_fit(loaded, given, plan)
    say_of_plan(given, plan, loaded, quiet=quiet, verbose=verbose)
    if task is None:
        _left_out(loaded, given, form)
    else:
        _one_task(loaded, given, task, form)


def _require_fit(mission: Mission, plan: Plan, path: Path) -> None:
    """Explanations need a plan of this mission without knots; anything else is for `verify` to say."""
    from muster.verification import verify

    names = ("unknown-robot", "unknown-task", "repeated-robot", "repeated-task", "deadlock", "prerequisite")
    wrong = [v for v in verify(mission, plan).violations if v.kind in names]
    if wrong:
        expected = "a plan of this mission (`muster verify` says more)"
        raise PlanError(
            [
                Finding(str(path), None, v.kind, ", ".join(filter(None, (v.task or v.robot, v.detail))), expected)
                for v in wrong
            ]
        )


def _left_out(mission: Mission, plan: Plan, form: str) -> None:
    from muster.allocation.allocator import routes_of
    from muster.allocation.explanations import unassigned
    from muster.allocation.problem import Problem
    from muster.cli.tables import print_table

    problem = Problem.compile(mission, plan.objective, plan.ignored)
    left_out = unassigned(problem, routes_of(problem, plan))
    if form == "json":
        click.echo(json_text({"unassigned": [asdict(item) for item in left_out]}), nl=False)
    elif not left_out:
        click.echo("no task is left out; --task T explains a task that is done")
    else:
        rows = [(item.task, r.robot, r.reason, r.detail) for item in left_out for r in item.reasons]
        print_table(("task", "robot", "reason", "detail"), rows, title=f"{len(left_out)} tasks left out")


def _one_task(mission: Mission, plan: Plan, task: str, form: str) -> None:
    from muster.allocation.allocator import routes_of
    from muster.allocation.explanations import alternatives
    from muster.allocation.problem import Problem
    from muster.verification import verify

    problem = Problem.compile(mission, plan.objective, plan.ignored)
    if task not in problem.task_index:
        hint = did_you_mean(task, problem.task_index)
        raise ParameterError(f"--task: {task}; expected the id of a task of this mission{hint}")
    found = alternatives(problem, routes_of(problem, plan), problem.task_index[task])
    verdict = verify(mission, plan)
    now = next((route.robot for route in verdict.routes if task in route.tasks), None)
    objective = verdict.value()
    award = None if plan.book is None else plan.book.award_of(task)
    if form == "json":
        data = {"task": task, "robot": now, "objective": objective, "alternatives": [asdict(a) for a in found]}
        click.echo(json_text(data | ({} if award is None else {"award": award.as_dict()})), nl=False)
        return
    _print_place(verdict, task, now)
    if plan.book is not None and award is not None:
        click.echo(_award_text(problem, plan.book, award))
    _print_alternatives(found, now, objective)


def _print_place(verdict: Verdict, task: str, now: str | None) -> None:
    route = next((route for route in verdict.routes if route.robot == now), None)
    if route is None:
        click.echo(f"task {task} is left out")
        return
    number = route.tasks.index(task) + 1
    click.echo(f"task {task} is done by {now}, as number {number} of {len(route.tasks)}")
    for visit in route.visits[number - 1 : number]:
        waits = visit.starts_s - visit.arrives_s
        waiting = f", waits {waits:.2f} s," if waits > 0 else ""
        click.echo(f"{now} arrives at {visit.arrives_s:.2f} s{waiting} and ends at {visit.ends_s:.2f} s")


def _award_text(problem: Problem, book: Book, award: Award) -> str:
    """How a task was won, who bid what, and why others could not."""
    from muster.allocation.explanations import without_bid

    parts = [f"task {award.task} went to {award.robot} in round {award.round} for {_price(award.price)}"]
    parts += [f"{robot} bid {_price(bid)}" for robot, bid in award.bids if robot != award.robot]
    if award.bidders > len(award.bids):
        parts.append(f"{award.bidders - len(award.bids)} more made worse bids")
    silent = without_bid(problem, book, award)
    parts += [f"{reason.robot} could not: {reason.reason}, {reason.detail}" for reason in silent[:_MOST_SILENT]]
    if len(silent) > _MOST_SILENT:
        parts.append(f"{len(silent) - _MOST_SILENT} more could not, either")
    return "; ".join(parts)


def _price(bid: float) -> str:
    return f"{bid:.2f}" if abs(bid) >= 0.1 else f"{bid:.2g}"


def _print_alternatives(found: tuple[Alternative, ...], now: str | None, objective: float | None) -> None:
    from muster.cli.tables import print_table

    rows = []
    for other in found:
        mark = "  (now)" if other.robot == now else ""
        if other.reason is not None:
            rows.append((other.robot + mark, "no", f"{other.reason.reason}: {other.reason.detail}"))
        elif other.objective is not None:
            more = other.objective - objective if objective is not None and now is not None else None
            change = "" if more is None else f" ({round(more, 2) + 0.0:+.2f})"
            rows.append(
                (other.robot + mark, "yes", f"best as number {other.number}: objective {other.objective:.2f}{change}")
            )
    print_table(("robot", "could", "why, and what then"), rows, title="each robot, the rest of the plan as it is")
