"""The rules of the judge, one a file. A file in this folder that has a rule is all that a new rule needs here.

A rule finds what is wrong with a route, and says whether it keeps a robot from one more task. The judge asks the latter
of the reasons that a plan gives for tasks left out. Which limits of times are broken, and that routes and prerequisites
wait for each other in a cycle, is found by `schedule`, which all routes enter at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from inspect import isabstract
from pkgutil import iter_modules
from typing import Protocol

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


_FIRST = (
    *("skill", "action", "suitability", "lock", "team", "relation", "prerequisite", "closed_area"),
    *("unreachable", "capacity", "load", "battery", "window", "deadline", "shift"),
)
"""The files of the rules whose violations are listed first; those of all others follow by name."""


def _found() -> Iterator[Rule]:
    """The rules in the files of this folder: classes that say what is wrong with a route."""
    names = sorted(module.name for module in iter_modules(__path__))
    for name in sorted(names, key=lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST)):
        module = import_module(f"{__name__}.{name}")
        for made in vars(module).values():
            is_own = isinstance(made, type) and made.__module__ == module.__name__
            if is_own and hasattr(made, "violations") and not isabstract(made):
                yield made()


RULES: tuple[Rule, ...] = tuple(_found())


def rules_that_hold(case: Case) -> list[Rule]:
    """All rules but those that are ignored."""
    return [rule for rule in RULES if not rule.ignorable or case.holds(rule.kind)]
