"""The rules that a caller may ignore, named by the words of reasons: `--ignore` and the key `ignored` of plans."""

from __future__ import annotations

from collections.abc import Collection

from muster.mission.declared_rules import rules_in_order
from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown

IGNORABLE = tuple(word for word, rule in rules_in_order().items() if rule.ignorable)
"""The words of the rules that are installed, in the order in which reasons are sought."""

_IN_THE_PLURAL = ("prerequisite", "skill", "window", "deadline", "shift", "team", "relation", "load")
_PLURALS = {f"{rule}s": rule for rule in _IN_THE_PLURAL}
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
