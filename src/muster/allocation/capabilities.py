"""What rules of time, teams and relations an allocator keeps, and the refusal of missions that ask for more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from muster.mission.errors import ParameterError
from muster.model.problem import Problem
from muster.model.rules import all_rules

RETURN = "makespan-return"
"""That the makespan counts the ways to the ends of routes, `rules.makespan_includes_return`."""

_WORDS = tuple(dict.fromkeys((*(word for rule in all_rules() for word in rule.asked.values()), "lateness", RETURN)))

ALL = frozenset(_WORDS)
"""Everything that an allocator can be asked for beside what all can."""

FOR_GOOD = ALL.difference(*(rule.asked.values() for rule in all_rules() if not rule.for_good))
"""What can be asked of an allocator that never takes a task out of a route again."""

BY_OBJECTIVE = frozenset({RETURN})
"""What can be asked of an allocator that knows no such rules, and compares plans by their objective."""

NONE: frozenset[str] = frozenset()

_OWN = "; a function of your own says what it can by its attribute can (docs/extending.md)"

Offered = Callable[[], Mapping[str, frozenset[str]]]
_offered: list[Offered] = []


def offer(allocators: Offered) -> None:
    """Let refusals name these allocators: by name what each can do. The registry, which is above this module, does."""
    _offered.append(allocators)


def refuse_what_is_not_kept(problem: Problem, name: str, can: frozenset[str]) -> None:
    """Refuse a problem that asks for rules that the allocator of this name cannot keep.

    Raises
    ------
    ParameterError
        with the key, its task or robot, and the allocators that can do all that the problem asks for.
    """
    lacking = [f"{where} ({word})" for word, where in problem.asked.items() if word not in can]
    if lacking:
        able = " or ".join(those_that_can(problem.asked)) or "an allocator that can"
        own = "" if any(name in offered() for offered in _offered) else _OWN
        raise ParameterError(f"allocator: {name} cannot do {'; '.join(lacking)}; expected {able}{own}")


def those_that_can(words: Iterable[str]) -> list[str]:
    """The allocators that can do all of this, in the order of the registry."""
    asked = set(words)
    return [name for offered in _offered for name, can in offered().items() if asked <= can]
