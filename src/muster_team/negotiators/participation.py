"""Entry into the auction and its result: makes the negotiator of a robot, and the plan as one robot sees it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from muster.allocation.allocator import Outcome, finished_plan
from muster.allocation.auctions.auction import AUCTION
from muster.allocation.auctions.auction_terms import Terms
from muster.allocation.auctions.consensus_bundle import CONSENSUS_BUNDLE
from muster.allocation.auctions.consensus_bundle import Parameters as BundleParameters
from muster.allocation.fixed import with_past
from muster.allocation.reasons.explanations import unassigned
from muster.allocation.stop import Stop
from muster.mission.auction_book import Book
from muster.mission.plan import Plan
from muster.model.problem import Problem
from muster_team.auctions.bundles import BundleValuer
from muster_team.auctions.valuation import AuctionValuer, Valuer
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.new_tasks import with_tasks
from muster_team.knowledge.rules import Rules, joint_among, teams_among
from muster_team.knowledge.signatures import NO_KEYS, Signatures
from muster_team.membership.members import Timeouts
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.robot_book import book_of_bundles, book_of_view
from muster_team.negotiators.robot_view import View, view_of


def rules_of(problem: Problem) -> Rules:
    """The rules of a mission that the agreement has to respect."""
    linked, tied = problem.holds("prerequisite"), (problem.holds("team"), problem.holds("relation"))
    return Rules(
        robots=problem.robot_index,
        tasks=problem.task_index,
        prerequisites={task.id: task.prerequisites if linked else () for task in problem.tasks},
        once=frozenset(task.id for task in problem.tasks if task.across_partition == "at-most-once"),
        linked=linked,
        teams=teams_among(problem.tasks, tied),
        joint=joint_among(problem.tasks, tied),
        tied=tied,
    )


def negotiator_of(
    problem: Problem,
    params: Any,
    robot: str,
    *,
    incarnation: int,
    valuer: Callable[[Problem, Any, str], Valuer] = AuctionValuer,
    timeouts: Timeouts = Timeouts(),  # noqa: B008 - frozen
    remembered: Memory | None = None,
    forgot: bool = False,
    absent: Collection[str] = (),
    signatures: Signatures = NO_KEYS,
) -> Negotiator:
    """A robot that takes part, in the auction by default.

    `params` are those of the `valuer`. The other arguments are as for `Participant`.
    """
    return Negotiator(
        robot=robot,
        rules=rules_of(problem),
        valuer=valuer(problem, params, robot),
        timeouts=timeouts,
        incarnation=incarnation,
        remembered=remembered,
        forgot=forgot,
        absent=absent,
        signatures=signatures,
    )


bundler_of = partial(negotiator_of, valuer=BundleValuer)
"""A robot that takes part in CBBA."""


def plan_of(problem: Problem, negotiator: Negotiator) -> Plan:
    """The plan as a robot sees it, with its book.

    Without faults it equals that of the auction in one process, except for seconds.
    """
    valuer = negotiator.valuer
    assert isinstance(valuer, AuctionValuer)
    return plan_of_view(problem, valuer.terms, view_of(negotiator))


def plan_of_view(problem: Problem, terms: Terms, view: View, elapsed_s: float | None = None) -> Plan:
    """The plan in a view; `elapsed_s` is the time until the robots agreed, seconds."""
    return _plan(problem, view, book_of_view(problem, terms, view), AUCTION.name, elapsed_s)


def plan_of_bundles(problem: Problem, params: BundleParameters, view: View, elapsed_s: float | None = None) -> Plan:
    """The plan of CBBA in a view; without faults it equals that of CBBA in one process on a complete network."""
    return _plan(problem, view, book_of_bundles(problem, params, view), CONSENSUS_BUNDLE.name, elapsed_s)


def _plan(problem: Problem, view: View, book: Book, allocator: str, elapsed_s: float | None) -> Plan:
    past = view.auctions[-1].opening.past if view.auctions else {}
    stop, problem = Stop(), _as_agreed_on(with_tasks(problem, view.added), past)
    routes = [[problem.task_index[task] for task in view.routes.get(robot.id, ())] for robot in problem.robots]
    stop.improved(*problem.value(routes))
    plan = finished_plan(problem, stop, Outcome(routes, book), allocator=allocator, seed=0)
    if any(past.values()):  # what robots have done and begun is no choice of the plan: it keeps them from other tasks
        plan = replace(plan, unassigned=unassigned(problem, routes))
    if elapsed_s is None:
        return plan
    return replace(plan, elapsed_s=elapsed_s, history=tuple((elapsed_s, value) for _, value in plan.history))


def _as_agreed_on(problem: Problem, past: Mapping[str, Sequence[str]]) -> Problem:
    """The problem for which robots bid last: after what each had done and begun by then.

    What is left out of their plan is so for its reasons. Without the past a task might fit before what is done.
    """
    if not any(past.values()):
        return problem
    return with_past(problem, [[problem.task_index[task] for task in past.get(r.id, ())] for r in problem.robots])
