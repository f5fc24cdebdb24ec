"""How robots can agree without a centre: the methods, by name. All go through the same network and command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from muster.allocation.problem import Problem
from muster.allocation.terms import Terms
from muster.mission.errors import ParameterError
from muster.mission.hints import did_you_mean
from muster.mission.plan import Plan
from muster.negotiation.negotiator import Negotiator
from muster.negotiation.taking_part import negotiator_of, plan_of_view
from muster.negotiation.view import View


@dataclass(frozen=True, kw_only=True)
class Method:
    """A way to agree.

    Parameters
    ----------
    name, summary
        for the command.
    negotiator
        makes a robot's part, as `taking_part.negotiator_of`.
    plan
        makes the plan of a view, as `taking_part.plan_of_view`.
    """

    name: str
    summary: str
    negotiator: Callable[..., Negotiator]
    plan: Callable[[Problem, Terms, View, float | None], Plan]


_IMPLEMENTATIONS = (
    Method(
        name="auction",
        summary="one task a round to the best bid; the auction thesis",
        negotiator=negotiator_of,
        plan=plan_of_view,
    ),
)

METHODS = {method.name: method for method in _IMPLEMENTATIONS}


def method_named(name: str) -> Method:
    """The method.

    Raises
    ------
    ParameterError
        if there is none of this name.
    """
    if name not in METHODS:
        raise ParameterError(f"method: {name}; expected {' or '.join(METHODS)}{did_you_mean(name, METHODS)}")
    return METHODS[name]
