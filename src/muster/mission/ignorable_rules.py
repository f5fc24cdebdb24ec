"""The rules that a caller may ignore, named by the words of reasons: `--ignore` and the key `ignored` of plans."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import MISSING, fields, replace
from typing import TypeVar

from muster.mission.errors import ParameterError
from muster.mission.records import rules_named_by
from muster.mission.robots import Robot
from muster.mission.stations import Station
from muster.mission.tasks import Task
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown

_FIRST = (
    *("prerequisite", "suitability", "skill", "lock", "capacity"),
    *("window", "deadline", "shift", "team", "relation", "load", "battery"),
)
IGNORABLE = tuple(dict.fromkeys((*_FIRST, *rules_named_by(Robot, Task, Station))))
"""The words of the first rules, and behind them those that keys of missions name as their rule's."""

_AS_THEY_ARE = ("suitability", "lock", "capacity", "battery")
_PLURALS = {f"{rule}s": rule for rule in _FIRST if rule not in _AS_THEY_ARE}
"""Words of earlier files and commands, read as before; and the like of the others."""
_KEYS: Mapping[str, tuple[str, ...]] = {
    "prerequisite": ("lags",),
    "window": ("window_s",),
    "deadline": ("deadline_s",),
    "shift": ("available_until_s",),
    "team": ("robots_needed", "team", "needs"),
    "relation": ("same_robot_as", "other_robot_than", "starts_with"),
    "load": ("load", "delivers", "load_capacity", "load_at_start"),
    "battery": ("battery",),
}
"""By rule the keys of tasks and robots that are as by default where it does not hold, beside those that name it."""
T = TypeVar("T", Task, Robot)


def ignorable_rule(word: object) -> str | None:
    """The rule that a word names; None: it names none."""
    rule = _PLURALS.get(word, word) if isinstance(word, str) else None
    return rule if rule in IGNORABLE else None


def ignored_rules(words: str | Collection[str]) -> tuple[str, ...]:
    """The rules that words name, each once, in the order of IGNORABLE.

    Raises
    ------
    ParameterError
        for a word that names none, and for what is no collection of words.
    """
    if not isinstance(words, Collection) or isinstance(words, bytes):
        raise ParameterError(f"ignore: {shown(words)}; expected a list of {', '.join(IGNORABLE)}")
    named = set()
    for word in (words,) if isinstance(words, str) else words:
        rule = ignorable_rule(word)
        if rule is None:
            raise ParameterError(
                f"ignore: {shown(word)}; expected {' or '.join(IGNORABLE)}{did_you_mean(str(word), IGNORABLE)}"
            )
        named.add(rule)
    return tuple(rule for rule in IGNORABLE if rule in named)


def as_it_holds(item: T, ignored: Collection[str]) -> T:
    """A task or robot without the rules that do not hold about times, teams, goods and energy."""
    keys = {key for rule in ignored for key in _KEYS.get(rule, ())}
    off = [f for f in fields(item) if f.name in keys or f.metadata.get("rule") in ignored]
    without = {f.name: {} if f.default is MISSING else f.default for f in off}
    return replace(item, **without) if without else item
