"""The rules of the judge, one a file. Which there are is declared by packages: `muster.mission.declared_rules`.

A rule finds what is wrong with a route, and says whether it keeps a robot from one more task. The judge asks the latter
of the reasons that a plan gives for tasks left out. Which limits of times are broken, and that routes and prerequisites
wait for each other in a cycle, is found by `schedule`, which all routes enter at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Protocol

from muster.mission.declared_rules import implemented, rules_in_order
from muster.mission.errors import PluginError
from muster.mission.model import Task
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation


class Rule(Protocol):
    """One rule of a mission."""

    @property
    def kind(self) -> str:
        """The word for it: of violations, of reasons, and of what is ignored."""
        ...

    @property
    def ignorable(self) -> bool:
        """Whether a caller can have it ignored."""
        ...

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        """Everything in a route that breaks the rule."""
        ...

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the rule keeps a task that is left out from being added to a route; None: too close to say."""
        ...


@cache
def all_rules() -> tuple[Rule, ...]:
    """The judge's reading of the rules of all packages, in order.

    Raises
    ------
    PluginError
        if one cannot be loaded, or is of another kind than it is declared.
    """
    found: list[Rule] = []
    for name, declared in rules_in_order().items():
        rule = implemented(name, declared.judge)
        if declared.ignorable and getattr(rule, "kind", None) != name:
            raise PluginError(
                f"rule {name}: {declared.judge}; expected a muster.verification.rules.Rule of kind {name}"
            )
        found.append(rule)
    return tuple(found)


def rules_that_hold(case: Case) -> list[Rule]:
    """All rules but those that are ignored."""
    return [rule for rule in all_rules() if not rule.ignorable or case.holds(rule.kind)]
