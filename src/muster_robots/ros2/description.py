"""The fields of a ROS message, read from its dataclass, for its conversion to the types of DDS, rclpy and rosbags.

A message is a frozen dataclass with a `NAME` (`package/Type`) whose fields have the types below.
"""

from __future__ import annotations

from array import array as packed_array
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from functools import partial
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
UInt64 = Annotated[int, "uint64"]
UInt8 = Annotated[int, "uint8"]
Int64 = Annotated[int, "int64"]
Int16 = Annotated[int, "int16"]
Int8 = Annotated[int, "int8"]
Flag = Annotated[bool, "bool"]
Text = Annotated[str, "string"]
Bytes = Annotated[bytes, "uint8", Length(0)]
SignedBytes = Annotated[bytes, "int8", Length(0)]
"""Numbers from -128 to 127, each a byte."""


class Message:
    """Base of all messages."""

    NAME: ClassVar[str]


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


def to_foreign(
    message: Message,
    kind_of: Callable[[type[Message]], Any],
    *,
    ros: int = ROS2,
    array: Callable[[Any, str], Any] = lambda values, kind: list(values),
) -> Any:
    """A message as one of another library.

    Parameters
    ----------
    kind_of
        the library's class for a message; it takes all fields by their names.
    array
        the library's array of values of a primitive kind.
    """

    def value(field: Field, own: Any) -> Any:
        if isinstance(field.kind, str):
            if field.is_list and field.kind == "int8":
                own = memoryview(own).cast("b")
            return array(own, field.kind) if field.is_list else own
        convert = partial(to_foreign, kind_of=kind_of, ros=ros, array=array)
        return [convert(item) for item in own] if field.is_list else convert(own)

    kind = type(message)
    return kind_of(kind)(**{field.name: value(field, getattr(message, field.name)) for field in fields_of(kind, ros)})


def from_foreign(kind: type[M], foreign: Any, *, ros: int = ROS2) -> M:
    """A message by one of another library, whose fields have the same names."""

    def value(field: Field, theirs: Any) -> Any:
        if not field.is_list:
            return theirs if isinstance(field.kind, str) else from_foreign(field.kind, theirs, ros=ros)
        if isinstance(field.kind, str):
            if field.kind == "int8":
                return packed_array("b", theirs).tobytes()
            return bytes(theirs) if field.kind == "uint8" else tuple(map(float, theirs))
        return tuple(from_foreign(field.kind, one, ros=ros) for one in theirs)

    return kind(**{field.name: value(field, getattr(foreign, field.name)) for field in fields_of(kind, ros)})


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
