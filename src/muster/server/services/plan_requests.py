"""What may be asked for of a plan: refused at once, not after the job has waited for its turn."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import IGNORABLE, ignorable_rule
from muster.mission.model import OBJECTIVES
from muster.mission.near_matches import did_you_mean
from muster.mission.value_types import shown

_BOUNDS = ("quick", "exact")
_MOST_WORDS = 200  # letters in the name of something


def checked_wishes(wishes: Mapping[str, Any], longest_s: float) -> None:
    """Refuse wishes that cannot be met whatever the mission; None stands for no wish.

    Parameters
    ----------
    longest_s
        how long one job may take.

    Raises
    ------
    ParameterError
        naming the wish, its value, and what was expected.
    """
    for name, value in wishes.items():
        if name not in _WISHES:
            raise ParameterError(f"{shown(name)}: unknown; expected {', '.join(_WISHES)}{did_you_mean(name, _WISHES)}")
        fits, expected = _WISHES[name]
        if value is not None and not fits(value):
            raise ParameterError(f"{name}: {shown(value)}; expected {expected}")
    asked_s = wishes.get("time_limit")
    if asked_s is not None and asked_s > longest_s:
        raise ParameterError(f"time_limit: {asked_s:g}; expected at most {longest_s:g} s, the limit of this server")


def _is_whole(value: object, below: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < below


def _is_word(value: object) -> bool:
    return isinstance(value, str) and 0 < len(value) <= _MOST_WORDS


def _is_time(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < math.inf


def _are_rules(value: object) -> bool:
    return isinstance(value, list | tuple) and all(ignorable_rule(name) is not None for name in value)


def _are_parameters(value: object) -> bool:
    plain = bool, int, float, str
    return isinstance(value, dict) and all(_is_word(name) and isinstance(v, plain) for name, v in value.items())


_WISHES: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "allocator": (_is_word, "the name of an allocator"),
    "objective": (lambda value: value in OBJECTIVES, " or ".join(OBJECTIVES)),
    "time_limit": (_is_time, "seconds, at least 0"),
    "iterations": (lambda value: _is_whole(value, 2**63), "a whole number of at least 0"),
    "seed": (lambda value: _is_whole(value, 2**64), "a whole number from 0 to 2**64 - 1"),
    "ignore": (_are_rules, f"a list of {', '.join(IGNORABLE)}"),
    "bound": (lambda value: value in _BOUNDS, " or ".join(_BOUNDS)),
    "start": (lambda value: _is_whole(value, 2**63), "the id of a plan"),
    "parameters": (_are_parameters, "names and values of the allocator's parameters"),
}
