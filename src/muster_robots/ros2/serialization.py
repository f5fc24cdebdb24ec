"""Messages of ROS as bytes, and their definitions, by rosbags: CDR as ROS 2 writes it, the serialization of ROS 1.

Only little-endian CDR is read. The tests compare bytes, and the MD5 sums by which ROS 1 knows messages with those of
Debian's packages.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any, TypeVar

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.system.extras import needs_extra
from muster_robots.ros2.description import ROS1, ROS2, Message, from_foreign, to_foreign

CDR_HEADER = b"\x00\x01\x00\x00"
_ARRAYS = {"uint8": np.uint8, "int8": np.int8, "float32": np.float32, "float64": np.float64}

M = TypeVar("M", bound=Message)


def to_cdr(message: Message) -> bytes:
    """As ROS 2 writes it.

    Raises
    ------
    ParameterError
        if a value does not fit its field.
    MissingExtraError
        if the extra `record` is not installed.
    """
    return _written(message, ROS2)


def to_ros1(message: Message) -> bytes:
    """As ROS 1 writes it; errors as of `to_cdr`."""
    return _written(message, ROS1)


def from_cdr(message: type[M], data: bytes) -> M:
    """The message that bytes of ROS 2 hold.

    Raises
    ------
    ParameterError
        if they hold no such message, or are not CDR version 1, little endian.
    MissingExtraError
        if the extra `record` is not installed.
    """
    if data[:2] != CDR_HEADER[:2]:
        begins = data[:4].hex(" ")
        raise ParameterError(f"{message.NAME}: begins with {begins}; expected CDR, little endian: 00 01 00 00")
    return _read(message, data, ROS2)


def from_ros1(message: type[M], data: bytes) -> M:
    """The message that bytes of ROS 1 hold; errors as of `from_cdr`."""
    return _read(message, data, ROS1)


def type_name(message: type[Message]) -> str:
    """`nav_msgs/msg/Odometry`."""
    return message.NAME.replace("/", "/msg/")


def definition(message: type[Message], ros: int) -> str:
    """The definition of a message and of all that it is made of, as text."""
    return _definition(type_name(message), ros)[0]


def md5_sum(message: type[Message]) -> str:
    """By which ROS 1 knows a message."""
    return _definition(type_name(message), ROS1)[1]


@cache
def _definition(name: str, ros: int) -> tuple[str, str]:
    text, md5 = _store(ros).generate_msgdef(name, ros_version=ros)
    return str(text), str(md5)


@cache
def _store(ros: int) -> Any:
    """The message types of ROS Noetic or ROS 2 Humble, with those of tf2_msgs, which rosbags does not have."""
    with needs_extra("record", "messages of ROS in files"):
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    store = get_typestore(Stores.ROS1_NOETIC if ros == ROS1 else Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
    return store


def _written(message: Message, ros: int) -> bytes:
    store, name = _store(ros), type_name(type(message))
    try:
        foreign = to_foreign(message, lambda kind: store.types[type_name(kind)], ros=ros, array=_array)
        return bytes(store.serialize_cdr(foreign, name) if ros == ROS2 else store.serialize_ros1(foreign, name))
    except _unfit() as error:
        raise ParameterError(f"{message.NAME}: {error}; expected values that fit its fields") from None


def _read(message: type[M], data: bytes, ros: int) -> M:
    store, name = _store(ros), type_name(message)
    if name not in store.fielddefs:
        raise ParameterError(f"{message.NAME}: expected a message of ROS {ros}")
    try:
        foreign = store.deserialize_cdr(data, name) if ros == ROS2 else store.deserialize_ros1(data, name)
    except _unfit() as error:
        raise ParameterError(f"{message.NAME}: {len(data)} bytes: {error}; expected such a message") from None
    return from_foreign(message, foreign, ros=ros)


def _unfit() -> tuple[type[Exception], ...]:
    """What rosbags raises for values and bytes that are no such message."""
    from rosbags.serde import SerdeError

    return struct.error, SerdeError, ValueError


def _array(values: Any, kind: str) -> Any:
    return np.frombuffer(values, np.uint8) if kind == "uint8" else np.array(values, _ARRAYS[kind])
