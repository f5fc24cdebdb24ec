"""The values in cells, as people and spreadsheets write them: decimal commas, degrees and minutes, clock times.

Each function returns the value as a mission file has it, or raises `CellError`, which says what was expected. Cells
hold texts, and from spreadsheets and JSON also numbers, flags, dates, times of day, spans of time and lists.
"""

from __future__ import annotations

import json
import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, datetime, time, timedelta
from typing import Any

from muster.mission.values.time_types import moment_in
from muster_files.sites.units import UNITS, Dimension, units_text

_SPACES = str.maketrans(dict.fromkeys("\u00a0\u2009\u202f", " ") | {"\u2212": "-", "\u2019": "'"})
_NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d+)?")
_GROUPED = re.compile(r"[-+]?\d{1,3}(?P<group>[., '])\d{3}((?P=group)\d{3})*(?!(?P=group))([.,]\d+)?")
_UNIT = re.compile(r"(?P<number>[-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(?P<unit>[^\d\s.,]+)")
_AMOUNT = re.compile(r"(?P<number>[-+]?[\d.,]+)\s+(?P<name>[^\W\d]\S*)")
_SPAN = re.compile(r"(\d+):([0-5]\d)(?::([0-5]\d(?:[.,]\d+)?))?")
_ISO_SPAN = re.compile(r"P(?:(\d+)D)?(?:T(?:(\d+)H)?(?:(\d+)M)?(?:(\d+(?:\.\d+)?)S)?)?", re.IGNORECASE)
_DEGREES = re.compile(
    r"(?P<first>[NSEW])?\s*(?P<sign>[-+])?(?P<deg>\d+(?:[.,]\d+)?)\s*[°ºd]?\s*"
    r"(?:(?P<min>\d+(?:[.,]\d+)?)\s*['\u2032]\s*)?(?:(?P<sec>\d+(?:[.,]\d+)?)\s*(?:\"|\u2033|'')\s*)?(?P<last>[NSEW])?",
    re.IGNORECASE,
)
_CLOCK = re.compile(r"(\d{1,2})(?::([0-5]\d)(?::([0-5]\d(?:\.\d+)?))?)?\s*([ap]\.?m\.?)?", re.IGNORECASE)
_OF_CLOCK = re.compile(r"\s*uhr$", re.IGNORECASE)
_DATED = re.compile(r"(\d{1,2})\.(\d{1,2})\.(\d{4})[\s,]+(\d{1,2}):(\d\d)(?::(\d\d))?(?:\s*uhr)?", re.IGNORECASE)
_CLOCK_WITHOUT_COLON = re.compile(r"0\d[0-5]\d")
_YES = frozenset(("true", "yes", "y", "x", "1", "on"))
_JOINERS = "\u200c\u200d"
"""Of letters and of emoji: part of the text, though they are seen only in what they join."""
_UNLIMITED = ("inf", ".inf", "infinity", "unlimited", "none")
_NO = frozenset(("false", "no", "n", "0", "off", "-"))


class CellError(ValueError):
    """A cell holds something else than was expected; `args[0]` says what that is."""


@dataclass(frozen=True)
class NoValue:
    """What stands in a cell that has no value, as an error does; and what was expected."""

    told: str
    expected: str

    def __str__(self) -> str:
        return self.told


