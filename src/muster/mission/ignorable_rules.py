"""The rules that a caller may ignore, named by the words of reasons: `--ignore` and the key `ignored` of plans."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown

if TYPE_CHECKING:
    from muster.mission.robots import Robot
    from muster.mission.tasks import Task

IGNORABLE = (
    *("prerequisite", "suitability", "skill", "lock", "capacity"),
    *("window", "deadline", "shift", "team", "relation", "load", "battery", "min-tasks"),
)
_AS_THEY_ARE = ("suitability", "lock", "capacity", "battery", "min-tasks")
_PLURALS = {f"{rule}s": rule for rule in IGNORABLE if rule not in _AS_THEY_ARE}
"""Words of earlier files and commands, read as before; and the like of the others."""
_TASKS_WITHOUT: Mapping[str, Mapping[str, Any]] = {
    "window": {"window_s": ()},
    "deadline": {"deadline_s": None},
    "team": {"robots_needed": None, "team": (), "needs": None},
    "relation": {"same_robot_as": (), "other_robot_than": (), "starts_with": ()},
    "prerequisite": {"lags": {}},
    "load": {"load": None, "delivers": None},
}
_ROBOTS_WITHOUT: Mapping[str, Mapping[str, Any]] = {
    "shift": {"available_until_s": None},
    "battery": {"battery": None},
    "load": {"load_capacity": None, "load_at_start": None},
}
"""By rule what the keys of tasks and robots are without it."""


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


def task_as_it_holds(task: Task, ignored: Collection[str]) -> Task:
    """A task without the rules about time, teams and goods that do not hold."""
    without = {key: value for rule in ignored for key, value in _TASKS_WITHOUT.get(rule, {}).items()}
    return replace(task, **without) if without else task


def robot_as_it_holds(robot: Robot, ignored: Collection[str]) -> Robot:
    """A robot without the rules about time, energy and goods that do not hold."""
    without = {key: value for rule in ignored for key, value in _ROBOTS_WITHOUT.get(rule, {}).items()}
    return replace(robot, **without) if without else robot
