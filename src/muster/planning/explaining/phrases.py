"""Phrases of explanations, for the tables of the command and for sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence

from muster.allocation.explanations import Alternative, without_bid
from muster.allocation.problem import Problem
from muster.allocation.remedies import smallest
from muster.allocation.remedy import Capacity, Remedy
from muster.mission.auction_book import Award, Book
from muster.planning.explaining.explanations import OneTask

_MOST_SILENT = 10  # robots that could not bid, and are named


def place(found: OneTask) -> list[str]:
    """Which robot does the task, at which position of its route, and when."""
    route = found.route
    if route is None:
        return [f"task {found.task} is left out"]
    number = route.tasks.index(found.task) + 1
    said = [f"task {found.task} is done by {found.robot}, as number {number} of {len(route.tasks)}"]
    for visit in route.visits[number - 1 : number]:
        waits = visit.starts_s - visit.arrives_s
        waiting = f", waits {waits:.2f} s," if waits > 0 else ""
        said.append(f"{found.robot} arrives at {visit.arrives_s:.2f} s{waiting} and ends at {visit.ends_s:.2f} s")
    return said


def award_text(problem: Problem, book: Book, award: Award) -> str:
    """How a task was won, who bid what, and why others could not."""
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


def what_then(found: OneTask, other: Alternative) -> str:
    """The effect of giving the task to a robot that could do it."""
    if other.objective is None:
        return f"best as number {other.number}; another route has no way"
    more = None if found.robot is None or found.objective is None else other.objective - found.objective
    change = "" if more is None else f" ({round(more, 2) + 0.0:+.2f})"
    return f"best as number {other.number}: objective {other.objective:.2f}{change}"


def smallest_change(problem: Problem, changes: Sequence[Remedy]) -> str:
    """The smallest change with which some robot could do a task that is left out; empty where none is known."""
    best = smallest(tuple(changes))
    if best is None:
        return ""
    needs = f"smallest change: {best.robot}: {short(problem, best)}"
    return needs if best.kinds else f"no change is needed: {best.robot} can do it beside all else"


def ignored(problem: Problem) -> list[str]:
    """Which rules the caller had ignored."""
    return [f"rules ignored: {', '.join(problem.ignored)}"] if problem.ignored else []


def reserve(problem: Problem) -> str:
    """How the reserve reduces capacities; empty without a reserve."""
    if problem.mission.rules.capacity_reserve and problem.holds("capacity"):
        return f"capacities are work_capacity, the reserve of {problem.mission.rules.capacity_reserve:g} included"
    return ""


def short(problem: Problem, remedy: Remedy) -> str:
    """The changes, in short."""
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


def lines(problem: Problem, remedy: Remedy) -> list[str]:
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
    """A figure rounded up, so that a sufficient value stays sufficient."""
    return f"{math.ceil(value * 100 * (1 - 1e-10)) / 100:.2f}"


def _down(value: float) -> str:
    """A figure rounded down, so that a least value stays one."""
    return f"{math.floor(value * 100 * (1 + 1e-10)) / 100:.2f}"
