"""The rules that a caller may ignore, named by the words of reasons: `--ignore` and the key `ignored` of plans."""

from __future__ import annotations

from collections.abc import Collection

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
