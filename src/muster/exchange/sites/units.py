"""Units in headings and beside numbers, and what one of them is in SI units."""

from __future__ import annotations

import math
from typing import Literal

Dimension = Literal["", "time", "length", "speed", "angle", "mass"]

UNITS: dict[Dimension, dict[str, float]] = {
    "": {},
    "time": {
        **dict.fromkeys(("s", "sec", "secs", "second", "seconds", "sek", "sekunden", "сек", "с", "秒", "초"), 1.0),
        **dict.fromkeys(("min", "mins", "minute", "minutes", "minuten", "minuti", "minutos", "minut", "minuty"), 60.0),
        **dict.fromkeys(
            ("minutter", "minuter", "dk", "dakika", "мин", "минут", "хв", "分", "分钟", "分鐘", "분"), 60.0
        ),
        **dict.fromkeys(("h", "hr", "hrs", "hour", "hours", "std", "stunden", "heures", "horas", "ore", "uur"), 3600.0),
        **dict.fromkeys(("timer", "timmar", "godz", "saat", "ч", "час", "год", "小时", "小時", "時間", "시간"), 3600.0),
        **dict.fromkeys(("d", "day", "days"), 86400.0),
        "ms": 0.001,
    },
    "length": {
        **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), 1.0),
        **dict.fromkeys(("м", "метров", "米", "メートル", "미터"), 1.0),
        **dict.fromkeys(("km", "kms", "км", "公里", "千米", "キロ"), 1000.0),
        "cm": 0.01,
        "mm": 0.001,
        **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
        **dict.fromkeys(("yd", "yard", "yards"), 0.9144),
        **dict.fromkeys(("mi", "mile", "miles"), 1609.344),
        **dict.fromkeys(("nm", "nmi"), 1852.0),
    },
    "speed": {
        **dict.fromkeys(("m/s", "mps", "ms", "m/sec", "м/с"), 1.0),
        **dict.fromkeys(("km/h", "kmh", "kph", "km/u", "км/ч"), 1 / 3.6),
        **dict.fromkeys(("ft/s", "fps"), 0.3048),
        "mph": 0.44704,
        **dict.fromkeys(("kn", "kt", "kts", "knot", "knots"), 1852 / 3600),
    },
    "mass": {
        **dict.fromkeys(("kg", "kgs", "kilogram", "kilograms"), 1.0),
        "g": 0.001,
        "t": 1000.0,
        "lb": 0.45359237,
        "lbs": 0.45359237,
    },
    "angle": {**dict.fromkeys(("deg", "degree", "degrees", "°"), 1.0), "rad": 180 / math.pi},
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
