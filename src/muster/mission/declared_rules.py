"""The rules of missions as packages declare them: the words, their order, their keys, and where planner and judge are.

A declaration is an entry point of the group `muster.rules`, those that ship among them. Its name is the word of the
rule: of reasons, of violations and of `--ignore`. Loading it loads neither planner nor judge, which read rules apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any, Literal

from muster.mission.errors import ParameterError, PluginError
from muster.mission.records import Checked, instead_of, key_of, required, specified
from muster.mission.system.plugins import Registry

Bearer = Literal["robot", "task", "rules"]
"""What of a mission bears the keys of a rule."""


@dataclass(frozen=True, kw_only=True)
class DeclaredRule:
    """A rule as a package declares it.

    Parameters
    ----------
    order
        reasons are sought in the order of these numbers; the rules that ship have 10, 20, ... to 190.
    planning
        `module:Class` of the rule of planning (`muster.model.rules.Rule`); empty: only the judge knows it.
    judge
        `module:Class` of the judge's own reading (`muster.verification.rules.Rule`).
    ignorable
        whether a caller can have it ignored.
    robot, task, rules
        classes whose fields, made by `spec`, are keys of robots, of tasks and of the mission's `rules`.
    shipped_keys
        the keys of a rule that ships, which are fields of the classes of missions themselves. Where several are stated,
        the first is named.
    """

    order: float
    planning: str = ""
    judge: str
    ignorable: bool = True
    robot: type[Checked] | None = None
    task: type[Checked] | None = None
    rules: type[Checked] | None = None
    shipped_keys: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """Its keys, whoever bears them."""
        further = (of for of in (self.robot, self.task, self.rules) if of)
        return (*self.shipped_keys, *(key_of(f) for of in further for f in specified(of)))

    def keys_of(self, bearer: Bearer) -> type[Checked] | None:
        """The class of its keys of one bearer."""
        found: type[Checked] | None = getattr(self, bearer)
        return found


def _checked(name: str, found: object) -> DeclaredRule:
    if not isinstance(found, DeclaredRule):
        raise ParameterError(f"it is a {type(found).__name__}; expected a muster.mission.declared_rules.DeclaredRule")
    for of in filter(None, (found.robot, found.task, found.rules)):
        for f in specified(of):
            if required(f) or instead_of(f):
                raise ParameterError(f"key {key_of(f)}; expected a default, and no other key in its place")
    return found


RULES: Registry[DeclaredRule] = Registry("rule", "muster.rules", _checked)


@cache
def usable_rules() -> Mapping[str, DeclaredRule]:
    """All rules that can be loaded, by name, in the order in which they are listed."""
    return RULES.usable()


@cache
def rules_in_order() -> Mapping[str, DeclaredRule]:
    """The same in the order in which reasons are sought."""
    return dict(sorted(usable_rules().items(), key=lambda rule: (rule[1].order, rule[0])))


@cache
def keys_beside(bearer: Bearer) -> tuple[type[Checked], ...]:
    """The classes of keys that rules give a bearer beside its own."""
    return tuple(keys for rule in rules_in_order().values() if (keys := rule.keys_of(bearer)) is not None)


def implemented(name: str, where: str) -> Any:
    """Make an instance of the class of a rule that its declaration names.

    Raises
    ------
    PluginError
        if there is none.
    """
    module, _, of = where.partition(":")
    try:
        return getattr(import_module(module), of)()
    except Exception as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise PluginError(f"rule {name}: {where} cannot be loaded: {reason}") from error
