"""The types of values in a mission.

The fields of the model are declared once, each with its *kind* (`records.py`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from numbers import Real
from typing import Any, ClassVar, Literal, Protocol, TypeGuard

from muster.mission.texts.near_matches import did_you_mean

Path = tuple[str | int, ...]
JsonSchema = dict[str, Any]

RESERVED_NAMES = frozenset({"relay"})
"""Keys that a later version will give a meaning; until then they are refused, not ignored."""

FLAGS = {"true": True, "yes": True, "false": False, "no": False}
"""Words for values of parameters on a command line that are true or false."""

OTHER_NAMES = {
    "earliest_s": "window_s: [earliest, latest]",
    "latest_s": "window_s: [earliest, latest], or deadline_s where it must have ended by then",
    "time_window": "window_s: [from, until]",
    "abilities": "needs: {name: amount}; abilities are those of robots",
    "needs": "abilities: {name: amount}; needs are those of tasks",
    "recharge": "stations: [{id, position, services: [charge], charge_per_s}], and battery of robots",
    "demand": "load: amount; what it takes on board, or below 0 puts down",
}
"""Keys that people try, and what says it here."""


@dataclass(frozen=True)
class Fault:
    """One wrong value: its path in the mission (`("tasks", 3, "position")`), what it is, what was expected."""

    path: Path
    value: str
    expected: str
    relies_on: str = ""
    """`robots` or `tasks` where the value was looked for among their ids; not said where one of those is wrong."""


class Invalid:
    """The result of reading a value that had a fault."""


INVALID = Invalid()


class Kind(Protocol):
    """One kind of value: reads it from plain Python data, and describes itself in JSON Schema.

    A kind may also have `read_column(values)`: many values as `read` gives them, or None where it might refuse one; and
    `file_form(value)`, if its values stand in files in another form than in the model.
    """

    @property
    def expected(self) -> str:
        """How a message names what was expected."""

    @property
    def filler(self) -> Any:
        """What stands for a required value that is wrong while the rest is checked."""

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """The value in the model's own form; or INVALID, and what is wrong appended to `faults`."""

    def schema(self) -> JsonSchema: ...


def column_of(kind: Kind) -> Callable[[Sequence[Any]], Sequence[Any] | None] | None:
    """How a kind reads many values at once, if it can: it costs a fraction of reading each by itself."""
    return getattr(kind, "read_column", None)  # an instance check of a protocol would cost more than the reading


def read_column(kind: Kind, values: Sequence[Any]) -> Sequence[Any] | None:
    """Many values of one kind; None where `kind.read` might refuse one, which then says why."""
    if (column := column_of(kind)) is not None:
        return column(values)
    faults: list[Fault] = []
    read = [kind.read(value, (), faults) for value in values]
    return None if faults or INVALID in read else read


@dataclass(frozen=True)
class Key:
    """A key of a file whose values are of `kind`; `doc` says what it means."""

    kind: Kind
    doc: str


