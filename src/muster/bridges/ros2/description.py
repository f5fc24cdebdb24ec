"""What a message of ROS is made of: read from its dataclass, for every way to write it.

A message is a frozen dataclass with a `NAME` (`package/Type`) whose fields have the types below. From them follow its
bytes (`cdr`), its definition as text (docs.ros.org, "Interface definition"; `gendeps --cat` of ROS 1), and the MD5 sum
by which ROS 1 knows it (wiki.ros.org, "ROS/Technical Overview", 4).
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import Annotated, Any, ClassVar, TypeVar, get_args, get_origin, get_type_hints

ROS1, ROS2 = 1, 2


@dataclass(frozen=True)
class Only:
    """Marks a field that one of the two has."""

    ros: int


@dataclass(frozen=True)
class Length:
    """Marks an array; 0: of any length."""

    count: int


Float64 = Annotated[float, "float64"]
Float32 = Annotated[float, "float32"]
Int32 = Annotated[int, "int32"]
UInt32 = Annotated[int, "uint32"]
Flag = Annotated[bool, "bool"]
Text = Annotated[str, "string"]
Bytes = Annotated[bytes, "uint8", Length(0)]


class Message:
    """Base of all messages."""

    NAME: ClassVar[str]
    CONSTANTS: ClassVar[dict[int, str]] = {}
    """Of each ROS the lines of constants in the definition; they are part of the MD5 sum."""
    PRIMITIVE: ClassVar[str] = ""
    """The word that ROS 1 has for it, where it is no message there."""


M = TypeVar("M", bound=Message)


@dataclass(frozen=True)
class Field:
    """A field: a primitive's word or a message, one of it (`length` None), that many, or any number (0)."""

    name: str
    kind: str | type[Message]
    length: int | None

    @property
    def is_list(self) -> bool:
        return self.length is not None


def fields_of(message: type[Message], ros: int) -> tuple[Field, ...]:
    """The fields that a message has in ROS 1 or ROS 2, in order."""
    if (message, ros) not in _READ:
        _READ[message, ros] = tuple(_fields(message, ros))
    return _READ[message, ros]


_READ: dict[tuple[type[Message], int], tuple[Field, ...]] = {}
"""Fields that were read before: reading annotations is slow, and they do not change."""


def to_foreign(message: Message, kind_of: Callable[[type[Message]], Any]) -> Any:
    """A message of ROS 2 as one of another library.

    Parameters
    ----------
    kind_of
        the library's class for a message; it takes all fields by their names, and arrays as lists.
    """

    def value(field: Field, own: Any) -> Any:
        if isinstance(field.kind, str):
            return list(own) if field.is_list else own
        return [to_foreign(item, kind_of) for item in own] if field.is_list else to_foreign(own, kind_of)

    kind = type(message)
    return kind_of(kind)(**{field.name: value(field, getattr(message, field.name)) for field in fields_of(kind, ROS2)})


def from_foreign(kind: type[M], foreign: Any) -> M:
    """A message of ROS 2 by one of another library, whose fields have the same names."""

    def value(field: Field, theirs: Any) -> Any:
        if not field.is_list:
            return theirs if isinstance(field.kind, str) else from_foreign(field.kind, theirs)
        if isinstance(field.kind, str):
            return bytes(theirs) if field.kind == "uint8" else tuple(theirs)
        return tuple(from_foreign(field.kind, one) for one in theirs)

    return kind(**{field.name: value(field, getattr(foreign, field.name)) for field in fields_of(kind, ROS2)})


def _fields(message: type[Message], ros: int) -> Iterator[Field]:
    hints = get_type_hints(message, include_extras=True)
    for field in fields(message):  # type: ignore[arg-type]
        hint = hints[field.name]
        marks = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
        if all(mark.ros == ros for mark in marks if isinstance(mark, Only)):
            yield _field(field.name, get_args(hint)[0] if marks else hint, marks)


def _field(name: str, kind: Any, marks: tuple[Any, ...]) -> Field:
    words = [mark for mark in marks if isinstance(mark, str)]
    lengths = [mark.count for mark in marks if isinstance(mark, Length)]
    if get_origin(kind) is tuple and not words:
        return Field(name, get_args(kind)[0], 0)
    return Field(name, words[0] if words else kind, lengths[0] if lengths else None)


def definition(message: type[Message], ros: int) -> str:
    """The definition of a message and of all that it is made of."""
    parts = [_lines(message, ros)]
    parts += [[f"MSG: {part.NAME}", *_lines(part, ros)] for part in _parts(message, ros)]
    return f"\n{'=' * 80}\n".join("\n".join(lines) for lines in parts) + "\n"


def type_name(message: type[Message], ros: int) -> str:
    """`nav_msgs/Odometry` in ROS 1, `nav_msgs/msg/Odometry` in ROS 2."""
    return message.NAME if ros == ROS1 else message.NAME.replace("/", "/msg/")


def md5_sum(message: type[Message]) -> str:
    """By which ROS 1 knows a message: of its definition, with the sums of its parts for their names."""
    lines = [message.CONSTANTS[ROS1]] if ROS1 in message.CONSTANTS else []
    for field in fields_of(message, ROS1):
        if isinstance(field.kind, str) or field.kind.PRIMITIVE:
            lines.append(_line(field, ROS1))
        else:
            lines.append(f"{md5_sum(field.kind)} {field.name}")
    return hashlib.md5("\n".join(lines).encode(), usedforsecurity=False).hexdigest()


def _lines(message: type[Message], ros: int) -> list[str]:
    constants = message.CONSTANTS[ros].split("\n") if ros in message.CONSTANTS else []
    return [*constants, *(_line(field, ros) for field in fields_of(message, ros))]


def _line(field: Field, ros: int) -> str:
    brackets = "" if field.length is None else f"[{field.length or ''}]"
    return f"{_word(field.kind, ros)}{brackets} {field.name}"


def _word(kind: str | type[Message], ros: int) -> str:
    if isinstance(kind, str):
        return kind
    return kind.PRIMITIVE if ros == ROS1 and kind.PRIMITIVE else kind.NAME


def _parts(message: type[Message], ros: int) -> list[type[Message]]:
    """The messages of which one is made, each once, in the order in which they are met."""
    return list(dict.fromkeys(_met(message, ros)))


def _met(message: type[Message], ros: int) -> Iterator[type[Message]]:
    for field in fields_of(message, ros):
        if not isinstance(field.kind, str) and not (ros == ROS1 and field.kind.PRIMITIVE):
            yield field.kind
            yield from _met(field.kind, ros)
