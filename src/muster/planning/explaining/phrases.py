"""Phrases of explanations, for the tables of the command and for sentences."""

from __future__ import annotations

from collections.abc import Sequence

from muster.allocation.bounds.work_shortfall import Shortfall
from muster.allocation.reasons.explanations import Alternative, without_bid
from muster.allocation.remedies.mission_remedies import MissionRemedy
from muster.allocation.remedies.remedies import smallest
from muster.allocation.remedies.remedy import Remedy
from muster.mission.auction_book import Award, Book
from muster.mission.goods import shown_amounts
from muster.model.energy import levels_in_words
from muster.model.problem import Problem
from muster.model.rules.times import span
from muster.planning.explaining.explanations import OneTask
from muster.verification import Stop

_LEAST_CHANGES = "least changes of the mission with which nothing is proven to be short"
_MOST_SILENT = 10  # robots that could not bid, and are named


def place(found: OneTask) -> list[str]:
    """Which robot does the task, at which position of its route, and when."""
    route = found.route
    if route is None:
        return [f"task {found.task} is left out"]
    number = route.tasks.index(found.task) + 1
    with_others = f" with {', '.join(found.team[1:])}" if len(found.team) > 1 else ""
    said = [f"task {found.task} is done by {found.robot}{with_others}, as number {number} of {len(route.tasks)}"]
    for stop in (stop for stop in route.stops if not stop.is_station and stop.name == found.task):
        waiting = f", waits {stop.waits_s:.2f} s," if stop.waits_s > 0 else ""
        said.append(f"{found.robot} arrives at {stop.arrives_s:.2f} s{waiting} and ends at {stop.ends_s:.2f} s")
        said += _levels(found, stop)
    return said


def shortfall_lines(found: Sequence[Shortfall], remedies: Sequence[MissionRemedy] = ()) -> list[str]:
    """That work is too much for robots, what is least to add, and what lifts all that is proven."""
    lines = [line for short in found for line in (f"proven: {short.detail}", *short.more)]
    if not remedies:
        return lines
    changes = [f"  {_of_mission(remedy)}" for remedy in remedies]
    unknown = "whether a plan then does all tasks is not known" + (", where none was found" if _any(remedies) else "")
    all_found = all(remedy.plan_found for remedy in remedies)
    return [*lines, f"{_LEAST_CHANGES}:", *changes, *(() if all_found else (f"  {unknown}",))]


def _any(remedies: Sequence[MissionRemedy]) -> bool:
    return any(remedy.plan_found for remedy in remedies)


def _of_mission(remedy: MissionRemedy) -> str:
    """A change of a mission, whether less is too little, and whether a plan is known."""
    few = "; fewer are not enough (proven)" if len(remedy.robots) > 1 else ""
    less = f"; less than {span(remedy.at_least_s)} is not enough (proven)" if remedy.at_least_s else ""
    return f"{remedy.said}{few}{less}{': a plan was found' if remedy.plan_found else ''}"


def _levels(found: OneTask, stop: Stop) -> list[str]:
    """What the robot holds, and what is on board, where the mission has such rules."""
    mission, unit = found.problem.mission, found.problem.usage_unit
    said = []
    if stop.arrival_level is not None and stop.level_after is not None:
        said.append(levels_in_words(stop.arrival_level, stop.level_after, unit))
    if mission.has_goods:
        said.append(f"it leaves with a load of {shown_amounts(stop.load_after)}")
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
    calls = f", with {', '.join(best.calls)}" if best.calls else ""
    return needs if best.kinds else f"no change is needed: {best.robot} can do it beside all else{calls}"


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
    parts = [change.short for change in remedy.changes.values()]
    if remedy.before:
        parts.append(_first(remedy))
    capacity = remedy.capacity.short(problem.usage_unit)
    parts += [f"with {call}" for call in remedy.calls]
    return "; ".join([*parts, *([capacity] if capacity else [])]) or "none is needed"


def lines(problem: Problem, remedy: Remedy) -> list[str]:
    """What a robot would need, a line for each kind of change."""
    lines = [change.line for change in remedy.changes.values()]
    if remedy.before:
        lines.append(_first(remedy))
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
        lines += remedy.capacity.lines(problem.usage_unit)
    elif remedy.enough:
        capacity = remedy.capacity
        fits = capacity.as_is is not None and (capacity.now is None or capacity.as_is <= capacity.now * (1 + 1e-9))
        where = "it fits into the plan as it is" if fits else "a plan was found in which other tasks are moved"
        lines.append(f"nothing else: {where}" if lines else f"nothing: {where}")
    lines += [f"with {call}" for call in remedy.calls]
    if remedy.impossible and all(before.possible for before in remedy.before):
        lines.append("no plan can do it with that, whatever the capacity (proven)")
    elif not remedy.enough and not remedy.impossible:
        none = "no plan with that was found; that there is none is not proven"
        lines.append(none if remedy.searched else "plans with that were not searched: other robots need less")
    return lines


def _first(remedy: Remedy) -> str:
    return f"first {', '.join(before.task for before in remedy.before)}, left out as well"