def shown(value: object, limit: int = 60) -> str:
    """A value as a message shows it: on one line, and short."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    text = json.dumps(_trimmed(value), ensure_ascii=False, default=lambda other: type(other).__name__)
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _trimmed(value: object, levels: int = 3) -> object:
    """The first items of the first levels of a value; more would not be shown, and aliases can make it endless."""
    if isinstance(value, list | tuple):
        return [_trimmed(item, levels - 1) for item in value[:6]] if levels else "..."
    if isinstance(value, dict):
        return {str(key): _trimmed(value[key], levels - 1) for key in list(value)[:6]} if levels else "..."
    return (
        value[:200]
        if isinstance(value, str)
        else value
        if not isinstance(value, int) or abs(value) < 10**60
        else "huge"
    )


def is_list(value: object) -> TypeGuard[Sequence[Any]]:
    """Whether a value is a list, or what serves as one; a text does not."""
    return type(value) is list or (isinstance(value, Sequence) and not isinstance(value, str))


def refuse(kind: Kind, value: object, at: Path, faults: list[Fault]) -> Invalid:
    """Put a value that is not of a kind on the list of faults; INVALID was refused before."""
    if value is not INVALID:
        faults.append(Fault(at, shown(value), kind.expected))
    return INVALID


@dataclass(frozen=True)
class Number:
    """A finite number, as float64."""

    filler: ClassVar[float] = 0.0
    minimum: float | None = None
    above: float | None = None
    maximum: float | None = None
    below: float | None = None

    @property
    def expected(self) -> str:
        bounds = [
            f"{word} {bound:g}"
            for word, bound in (
                ("at least", self.minimum),
                ("above", self.above),
                ("at most", self.maximum),
                ("below", self.below),
            )
            if bound is not None
        ]
        return ", ".join(["a finite number", *filter(None, [" and ".join(bounds)])])

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        number = self.of(value)
        return refuse(self, value, at, faults) if number is None else number

    def of(self, value: object) -> float | None:
        """The number that a value is; None if it is none of this kind."""
        if type(value) is not float:  # most are
            if isinstance(value, bool) or not isinstance(value, int | float | Real):
                return None
            try:
                value = float(value)
            except OverflowError:
                return None
        return value if self._holds(value) else None

    def read_column(self, values: Sequence[Any]) -> Sequence[float] | None:
        if not {float, int}.issuperset(map(type, values)):
            return None
        try:
            numbers = list(map(float, values))
        except OverflowError:
            return None
        in_bounds = all(map(math.isfinite, numbers)) and all(map(self._holds, (min(numbers), max(numbers))))
        return numbers if in_bounds else None

    def _holds(self, number: float) -> bool:
        return (
            math.isfinite(number)
            and (self.minimum is None or number >= self.minimum)
            and (self.above is None or number > self.above)
            and (self.maximum is None or number <= self.maximum)
            and (self.below is None or number < self.below)
        )

    def schema(self) -> JsonSchema:
        bounds = {
            "minimum": self.minimum,
            "exclusiveMinimum": self.above,
            "maximum": self.maximum,
            "exclusiveMaximum": self.below,
        }
        return {"type": "number"} | {key: bound for key, bound in bounds.items() if bound is not None}


class Share(Number):
    """A share that a command line and its help state in per cent."""


@dataclass(frozen=True)
class Whole:
    """A whole number of at least `minimum`, and at most `maximum`."""

    filler: ClassVar[int] = 0
    minimum: int = 0
    maximum: int | None = None

    @property
    def expected(self) -> str:
        return f"a whole number of at least {self.minimum}" + (f", at most {self.maximum}" if self.maximum else "")

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, bool) or not isinstance(value, int) or value < self.minimum:
            return refuse(self, value, at, faults)
        if self.maximum is not None and value > self.maximum:
            return refuse(self, value, at, faults)
        return value

    def schema(self) -> JsonSchema:
        most = {} if self.maximum is None else {"maximum": self.maximum}
        return {"type": "integer", "minimum": self.minimum} | most


@dataclass(frozen=True)
class Flag:
    """True or false."""

    filler: ClassVar[bool] = False
    expected: ClassVar[str] = "true or false"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        return value if isinstance(value, bool) else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        return {"type": "boolean"}


_JOINERS = str.maketrans("", "", "\u200c\u200d")
"""Of letters, as in Persian and Hindi, and of emoji: they are part of words, and no control characters."""


def is_one_line(text: str) -> bool:
    """Return whether a text has no ends of lines and no control characters."""
    return text.isprintable() or text.translate(_JOINERS).isprintable()


@dataclass(frozen=True)
class Text:
    """A text of one line that is not empty; a whole number is read as its decimal text (ids, types, skills)."""

    filler: ClassVar[str] = "?"
    expected: ClassVar[str] = "a text of one line"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, int) and not isinstance(value, bool) and abs(value) < 10**300:
            return str(value)
        if isinstance(value, str) and value.strip() and is_one_line(value):
            return value
        hint = "; in quotes it is one" if isinstance(value, int | float) else ""
        faults.append(Fault(at, shown(value), self.expected + hint))
        return INVALID

    def read_column(self, values: Sequence[Any]) -> Sequence[str] | None:
        if {str} != set(map(type, values)):
            return None
        return values if all(map(is_one_line, values)) and all(map(str.strip, values)) else None

    def schema(self) -> JsonSchema:
        return {"anyOf": [{"type": "string", "minLength": 1}, {"type": "integer"}]}


@dataclass(frozen=True)
class Choice:
    """One of a few words."""

    words: Collection[str]

    @property
    def filler(self) -> str:
        return next(iter(self.words))

    @property
    def expected(self) -> str:
        return " or ".join(self.words)

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str) and value in self.words:
            return value
        hint = did_you_mean(value, self.words) if isinstance(value, str) else ""
        faults.append(Fault(at, shown(value), self.expected + hint))
        return INVALID

    def schema(self) -> JsonSchema:
        return {"enum": list(self.words)}


_COORDINATE = Number()


@dataclass(frozen=True)
class Position:
    """`[x, y]` or `[x, y, z]` in metres, map frame; with `planar` only `[x, y]`. The third may be a yaw in radians."""

    filler: ClassVar[tuple[float, ...]] = ()  # neither flat nor spatial
    planar: bool = False
    third: Literal["z", "yaw"] = "z"

    @property
    def _lengths(self) -> tuple[int, ...]:
        return (2,) if self.planar else (2, 3)

    @property
    def expected(self) -> str:
        if self.planar:
            return "[x, y] in metres"
        return f"[x, y] or [x, y, {self.third}] in metres{' and radians' if self.third == 'yaw' else ''}"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        value = value.tolist() if hasattr(value, "tolist") else value  # a NumPy array
        if not is_list(value) or len(value) not in self._lengths:
            return refuse(self, value, at, faults)
        numbers = tuple(map(_COORDINATE.of, value))
        if None not in numbers:
            return numbers
        for k, number in enumerate(value):
            _COORDINATE.read(number, (*at, k), faults)
        return INVALID

    def read_column(self, values: Sequence[Any]) -> Sequence[tuple[float, ...]] | None:
        if {list} != set(map(type, values)) or len(lengths := set(map(len, values))) > 1:
            return None
        (length,) = lengths
        if length not in self._lengths:
            return None
        numbers = _COORDINATE.read_column([*chain.from_iterable(values)])
        return None if numbers is None else list(zip(*[iter(numbers)] * length, strict=True))

    def schema(self) -> JsonSchema:
        return {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2 if self.planar else 3}


@dataclass(frozen=True)
class Many:
    """A list of values of one kind."""

    filler: ClassVar[tuple[()]] = ()
    kind: Kind
    minimum: int = 0

    @property
    def expected(self) -> str:
        some = f" of at least {self.minimum}" if self.minimum else ""
        return f"a list{some}, each {self.kind.expected}"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if not is_list(value) or len(value) < self.minimum:
            return refuse(self, value, at, faults)
        column = column_of(self.kind) if value else None
        if column is not None and (read := column(value)) is not None:
            return tuple(read)
        items = [self.kind.read(item, (*at, k), faults) for k, item in enumerate(value)]
        return INVALID if any(item is INVALID for item in items) else tuple(items)

    def schema(self) -> JsonSchema:
        least = {"minItems": self.minimum} if self.minimum else {}
        return {"type": "array", "items": self.kind.schema()} | least


@dataclass(frozen=True)
class OneOrMany(Many):
    """A list of values of one kind, of which one may stand by itself."""

    @property
    def expected(self) -> str:
        return f"{self.kind.expected}, or a list of such"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str | int) and not isinstance(value, bool):
            item = self.kind.read(value, at, faults)
            return INVALID if item is INVALID else (item,)
        return super().read(value, at, faults)

    def file_form(self, value: tuple[Any, ...]) -> Any:
        """One value by itself, several as a list."""
        return value[0] if len(value) == 1 else value

    def schema(self) -> JsonSchema:
        return {"anyOf": [self.kind.schema(), super().schema()]}


@dataclass(frozen=True)
class Table:
    """A mapping from names to values of one kind."""

    kind: Kind
    of: str
    filler: ClassVar[None] = None

    @property
    def expected(self) -> str:
        return self.of

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if not isinstance(value, Mapping) or not value:
            return refuse(self, value, at, faults)
        names = [Text().read(key, (*at, str(key)), faults) for key in value]
        items = [self.kind.read(item, (*at, str(key)), faults) for key, item in value.items()]
        wrong = any(part is INVALID for part in (*names, *items))
        return INVALID if wrong else dict(zip(names, items, strict=True))

    def schema(self) -> JsonSchema:
        return {"type": "object", "additionalProperties": self.kind.schema(), "minProperties": 1}
