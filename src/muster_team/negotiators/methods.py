"""The methods by which robots agree without a central auctioneer, by name. All use the same protocol and command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from muster.allocation.allocator import Allocator
from muster.allocation.auctions.auction import AUCTION
from muster.allocation.auctions.consensus_bundle import CONSENSUS_BUNDLE
from muster.mission.plan import Plan
from muster.mission.values.keywords import require_one_of
from muster.model.problem import Problem
from muster_team.auctions.bundles import BundleValuer
from muster_team.auctions.valuation import AuctionValuer
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.participation import bundler_of, negotiator_of, plan_of_bundles, plan_of_view
from muster_team.negotiators.robot_view import View


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method of agreement.

    Parameters
    ----------
    name, summary
        for the command.
    allocator
        the same method in one process; robots share its parameters.
    negotiator
        makes a robot's negotiator, as `participation.negotiator_of`.
    plan
        makes the plan of a view, as `participation.plan_of_view`.
    can
        what rules of time, teams and relations it agrees on.
    """

    name: str
    summary: str
    allocator: Allocator
    negotiator: Callable[..., Negotiator]
    plan: Callable[[Problem, Any, View, float | None], Plan]
    can: frozenset[str]


_IMPLEMENTATIONS = (
    Method(
        name="auction",
        summary="one task a round to the best bid; the auction thesis",
        allocator=AUCTION,
        negotiator=negotiator_of,
        plan=plan_of_view,
        can=AuctionValuer.can,
    ),
    Method(
        name="consensus-bundle",
        summary="bundles of tasks, and rounds until all agree; CBBA of Choi, Brunet and How",
        allocator=CONSENSUS_BUNDLE,
        negotiator=bundler_of,
        plan=plan_of_bundles,
        can=BundleValuer.can,
    ),
)

METHODS = {method.name: method for method in _IMPLEMENTATIONS}


def method_named(name: str) -> Method:
    """The method of a name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    require_one_of("method", name, METHODS, joined_by=" or ")
    return METHODS[name]
