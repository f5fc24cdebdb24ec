"""The known word nearest to a misspelt one."""

from __future__ import annotations

import difflib
import os
import re
from bisect import bisect
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, lru_cache
from itertools import islice
from pathlib import Path

from muster.mission.texts.packaged_files import packaged_data

_MOST_FILES = 1000  # of a folder, that are looked at
_MANY_NAMES = 100
_NEIGHBOURS = 20


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """`"; did you mean 'x'?"` for the known word that is nearest, or nothing; swapped letters count as nearest.

    A known word that the field calls so comes first.
    Among many known words only those are compared that begin or end most like this one: thousands of ids cost no more
    than a few.
    """
    names, forwards, backwards = _sorted_names(tuple(known))
    folded = word.casefold()
    if meant := _synonym(folded, names):
        return f"; did you mean '{meant}'?"
    candidates = list(names)
    if len(names) > _MANY_NAMES:
        ending = [name[::-1] for name in _neighbours(folded[::-1], backwards)]
        candidates = [*_neighbours(folded, forwards), *ending]
    near = difflib.get_close_matches(folded, candidates, n=3, cutoff=0.6)
    near.sort(key=lambda name: sorted(name) != sorted(folded))
    return f"; did you mean '{names[near[0]]}'?" if near else ""


def _synonym(word: str, names: Mapping[str, str]) -> str | None:
    """The known word that a word of the field means."""
    plain = word.replace(" ", "_")
    forms = (plain, plain.replace("_", "-"), plain.replace("-", "_"))
    return next((names[meant] for form in forms for meant in _meant_by(form) if meant in names), None)


def _meant_by(word: str) -> list[str]:
    """Return the words here that a word of the field, in lower case, may mean; of these the known one is named."""
    return [name for name, others in _synonyms().items() if word in others.split(", ")]


@cache
def _synonyms() -> Mapping[str, str]:
    """Return by word the words of the field for it, which no spelling tells."""
    called: Mapping[str, str] = packaged_data("muster.mission.texts", "synonyms.yaml")
    return called


def near_file(path: Path) -> str:
    """`"; did you mean 'x.yaml'?"` for the file beside one that is not there whose name is nearest, or nothing.

    A file with another suffix comes first.
    """
    try:
        names = [entry.name for entry in islice(os.scandir(path.parent), _MOST_FILES) if not entry.name.startswith(".")]
    except OSError:
        return ""
    same = [name for name in sorted(names) if Path(name).stem.casefold() == path.stem.casefold()]
    alike = [name for name in same if Path(name).suffix[:2].casefold() == path.suffix[:2].casefold()]
    if same:
        return f"; did you mean '{path.parent / (alike or same)[0]}'?"
    found = re.fullmatch(r"; did you mean '(.*)'\?", did_you_mean(path.name, names))
    return f"; did you mean '{path.parent / found[1]}'?" if found else ""


@lru_cache(maxsize=4)
def _sorted_names(known: tuple[str, ...]) -> tuple[dict[str, str], list[str], list[str]]:
    """The known words by their folded form; where there are many, also those forms sorted, and sorted back to front."""
    names = {name.casefold(): name for name in reversed(known)}
    if len(names) <= _MANY_NAMES:
        return names, [], []
    return names, sorted(names), sorted(name[::-1] for name in names)


def _neighbours(word: str, ordered: Sequence[str]) -> Sequence[str]:
    """The sorted words around a word: among them are those that share the longest beginning with it."""
    at = bisect(ordered, word)
    return ordered[max(0, at - _NEIGHBOURS) : at + _NEIGHBOURS]
