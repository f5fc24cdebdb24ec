"""`muster explain`: why this robot, why not that one, why left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options import format_option, load_mission, mission_argument, quiet_option, say_of_plan
from muster.mission.errors import Finding, ParameterError, PlanError
from muster.mission.hints import did_you_mean
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.allocation.explanations import Alternative
    from muster.allocation.problem import Problem
    from muster.allocation.remedy import Capacity, Remedy
    from muster.mission.book import Award, Book
    from muster.verification import Verdict

_MOST_SILENT = 10  # robots that could not bid, and are named
_MOST_SHORT = 50  # tasks left out whose smallest change is looked for when none is asked for by name


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
    from muster.allocation.remedies import smallest_as_is
    from muster.cli.tables import counted, print_table

    problem = Problem.compile(mission, plan.objective, plan.ignored)
    routes = routes_of(problem, plan)
    left_out = unassigned(problem, routes)
    judge = _judge()
    changes = {
        item.task: smallest_as_is(problem, routes, problem.task_index[item.task], judge)
        for item in left_out[:_MOST_SHORT]
    }
    if form == "json":
        smallest = [{"task": task, "remedy": _plain(remedy)} for task, remedy in changes.items()]
        data = {"unassigned": [asdict(item) for item in left_out], "smallest": smallest}
        click.echo(json_text(data), nl=False)
    elif not left_out:
        click.echo("no task is left out; --task T explains a task that is done")
    else:
        rows = [(item.task, r.robot, r.reason, r.detail) for item in left_out for r in item.reasons]
        print_table(("task", "robot", "reason", "detail"), rows, title=f"{counted(len(left_out), 'task')} left out")
        _print_smallest(problem, changes)
        if len(left_out) > len(changes):
            click.echo(f"and {len(left_out) - len(changes)} more: --task T looks for the changes for one task")


def _judge() -> Callable[[Mission, Plan], bool]:
    from muster.verification import verify

    return lambda mission, plan: verify(mission, plan).valid


def _plain(remedy: Remedy | None) -> dict[str, Any] | None:
    return None if remedy is None else {**asdict(remedy), "kinds": remedy.kinds}


def _one_task(mission: Mission, plan: Plan, task: str, form: str) -> None:
    from muster.allocation.allocator import routes_of
    from muster.allocation.explanations import alternatives
    from muster.allocation.problem import Problem
    from muster.allocation.remedies import remedies
    from muster.verification import verify

    problem = Problem.compile(mission, plan.objective, plan.ignored)
    if task not in problem.task_index:
        hint = did_you_mean(task, problem.task_index)
        raise ParameterError(f"--task: {task}; expected the id of a task of this mission{hint}")
    routes, j = routes_of(problem, plan), problem.task_index[task]
    found = alternatives(problem, routes, j)
    changes = remedies(problem, routes, j, _judge())
    verdict = verify(mission, plan)
    now = next((route.robot for route in verdict.routes if task in route.tasks), None)
    objective = verdict.value()
    award = None if plan.book is None else plan.book.award_of(task)
    if form == "json":
        data: dict[str, Any] = {
            "task": task,
            "robot": now,
            "objective": objective,
            "alternatives": [asdict(a) for a in found],
        }
        data["remedies"] = [_plain(remedy) for remedy in changes]
        click.echo(json_text(data | ({} if award is None else {"award": award.as_dict()})), nl=False)
        return
    _print_place(verdict, task, now)
    if plan.book is not None and award is not None:
        click.echo(_award_text(problem, plan.book, award))
    _print_alternatives(found, now, objective)
    _print_remedies(problem, changes, task, now)


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
        elif other.objective is None:
            rows.append((other.robot + mark, "yes", f"best as number {other.number}; another route has no way"))
        else:
            more = other.objective - objective if objective is not None and now is not None else None
            change = "" if more is None else f" ({round(more, 2) + 0.0:+.2f})"
            rows.append(
                (other.robot + mark, "yes", f"best as number {other.number}: objective {other.objective:.2f}{change}")
            )
    print_table(("robot", "could", "why, and what then"), rows, title="each robot, the rest of the plan as it is")


def _print_smallest(problem: Problem, changes: Mapping[str, Remedy | None]) -> None:
    from muster.cli.tables import print_table

    rows = [
        (
            (task, "-", "none was found; --task T looks further")
            if remedy is None
            else (task, remedy.robot, _short(problem, remedy))
        )
        for task, remedy in changes.items()
    ]
    print_table(("task", "robot", "change"), rows, title="smallest changes, the rest as it is")


def _print_remedies(problem: Problem, changes: tuple[Remedy, ...], task: str, now: str | None) -> None:
    from muster.allocation.remedies import smallest
    from muster.cli.tables import print_table

    rows = [(r.robot + ("  (now)" if r.robot == now else ""), "\n".join(_lines(problem, r))) for r in changes]
    print_table(("robot", "would need"), rows, title=f"to do {task} beside all else that the plan does")
    best = smallest(changes)
    if now is None and best is not None:
        needs = f"smallest change: {best.robot}: {_short(problem, best)}"
        click.echo(needs if best.kinds else f"no change is needed: {best.robot} can do it beside all else")
    if problem.mission.rules.capacity_reserve and problem.holds("capacity"):
        click.echo(f"capacities are work_capacity, the reserve of {problem.mission.rules.capacity_reserve:g} included")


def _short(problem: Problem, remedy: Remedy) -> str:
    """The changes in a few words."""
    parts = [f"skill {', '.join(remedy.skills)}"] if remedy.skills else []
    if remedy.suitability is not None:
        low = remedy.suitability
        parts.append(f"suitability {low.needed:g} of {low.robot_type} for {low.task_type}, not {low.score:g}")
    if remedy.lock is not None:
        parts.append("a place in the lock")
    if remedy.before:
        parts.append(f"first {', '.join(before.task for before in remedy.before)}, left out as well")
    capacity = remedy.capacity
    if capacity.grows and capacity.enough is not None and capacity.now is not None:
        parts.append(f"capacity {_up(capacity.enough)} {problem.usage_unit}, not {capacity.now:g}")
    return "; ".join(parts) or "none is needed"


def _lines(problem: Problem, remedy: Remedy) -> list[str]:
    """What a robot would need, a line for each kind of change."""
    lines = [f"skill {', '.join(remedy.skills)}"] if remedy.skills else []
    if remedy.suitability is not None:
        low = remedy.suitability
        lines.append(f"suitability {low.needed:g}: {low.robot_type} scores {low.score:g} for {low.task_type}")
    if remedy.lock is not None:
        lines.append(f"a place in the lock: only {', '.join(remedy.lock)} may do it")
    if remedy.before:
        lines.append(f"first {', '.join(before.task for before in remedy.before)}, left out as well")
        lines += [
            f"but {before.task} can never be done: --task {before.task} says more"
            for before in remedy.before
            if not before.possible
        ]
    if remedy.unable:
        return [*lines, f"to be another robot: {remedy.unable}"]
    if remedy.unreachable:
        return [*lines, "a way to it: there is none, and no other change helps"]
    if remedy.capacity.grows:
        lines += _capacity_lines(remedy.capacity, problem.usage_unit)
    elif remedy.enough:
        capacity = remedy.capacity
        fits = capacity.as_is is not None and (capacity.now is None or capacity.as_is <= capacity.now * (1 + 1e-9))
        where = "it fits into the plan as it is" if fits else "a plan was found in which other tasks are moved"
        lines.append(f"nothing else: {where}" if lines else f"nothing: {where}")
    if remedy.impossible and all(before.possible for before in remedy.before):
        lines.append("no plan can do it with that, whatever the capacity (proven)")
    elif not remedy.enough and not remedy.impossible:
        none = "no plan with that was found; that there is none is not proven"
        lines.append(none if remedy.searched else "plans with that were not searched: other robots need less")
    return lines


def _capacity_lines(capacity: Capacity, unit: str) -> list[str]:
    least, enough = capacity.at_least, capacity.enough
    proven = least is not None and capacity.now is not None and least > capacity.now
    parts = []
    if proven and enough is not None and least is not None and _down(least) == _up(enough):
        parts.append(f"{_up(enough)} {unit} is needed (proven) and enough (a plan was found)")
    else:
        parts += [f"needs at least {_down(least)} {unit} (proven)"] if proven and least is not None else []
        parts += [f"{_up(enough)} {unit} is enough (a plan was found)"] if enough is not None else []
        parts += ["whether less is enough is not known"] if not proven else []
    lines = [f"capacity: {', '.join(parts)}; it has {capacity.now:g}"]
    if capacity.as_is is not None:
        lines.append(f"capacity with the rest of the plan as it is: {_up(capacity.as_is)} {unit}")
    return lines


def _up(value: float) -> str:
    """A figure rounded up: what is enough stays enough."""
    return f"{math.ceil(value * 100 * (1 - 1e-10)) / 100:.2f}"


def _down(value: float) -> str:
    """A figure rounded down: what is needed at least stays needed."""
    return f"{math.floor(value * 100 * (1 + 1e-10)) / 100:.2f}"
