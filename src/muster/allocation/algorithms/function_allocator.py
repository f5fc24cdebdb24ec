"""Any function that makes routes, as an allocator."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import field, fields, make_dataclass
from typing import Any

from muster.allocation.allocator import MOST, Allocator, Outcome, Routes
from muster.allocation.capabilities import ALL, NONE
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.model.problem import Problem

AllocatingFunction = Callable[..., Outcome | Sequence[Sequence[int]]]
"""Returns for each robot of `problem.robots` a list of indices into `problem.tasks`, or an `Outcome`."""
_GIVEN = ("stop", "seed", "params", "start")


def allocator_from(function: object, name: str | None = None) -> Allocator:
    """A function as an allocator.

    The function's first parameter is the problem. It may also have parameters called `stop`, `seed`, `start` and
    `params`. All its other parameters have defaults: they are the parameters of the allocator. Where the function has
    an attribute `can`, that names the rules of time, teams and relations that it keeps (of `capabilities.ALL`).

    Raises
    ------
    ParameterError
        if the function does not have parameters of this form, or its `can` names something else.
    """
    called = name or str(getattr(function, "__name__", type(function).__name__))
    if not callable(function):
        raise ParameterError(f"it is a {type(function).__name__}; expected an Allocator or a function")
    if isinstance(function, type):
        raise ParameterError(f"allocator {called}: it is a class; expected an instance: {called}()")
    given, own = _parameters(function, called)

    def allocate(
        problem: Problem, stop: Stop, seed: int, params: Any, start: Routes | None
    ) -> Outcome | Sequence[Sequence[int]]:
        values = {"stop": stop, "seed": seed, "params": params, "start": start}
        chosen = {f.name: getattr(params, f.name) for f in fields(params)}
        made: Outcome | Sequence[Sequence[int]] = function(problem, **{key: values[key] for key in given}, **chosen)
        return made

    return Allocator(
        name=called,
        summary=(inspect.getdoc(function) or "a function").splitlines()[0],
        anytime=True,  # so that a function that goes on until `stop` is due ends also where no limit is given
        parameters=make_dataclass("Parameters", own, frozen=True, kw_only=True),
        algorithm=allocate,
        can=_rules_kept(function, called),
    )


def _rules_kept(function: Callable[..., Any], called: str) -> frozenset[str]:
    """The rules that a function says it keeps."""
    words = getattr(function, "can", NONE)
    told = [words] if isinstance(words, str) or not isinstance(words, Collection) else words
    for word in told:
        if word not in ALL or told is not words:
            hint = did_you_mean(word, ALL) if isinstance(word, str) else ""
            expected = f"a set of words of {', '.join(sorted(ALL))}{hint}"
            raise ParameterError(f"allocator {called}: can: {shown(word)}; expected {expected}")
    return frozenset(words)


def _parameters(function: Callable[..., Any], called: str) -> tuple[list[str], list[tuple[str, Any, Any]]]:
    """The parameters that every allocator is given, and the function's own as fields of a dataclass."""
    try:
        _problem, *others = inspect.signature(function).parameters.values()
    except ValueError:
        raise ParameterError(f"allocator {called}: no parameters; expected the problem as the first") from None
    given, own = [], []
    for parameter in others:
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        if parameter.name in _GIVEN:
            given.append(parameter.name)
        elif parameter.default is parameter.empty or parameter.kind is parameter.POSITIONAL_ONLY:
            hint = did_you_mean(parameter.name, _GIVEN)
            expected = f"a default, or one of {', '.join(_GIVEN)}{hint}"
            raise ParameterError(f"allocator {called}: parameter {parameter.name}; expected {expected}")
        else:
            own.append((parameter.name, Any, _with_default(parameter.default)))
    return given, own


def _with_default(value: object) -> Any:
    unbounded = {MOST: math.inf}  # what it counts is the function's own affair
    if getattr(type(value), "__hash__", None):
        return field(default=value, metadata=unbounded)
    return field(default_factory=lambda: value, metadata=unbounded)
