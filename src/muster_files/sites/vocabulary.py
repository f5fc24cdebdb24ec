"""Words of names, in the languages of those who draw sites, and what they say: closed, boundary, aircraft, ...

`vocabulary.yaml` has the patterns of each meaning. A pattern is a word or several with single spaces between them;
`sperr*` stands for all words that begin so, `*verbot*` for all names in which the letters stand. Chinese, Japanese,
Korean, Arabic, Persian and Hebrew join words, so that their patterns have a star on both sides. Accents, soft hyphens
and joiners make no difference.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from functools import lru_cache

from muster.mission.texts.packaged_files import packaged_data

CLOSED, BOUNDARY, SURVEY, OBSTACLE = "closed", "boundary", "survey", "obstacle"
TASK, ROBOT, STATION, LANE, HOME = "task", "robot", "station", "lane", "home"
AIR, GROUND = "air", "ground"
FENCE = "fence"

_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_SHORT_FOR = {"ao": BOUNDARY, "roi": SURVEY}
_SHORT = re.compile(r"(?<![^\W_])(?:AO|ROI)(?![^\W_])")
"""Area of operation, region of interest: in capitals, or alone; other languages have words of these letters."""
_ASCII_WORD = re.compile("[a-z]+")
_PLAIN = str.maketrans({"ł": "l", "ø": "o", "đ": "d", "ı": "i", "æ": "ae", "œ": "oe", "ð": "d", "þ": "th"})


@lru_cache(maxsize=1024)
def plain(text: str) -> str:
    """Return the words of a text: in lower case, without accents, marks and digits, a space around each."""
    if text.isascii():
        return f" {' '.join(_ASCII_WORD.findall(_CAMEL.sub(' ', text).lower()))} "
    folded = unicodedata.normalize("NFKD", _CAMEL.sub(" ", text).casefold().translate(_PLAIN))
    kept = "".join(" " if _divides(c) else c for c in folded if unicodedata.category(c) not in ("Mn", "Cf"))
    return f" {' '.join(unicodedata.normalize('NFC', kept).split())} "


def _divides(character: str) -> bool:
    return unicodedata.category(character)[0] != "L" and unicodedata.category(character) != "Mc"


def _expression(patterns: str) -> re.Pattern[str]:
    parts = []
    for pattern in dict.fromkeys(one.strip() for one in patterns.split(",")):
        begins, ends = pattern.startswith("*"), pattern.endswith("*")
        parts.append(("" if begins else " ") + re.escape(plain(pattern).strip()) + ("" if ends else "(?= )"))
    return re.compile("|".join(parts))


@lru_cache(maxsize=1)
def _expressions() -> Mapping[str, re.Pattern[str]]:
    patterns_of = packaged_data("muster_files.sites", "vocabulary.yaml")
    return {meaning: _expression(patterns) for meaning, patterns in patterns_of.items()}


def meanings(text: str) -> Mapping[str, str]:
    """Return what the words of a text say, each meaning with the first word that has it."""
    found = _meanings(plain(text))
    short = _SHORT.search(text)
    if short is None and plain(text).strip() not in _SHORT_FOR:
        return found
    word = plain(text).strip() if short is None else short[0]
    return {_SHORT_FOR[word.casefold()]: word} | dict(found)


@lru_cache(maxsize=4096)
def _meanings(words: str) -> Mapping[str, str]:
    """Names of many features differ by their numbers alone, so that most are looked up once."""
    found = {meaning: match for meaning, one in _expressions().items() if (match := one.search(words))}
    return {meaning: match[0].strip() for meaning, match in found.items()}


def moves(text: str) -> str | None:
    """Return `air` or `ground` where the words of a text say one of the two, and not both."""
    said = [meaning for meaning in (AIR, GROUND) if meaning in meanings(text)]
    return said[0] if len(said) == 1 else None


def is_only(text: str, *wanted: str) -> bool:
    """Return whether a text has no words besides those of the wanted meanings, and single letters."""
    return not meanings(text).keys().isdisjoint(wanted) and _is_only(plain(text), wanted)


def _is_only(words: str, wanted: tuple[str, ...]) -> bool:
    for meaning in wanted:
        words = _expressions()[meaning].sub(" ", words)
    return all(len(word) < 2 for word in words.split())
