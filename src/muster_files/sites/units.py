"""Units in headings and beside numbers, and what one of them is in SI units."""

from __future__ import annotations

from typing import Literal

from muster.mission.texts.packaged_files import packaged_data

Dimension = Literal["", "time", "length", "speed", "angle", "mass"]

_WORDS_OF: dict[Dimension, dict[float, str]] = packaged_data("muster_files.sites", "units.yaml")
UNITS: dict[Dimension, dict[str, float]] = {
    dimension: {word: factor for factor, words in units.items() for word in words.split()}
    for dimension, units in _WORDS_OF.items()
}
"""By dimension the units by name; angles are in degrees, as in the names of a mission's keys; masses in kg."""

_WORDS: dict[Dimension, str] = {
    "": "no unit",
    "time": "s, min or h",
    "length": "m, km, cm, ft, mi or NM",
    "speed": "m/s, km/h, mph or kn",
    "angle": "deg or rad",
    "mass": "kg, g, t or lb",
}
_OF_ENERGY = ("mah", "ah", "wh", "kwh", "j", "kj", "mj", "v")
ALL_UNITS = frozenset((*(unit for units in UNITS.values() for unit in units), "%", "percent", *_OF_ENERGY))
"""Units that are known, those of no key included."""


def units_text(dimension: Dimension) -> str:
    """Units of a dimension, for messages."""
    return _WORDS[dimension]
