"""The known word nearest to a misspelt one."""

from __future__ import annotations

import difflib
from bisect import bisect
from collections.abc import Iterable, Sequence
from functools import lru_cache

_MANY_NAMES = 100
_NEIGHBOURS = 20


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """`"; did you mean 'x'?"` for the known word that is nearest, or nothing; swapped letters count as nearest.

    Among many known words only those are compared that begin or end most like this one: thousands of ids cost no more
    than a few.
    """
    names, forwards, backwards = _sorted_names(tuple(known))
    folded = word.casefold()
    candidates = list(names)
    if len(names) > _MANY_NAMES:
        ending = [name[::-1] for name in _neighbours(folded[::-1], backwards)]
        candidates = [*_neighbours(folded, forwards), *ending]
    near = difflib.get_close_matches(folded, candidates, n=3, cutoff=0.6)
    near.sort(key=lambda name: sorted(name) != sorted(folded))
    return f"; did you mean '{names[near[0]]}'?" if near else ""


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
