"""Messages of ROS as bytes: CDR as ROS 2 writes it, and the serialization of ROS 1.

CDR: OMG DDS-XTypes 1.3, 7.4.1 (XCDR version 1), little endian: a header of four bytes (00 01 00 00), then values, each
aligned to its own size, counted from the header's end; text ends in a zero byte, which its length counts. ROS 1
(wiki.ros.org, "msg"): the same without header, alignment and zero byte.
"""

from __future__ import annotations

import struct
from typing import Any, TypeVar, cast

from muster.bridges.ros2.description import ROS1, ROS2, Field, Message, fields_of
from muster.mission.errors import ParameterError

CDR_HEADER = b"\x00\x01\x00\x00"
_CODES = {"bool": "?", "uint8": "B", "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}
_SIZES = {word: struct.calcsize(code) for word, code in _CODES.items()}

M = TypeVar("M", bound=Message)


def to_cdr(message: Message) -> bytes:
    """As ROS 2 writes it.

    Raises
    ------
    ParameterError
        if a value does not fit its field.
    """
    return CDR_HEADER + _written(message, ROS2)


def to_ros1(message: Message) -> bytes:
    """As ROS 1 writes it; errors as of `to_cdr`."""
    return _written(message, ROS1)


def from_cdr(message: type[M], data: bytes) -> M:
    """The message that bytes of ROS 2 hold.

    Raises
    ------
    ParameterError
        if they hold no such message, or are not CDR version 1, little endian.
    """
    if data[:2] != CDR_HEADER[:2]:
        begins = data[:4].hex(" ")
        raise ParameterError(f"{message.NAME}: begins with {begins}; expected CDR, little endian: 00 01 00 00")
    return _read(message, data[4:], ROS2)


def from_ros1(message: type[M], data: bytes) -> M:
    """The message that bytes of ROS 1 hold; errors as of `from_cdr`."""
    return _read(message, data, ROS1)


def _written(message: Message, ros: int) -> bytes:
    out = _Writer(ros)
    try:
        out.message(message)
    except struct.error as error:
        raise ParameterError(f"{message.NAME}: {error}; expected values that fit its fields") from None
    return bytes(out.data)


def _read(message: type[M], data: bytes, ros: int) -> M:
    try:
        return cast("M", _Reader(data, ros).message(message))
    except (struct.error, UnicodeDecodeError) as error:
        raise ParameterError(f"{message.NAME}: {len(data)} bytes: {error}; expected such a message") from None


class _Writer:
    def __init__(self, ros: int) -> None:
        self.data, self._ros, self._aligned = bytearray(), ros, ros == ROS2

    def message(self, message: Message) -> None:
        for field in fields_of(type(message), self._ros):
            self._field(field, getattr(message, field.name))

    def _field(self, field: Field, value: Any) -> None:
        if not field.is_list:
            self._one(field.kind, value)
            return
        if not field.length:
            self._values("uint32", (len(value),))
        elif len(value) != field.length:
            raise ParameterError(f"{field.name}: {len(value)} values; expected {field.length}")
        if isinstance(field.kind, str):
            self._values(field.kind, value)
        else:
            for item in value:
                self.message(item)

    def _one(self, kind: str | type[Message], value: Any) -> None:
        if not isinstance(kind, str):
            self.message(value)
        elif kind == "string":
            text = value.encode() + (b"\0" if self._aligned else b"")
            self._values("uint32", (len(text),))
            self.data += text
        else:
            self._values(kind, (value,))

    def _values(self, kind: str, values: Any) -> None:
        if self._aligned and len(values):
            self.data += bytes(-len(self.data) % _SIZES[kind])
        self.data += struct.pack(f"<{len(values)}{_CODES[kind]}", *values)


class _Reader:
    def __init__(self, data: bytes, ros: int) -> None:
        self._data, self._at, self._ros, self._aligned = data, 0, ros, ros == ROS2

    def message(self, message: type[Message]) -> Message:
        values = {field.name: self._field(field) for field in fields_of(message, self._ros)}
        return message(**values)

    def _field(self, field: Field) -> Any:
        if not field.is_list:
            return self._one(field.kind)
        count = field.length or self._values("uint32", 1)[0]
        if field.kind == "uint8":
            return bytes(self._values("uint8", count))
        if isinstance(field.kind, str):
            return self._values(field.kind, count)
        if count > len(self._data):
            raise struct.error(f"a list of {count} is longer than the message")
        return tuple(self.message(field.kind) for _ in range(count))

    def _one(self, kind: str | type[Message]) -> Any:
        if not isinstance(kind, str):
            return self.message(kind)
        if kind != "string":
            return self._values(kind, 1)[0]
        (length,) = self._values("uint32", 1)
        text = self._data[self._at : self._at + length]
        if len(text) < length:
            raise struct.error(f"a text of {length} bytes is longer than the message")
        self._at += length
        return text.removesuffix(b"\0").decode() if self._aligned else text.decode()

    def _values(self, kind: str, count: int) -> tuple[Any, ...]:
        if self._aligned and count:
            self._at += -self._at % _SIZES[kind]
        if count * _SIZES[kind] > len(self._data) - self._at:
            raise struct.error("ends too early")
        values = struct.unpack_from(f"<{count}{_CODES[kind]}", self._data, self._at)
        self._at += count * _SIZES[kind]
        return values
