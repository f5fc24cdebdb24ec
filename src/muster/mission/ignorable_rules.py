"""The rules that a caller may ignore, named by the words of reasons: `--ignore` and the key `ignored` of plans."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import MISSING, fields, replace
from typing import Any, TypeVar

from muster.mission.declared_rules import usable_rules
from muster.mission.errors import ParameterError
from muster.mission.robots import Robot
from muster.mission.stations import Station
from muster.mission.tasks import Task
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown

IGNORABLE = tuple(word for word, rule in usable_rules().items() if rule.ignorable)
"""The words of the rules that are installed, those that ship first."""

_IN_THE_PLURAL = ("prerequisite", "skill", "window", "deadline", "shift", "team", "relation", "load")
_PLURALS = {f"{rule}s": rule for rule in _IN_THE_PLURAL}
"""Words of earlier files and commands, read as before; and the like of the others."""
_KEYS: Mapping[str, tuple[str, ...]] = {
    "prerequisite": ("lags",),
    "window": ("window_s",),
    "deadline": ("deadline_s",),
    "shift": ("available_until_s",),
    "team": ("robots_needed", "team", "needs"),
    "relation": ("same_robot_as", "other_robot_than", "starts_with"),
    "lock": ("only_robots",),
    "load": ("load", "delivers", "load_capacity", "load_at_start"),
    "battery": ("battery",),
}
"""By rule the keys of tasks and robots that are as by default where it does not hold, beside those that name it."""
T = TypeVar("T", Task, Robot, Station)


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
    """A task, robot or station without the rules that do not hold about times, teams, goods, energy and calls."""
    keys = {key for rule in ignored for key in _KEYS.get(rule, ())}
    off = {f.name for f in fields(item) if f.name in keys or f.metadata.get("rule") in ignored}
    return without(item, off) if off else item


def without(item: T, keys: Collection[str], **changes: Any) -> T:
    """A task, robot or station, changed, without some keys and without those that stand only beside these."""
    off = [f for f in fields(item) if f.name in keys or f.metadata.get("beside") in keys]
    return replace(item, **{f.name: {} if f.default is MISSING else f.default for f in off}, **changes)
