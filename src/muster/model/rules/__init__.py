"""The rules of planning, one a file, in the order in which reasons are sought.

A rule says what it refuses, what it comes to, what it proves impossible, why a task is left out of a plan, what change
would lift it, and says that change in words. Problems, proofs of impossibility, reasons, remedies and their phrases are
loops over these. Which there are is declared by packages: `muster.mission.declared_rules`.
"""

from __future__ import annotations

from functools import cache

from muster.mission.declared_rules import implemented, rules_in_order
from muster.mission.errors import PluginError
from muster.model.rules.rule import Change, InPlan, Outlook, Question, Rule

__all__ = ["Change", "InPlan", "Outlook", "Question", "Rule", "all_rules"]


@cache
def all_rules() -> tuple[Rule, ...]:
    """The rules of all packages, in order.

    Raises
    ------
    PluginError
        if one cannot be loaded, is none, or has another word than it is declared with.
    """
    found = []
    for name, declared in rules_in_order().items():
        if not declared.planning:
            continue
        rule = implemented(name, declared.planning)
        if not isinstance(rule, Rule) or (declared.ignorable and rule.word != name):
            expected = f"a muster.model.rules.Rule with the word {name}"
            raise PluginError(f"rule {name}: {declared.planning}; expected {expected}")
        found.append(rule)
    return tuple(found)
