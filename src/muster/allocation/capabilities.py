"""What rules of time, teams and relations an allocator keeps, and the refusal of missions that ask for more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

import numpy as np

from muster.allocation.problem import Problem
from muster.mission.errors import ParameterError

ALL = frozenset({"window", "deadline", "shift", "lag", "team", "relation", "starts-with", "lateness"})
"""Everything that an allocator can be asked for beside what all can."""

NONE: frozenset[str] = frozenset()

Offered = Callable[[], Mapping[str, frozenset[str]]]
_offered: list[Offered] = []


def offer(allocators: Offered) -> None:
    """Let refusals name these allocators: by name what each can do. The registry, which is above this module, does."""
    _offered.append(allocators)


def required(problem: Problem) -> dict[str, str]:
    """What the allocator of a problem must be able to do, each with the place that asks for it first."""
    found = {word: rule(problem) for word, rule in _RULES.items()}
    return {word: where for word, where in found.items() if where is not None}


def refuse_what_is_not_kept(problem: Problem, name: str, can: frozenset[str]) -> None:
    """Refuse a problem that asks for rules that the allocator of this name cannot keep.

    Raises
    ------
    ParameterError
        with the key, its task or robot, and the allocators that can do all that the problem asks for.
    """
    asked = required(problem)
    lacking = [f"{where} ({word})" for word, where in asked.items() if word not in can]
    if lacking:
        able = " or ".join(those_that_can(asked)) or "an allocator that can"
        raise ParameterError(f"allocator: {name} cannot do {'; '.join(lacking)}; expected {able}")


def those_that_can(words: Iterable[str]) -> list[str]:
    """The allocators that can do all of this, in the order of the registry."""
    asked = set(words)
    return [name for offered in _offered for name, can in offered().items() if asked <= can]


def _task(problem: Problem, key: str, has: Callable[[int], object]) -> str | None:
    """The first task that has something, named with the key."""
    first = next((task.id for j, task in enumerate(problem.tasks) if has(j)), None)
    return None if first is None else f"task {first}: {key}"


def _window(problem: Problem) -> str | None:
    return _task(problem, "window_s", lambda j: problem.timed_rules.windows[j])


def _deadline(problem: Problem) -> str | None:
    return _task(problem, "deadline_s", lambda j: np.isfinite(problem.timed_rules.deadline[j]))


def _shift(problem: Problem) -> str | None:
    until = problem.timed_rules.available_until
    first = next((robot.id for robot, end in zip(problem.robots, until, strict=True) if np.isfinite(end)), None)
    return None if first is None else f"robot {first}: available_until_s"


def _lag(problem: Problem) -> str | None:
    lagged = [
        any(after or np.isfinite(within) for _, after, within in problem.timed_rules.lags(j)) for j in _all(problem)
    ]
    return _task(problem, "prerequisites with after_s or within_s", lambda j: lagged[j])


def _team(problem: Problem) -> str | None:
    first = next((j for j in _all(problem) if problem.timed_rules.is_for_team(j)), None)
    if first is None:
        return None
    task = problem.tasks[first]
    return f"task {task.id}: {'needs' if task.needs else 'team' if task.team else 'robots_needed'}"


def _relation(problem: Problem) -> str | None:
    rules = problem.timed_rules
    same = _related(problem, "same_robot_as", lambda j: rules.same_robot[j])
    return same or _related(problem, "other_robot_than", lambda j: rules.other_robot[j])


def _related(problem: Problem, key: str, has: Callable[[int], object]) -> str | None:
    """The first task in a relation; where one is there, the first that states it, as the rules are symmetric."""
    stated = _task(problem, key, lambda j: has(j) and getattr(problem.tasks[j], key))
    return stated or _task(problem, key, has)


def _starts_with(problem: Problem) -> str | None:
    rules = problem.timed_rules
    if len(rules.units) == len(problem.tasks):
        return None
    return _task(problem, "starts_with", rules.beginning_with)


def _lateness(problem: Problem) -> str | None:
    return "objective lateness" if problem.objective == "lateness" else None


def _all(problem: Problem) -> range:
    return range(len(problem.tasks))


_RULES: Mapping[str, Callable[[Problem], str | None]] = MappingProxyType(
    {
        "window": _window,
        "deadline": _deadline,
        "shift": _shift,
        "lag": _lag,
        "team": _team,
        "relation": _relation,
        "starts-with": _starts_with,
        "lateness": _lateness,
    }
)


def capability_table() -> str:
    """Which registered allocator can do what, as a table of Markdown."""
    head = f"| allocator | {' | '.join(_RULES)} |"
    rows = [
        f"| `{name}` | {' | '.join('yes' if word in can else '' for word in _RULES)} |"
        for offered in _offered
        for name, can in offered().items()
    ]
    return "\n".join([head, "|---|" + "---|" * len(_RULES), *rows])