def text(value: object) -> str:
    """One line of text; whole numbers of spreadsheets without their decimals."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    if isinstance(value, bool) or not isinstance(value, str | int | float | datetime | date | time):
        raise CellError("a text")
    found = " ".join(visible(str(value)).split())
    if any(unicodedata.category(c) in ("Cc", "Cs") for c in found):
        raise CellError("a text without control characters")
    return found


def visible(text: str) -> str:
    """The text without marks that nobody sees, such as soft hyphens and those of direction; joiners stay."""
    if text.isascii():
        return text
    return "".join(c for c in text if c in _JOINERS or unicodedata.category(c) != "Cf")


def number(value: object, dimension: Dimension = "", factor: float = 1.0) -> float:
    """A number in SI units, of a column whose unit is so many of them; a unit beside the number is stronger."""
    expected = "a number" + (f" in {units_text(dimension)}" if dimension else "")
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise CellError(expected)
    if not isinstance(value, str):
        return _finite(float(value) * factor if abs(value) < 1e300 else math.inf, expected)
    told = value.translate(_SPACES).strip()
    beside = _UNIT.fullmatch(told)
    if beside is not None and (unit := UNITS[dimension].get(beside["unit"].casefold())) is not None:
        told, factor = beside["number"], unit
    plain = _plain(told)
    if plain is None:
        raise CellError(expected)
    return _finite(float(plain) * factor, expected)


def amount(value: object, factor: float = 1.0) -> float | dict[str, float]:
    """A number, a mass in kg; or amounts by commodity, `2 parcels, 1.5 water_l`."""
    try:
        return number(value, "mass", factor)
    except CellError:
        parts = re.split(r"\s*;\s*|\s*,\s+", value.strip()) if isinstance(value, str) else []
        named = [_AMOUNT.fullmatch(part) for part in parts]
        found = {one["name"]: number(one["number"]) for one in named if one is not None}
        if not found or len(found) < len(parts):
            expected = "a number, 12 kg, or amounts by commodity: 2 parcels, 1.5 water_l"
            raise CellError(expected) from None
        return found


def _plain(told: str) -> str | None:
    """The digits of a number as Python has them; None where it is none, or might be read in two ways."""
    grouped = _GROUPED.fullmatch(told)
    if grouped is not None:
        group, decimals = grouped["group"], grouped[3]
        if group in "., " and (decimals is not None or told.count(group) > 1 or group == " "):
            whole = told[: len(told) - len(decimals or "")].replace(group, "")
            return whole + (decimals or "").replace(",", ".") if (decimals or " ")[0] != group else None
        if group == "'":
            return told.replace(group, "").replace(",", ".")
    return told.replace(",", ".") if _NUMBER.fullmatch(told) else None


def _finite(found: float, expected: str) -> float:
    if math.isnan(found):
        raise CellError(f"{expected}, with its unit beside it or in the heading")
    if not math.isfinite(found):
        raise CellError(f"{expected}, finite")
    return found


def limit(value: object) -> float | None:
    """A number; None of what says that there is no limit."""
    if isinstance(value, str) and value.strip().casefold() in _UNLIMITED:
        return None
    return number(value)


def is_bare_number(value: object) -> bool:
    """Return whether a cell holds a number without a unit."""
    if isinstance(value, str):
        return _plain(value.translate(_SPACES).strip()) is not None
    return isinstance(value, int | float) and not isinstance(value, bool)


def above_0(found: float) -> float:
    """The number; refused unless it is more than 0."""
    if not found > 0:
        raise CellError("more than 0")
    return found


def radius(value: object, factor: float = 1.0) -> float:
    """Metres; a number below 1 without a unit may be one of kilometres, and is refused."""
    found = above_0(number(value, "length", factor))
    if is_bare_number(value) and factor == 1.0 and found < 1:
        raise CellError(f"a radius with its unit, as {found:g} km or {found:g} m")
    return found


def whole(value: object) -> int:
    """A whole number."""
    found = number(value)
    if not found.is_integer():
        raise CellError("a whole number")
    return int(found)


def flag(value: object) -> bool:
    """Yes or no."""
    told = str(value).strip().casefold()
    told = told.removesuffix(".0")
    if told in _YES or told in _NO:
        return told in _YES
    raise CellError("yes or no, true or false")


def words(value: object) -> list[str]:
    """Several texts, between which stand `;`, `,`, `|` or the ends of lines; or a list."""
    if isinstance(value, str):
        value = _json_list(value) or re.split(r"[;,|\n]", value.strip().strip("[]"))
    items: Sequence[Any] = value if isinstance(value, list | tuple) else [value]
    return [found for item in items if (found := text(item).strip("\"' "))]


def _json_list(told: str) -> list[Any] | None:
    if not told.lstrip().startswith("["):
        return None
    try:
        found = json.loads(told)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, list) and all(isinstance(item, str | int | float) for item in found) else None


def duration(value: object, factor: float = 1.0) -> float:
    """Seconds, of `90`, `90 s`, `15 min`, `1 h 30 min`, `00:15` (hours and minutes), `00:15:30`, `PT15M`."""
    expected = "a duration: seconds, 90 s, 15 min, 1 h 30 min, 00:15 (hours:minutes) or 00:15:30"
    if isinstance(value, timedelta):
        seconds = value.total_seconds()
    elif isinstance(value, time):
        seconds = 3600.0 * value.hour + 60 * value.minute + value.second + value.microsecond / 1e6
    elif isinstance(value, str):
        seconds = _seconds(value.translate(_SPACES).strip(), factor, expected)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        seconds = number(value, "time", factor)
    else:
        raise CellError(expected)
    if seconds < 0:
        raise CellError(f"{expected}, at least 0")
    return round(seconds, 6)


def _seconds(told: str, factor: float, expected: str) -> float:
    if (span := _SPAN.fullmatch(told)) is not None:
        return 3600.0 * int(span[1]) + 60 * int(span[2]) + float((span[3] or "0").replace(",", "."))
    if (span := _ISO_SPAN.fullmatch(told)) is not None and any(span.groups()):
        return sum(float(part or 0) * size for part, size in zip(span.groups(), (86400, 3600, 60, 1), strict=True))
    parts = list(_UNIT.finditer(told))
    if len(parts) > 1 and not _UNIT.sub("", told).strip():
        return sum(_in_unit(part, expected) for part in parts)
    try:
        return number(told, "time", factor)
    except CellError:
        raise CellError(expected) from None


def _in_unit(part: re.Match[str], expected: str) -> float:
    unit = UNITS["time"].get(part["unit"].casefold())
    if unit is None:
        raise CellError(expected)
    return number(part["number"]) * unit


def moment(value: object, factor: float = 1.0) -> str | float:
    """A clock time (`10:00`, `2:30 pm`, `8.30 Uhr`) or a date and a time, by ISO 8601; or seconds, from numbers.

    Dates may be by ISO 8601, or `01.03.2027 08:30`, with the day first.
    """
    expected = 'a clock time, as "10:00", a date and a time, as 2027-03-01T10:00, or seconds from the start'
    if isinstance(value, datetime):
        return value.isoformat()
    if isinstance(value, time):
        return value.isoformat()
    if isinstance(value, str):
        told = value.translate(_SPACES).strip()
        if moment_in(told) is not None:
            return told
        if (dated := _DATED.fullmatch(told)) is not None:
            return _dated(dated, expected)
        own = _OF_CLOCK.sub("", told)
        clock = _CLOCK.fullmatch(own if own == told else own.replace(".", ":"))
        if clock is not None and (clock[2] or clock[4] or own != told):
            return _clock(clock, expected)
        if _CLOCK_WITHOUT_COLON.fullmatch(told):
            raise CellError(f'"{told[:2]}:{told[2:]}", or seconds that do not begin with 0')
    try:
        seconds = number(value, "time", factor)
    except CellError:
        raise CellError(expected) from None
    if seconds < 0:
        raise CellError(expected)
    return seconds


def _dated(found: re.Match[str], expected: str) -> str:
    day, month, year, hour, minute, second = (int(part or 0) for part in found.groups())
    try:
        return datetime(year, month, day, hour, minute, second).isoformat()
    except ValueError:
        raise CellError(expected) from None


def _clock(found: re.Match[str], expected: str) -> str:
    hour, half = int(found[1]), (found[4] or "").replace(".", "").casefold()
    if half and not 1 <= hour <= 12:
        raise CellError(expected)
    hour = hour % 12 + (12 if half == "pm" else 0) if half else hour
    if hour > 23 and (hour, found[2], found[3] or "00") != (24, "00", "00"):
        raise CellError(expected)
    return f"{hour:02}:{found[2] or '00'}" + (f":{found[3]}" if found[3] else "")


def pairs(value: object, factor: float = 1.0) -> list[list[str | float | None]]:
    """Windows: `10:00-14:00`, `600-1200`, several with `;` between them; or a list of two ends, or of such lists."""
    expected = "a window, as 10:00-14:00 or 600-1200; several as 10:00-11:00; 15:00-16:00"
    if isinstance(value, str) and not value.strip().startswith("["):
        parts: list[Any] = [_ends(part) for part in value.translate(_SPACES).split(";") if part.strip()]
    else:
        given = json_value(value, expected)
        parts = [given] if given and not any(isinstance(end, list | tuple) for end in given) else list(given)
    found: list[list[str | float | None]] = []
    for part in parts:
        if not isinstance(part, list | tuple) or len(part) != 2:
            raise CellError(expected)
        found.append([None if _is_open(end) else moment(end, factor) for end in part])
    if not found:
        raise CellError(expected)
    return found


def _ends(part: str) -> list[str]:
    """The two ends of a window in a text; a date has dashes, too."""
    dashes = re.split(r"\s+(?:-|\u2013|\u2014|to|until)\s+|\s*[\u2013\u2014]\s*", part.strip())
    if len(dashes) != 2:
        dashes = part.strip().split("-")
    return dashes if len(dashes) == 2 else part.split()


def _is_open(end: object) -> bool:
    return end is None or (isinstance(end, str) and end.strip().casefold() in ("", "null", "inf", ".inf"))


def json_value(value: object, expected: str) -> Any:
    """A list or a mapping, from JSON where it is a text."""
    if isinstance(value, str):
        try:
            value = json.loads(value)
        except (ValueError, RecursionError):
            raise CellError(expected) from None
    if not isinstance(value, list | tuple | dict):
        raise CellError(expected)
    return value


def degrees(value: object, most: float, factor: float = 1.0) -> float:
    """A latitude (`most` 90) or a longitude (180): decimal degrees, or degrees, minutes and seconds with N, S, E, W.

    A plain number is so many degrees of `factor`.
    """
    axis = "latitude" if most == 90 else "longitude"
    expected = f"a {axis} from -{most:g} to {most:g} degrees"
    if isinstance(value, str):
        found = _degrees_in(value.translate(_SPACES).strip(), "NS" if most == 90 else "EW", expected, factor)
    else:
        found = number(value, "angle", factor)
    if not abs(found) <= most:
        raise CellError(expected)
    return found


def _degrees_in(told: str, sides: str, expected: str, factor: float) -> float:
    match = _DEGREES.fullmatch(told)
    if match is None or (factor != 1.0 and _NUMBER.fullmatch(told)):
        try:
            return number(told, "angle", factor)
        except CellError:
            raise CellError(expected) from None
    side = (match["first"] or match["last"] or "").upper()
    if side and (side not in sides or (match["first"] and match["last"])):
        raise CellError(expected)
    parts = [float((match[name] or "0").replace(",", ".")) for name in ("deg", "min", "sec")]
    if max(parts[1:]) >= 60:
        raise CellError(expected)
    size = parts[0] + parts[1] / 60 + parts[2] / 3600
    return -size if (match["sign"] == "-") != (side in ("S", "W")) else size


def lat_lon(value: object, factor: float = 1.0) -> tuple[float, ...]:
    """Latitude and longitude, and perhaps an altitude, in one cell: `35.53, 24.06`, `35,53; 24,06`, `N35.53 E24.06`.

    Plain numbers are so many degrees of `factor`.
    """
    expected = "latitude and longitude in degrees, as 35.53, 24.06"
    parts: list[Any]
    if isinstance(value, str):
        told = value.translate(_SPACES).strip().strip("[]()")
        parts = next(
            (
                found
                for found in map(re.compile, (r"\s*;\s*", r",\s+|\s+,", r",", r"\s+"))
                if len(found.split(told)) in (2, 3)
            ),
            re.compile(","),
        ).split(told)
    else:
        parts = list(value) if isinstance(value, list | tuple) else []
    if len(parts) not in (2, 3):
        raise CellError(expected)
    try:
        altitude = [number(parts[2], "length")] if len(parts) == 3 else []
        return (degrees(parts[0], 90, factor), degrees(parts[1], 180, factor), *altitude)
    except CellError as error:
        raise CellError(f"{expected}: {error.args[0]}") from None


def point(value: object) -> list[float]:
    """`[x, y]` or `[x, y, z]` in metres, in one cell."""
    expected = "x and y in metres, as [12.5, 3]"
    given = value.strip().strip("[]()") if isinstance(value, str) else value
    parts = re.split(r"\s*[;,]\s*|\s+", given) if isinstance(given, str) else given
    if not isinstance(parts, list | tuple) or len(parts) not in (2, 3):
        raise CellError(expected)
    return [number(part, "length") for part in parts]
