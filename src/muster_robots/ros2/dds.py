"""A DDS participant that is compatible with ROS 2 nodes in topic names, type names and encoding.

A topic `/r_0/pose` of ROS 2 is `rt/r_0/pose` in DDS, and the type `geometry_msgs/msg/PoseStamped` is
`geometry_msgs::msg::dds_::PoseStamped_` (design.ros2.org, "Topic and Service name mapping to DDS"). Samples are
polled. Which networks are used is told to Cyclone DDS by the environment: ROS_DOMAIN_ID and CYCLONEDDS_URI.
"""

from __future__ import annotations

import dataclasses
import re
import time
import types
from collections.abc import Iterable
from typing import Any, Generic, TypeVar

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.system.extras import needs_extra
from muster_robots.ros2.description import ROS2, Field, Message, fields_of, from_foreign, to_foreign
from muster_robots.ros2.middleware import KEPT, LATCHED, Navigator, domain_or_own, line_of

M = TypeVar("M", bound=Message)


class DdsMiddleware:
    """Takes part in a domain until it is closed: a `Middleware`.

    Raises
    ------
    MissingExtraError
        if the extra `ros2` is not installed.
    ParameterError
        if the domain, or ROS_DOMAIN_ID, is no number from 0 to 232.
    NetworkError
        if DDS cannot take part, such as for what CYCLONEDDS_URI says.
    """

    def __init__(self, domain: int | None = None) -> None:
        self._dds = _Dds()
        number = domain_or_own(domain)
        try:
            self._participant: Any = self._dds.participant(number)
        except self._dds.error as error:
            raise NetworkError(f"DDS domain {number}: {line_of(error)}; see CYCLONEDDS_URI") from None
        self._publications = self._dds.publications(self._participant)
        self._published: dict[Any, tuple[str, str]] = {}  # by the writers' keys

    def writer(self, topic: str, message: type[M]) -> DdsWriter[M]:
        """See `Middleware`."""
        return DdsWriter(self._dds, self._participant, topic, message)

    def reader(self, topic: str, message: type[M], *, latched: bool = False) -> DdsReader[M]:
        """See `Middleware`."""
        return DdsReader(self._dds, self._participant, topic, message, latched=latched or topic in LATCHED)

    def navigator(self, action: str) -> Navigator:
        """Actions are calls, and every make of DDS has its own header for what ROS 2 calls."""
        expected = "rclpy (--by rclpy), or goals as poses (--give goals)"
        raise ParameterError(f"{action}: an action, by DDS; expected {expected}")

    def topics(self) -> Iterable[tuple[str, str]]:
        """See `Middleware`."""
        while samples := self._publications.take(KEPT):
            for sample in samples:
                if sample.topic_name is None:  # its writer has ended
                    self._published.pop(sample.key, None)
                else:
                    self._published[sample.key] = sample.topic_name, sample.type_name
        for topic, kind in self._published.values():
            name = _DDS_TYPE.fullmatch(kind)
            if topic.startswith(_TOPICS) and name is not None:
                yield topic.removeprefix(_TOPICS), f"{name[1]}/{name[2]}"

    def wait(self, seconds: float) -> None:
        """See `Middleware`: Cyclone DDS receives in threads of its own."""
        time.sleep(seconds)

    def close(self) -> None:
        """See `Middleware`."""
        self._participant = self._publications = None


class DdsWriter(Generic[M]):
    """See `middleware.Writer`."""

    def __init__(self, dds: _Dds, participant: Any, topic: str, message: type[M]) -> None:
        self._topic, self._error = topic, dds.error
        self._writer = dds.writer(participant, _dds_topic(topic), _idl(message))

    def write(self, message: M) -> None:
        try:
            self._writer.write(to_foreign(message, _idl))
        except self._error as error:
            raise NetworkError(f"{self._topic}: DDS: {line_of(error)}") from None

    @property
    def listeners(self) -> int:
        return len(self._writer.get_matched_subscriptions())


class DdsReader(Generic[M]):
    """See `middleware.Reader`."""

    def __init__(self, dds: _Dds, participant: Any, topic: str, message: type[M], *, latched: bool) -> None:
        self._message = message
        self._reader = dds.reader(participant, _dds_topic(topic), _idl(message), latched=latched)

    def take(self) -> list[M]:
        samples = self._reader.take(KEPT)
        kind = _idl(self._message)
        return [from_foreign(self._message, sample) for sample in samples if isinstance(sample, kind)]


class _Dds:
    """The parts of cyclonedds that are used, in the quality of service that nodes of ROS 2 match."""

    def __init__(self) -> None:
        with needs_extra("ros2", "ROS 2 by DDS"):
            from cyclonedds import builtin, core, domain, pub, qos, sub, topic
        policy: Any = qos.Policy
        old = policy.DataRepresentation(use_cdrv0_representation=True)  # XCDR1 is what ROS 2 speaks
        kept = policy.History.KeepLast(KEPT)
        self._publishing = qos.Qos(old, kept, policy.Reliability.Reliable(10**8))
        self._hearing = qos.Qos(old, kept, policy.Reliability.BestEffort)
        lasting = (policy.Reliability.Reliable(10**8), policy.Durability.TransientLocal)
        self._hearing_latched = qos.Qos(old, kept, *lasting)
        self._topic: Any = topic.Topic
        self._writer: Any = pub.DataWriter
        self._reader: Any = sub.DataReader
        self._builtin: Any = builtin
        self.participant: Any = domain.DomainParticipant
        self.error: Any = core.DDSException

    def writer(self, participant: Any, topic: str, kind: Any) -> Any:
        return self._writer(participant, self._topic(participant, topic, kind), qos=self._publishing)

    def reader(self, participant: Any, topic: str, kind: Any, *, latched: bool) -> Any:
        quality = self._hearing_latched if latched else self._hearing
        return self._reader(participant, self._topic(participant, topic, kind), qos=quality)

    def publications(self, participant: Any) -> Any:
        """The reader of what others publish, and how (DDS 1.4, 2.2.5: DCPSPublication)."""
        return self._builtin.BuiltinDataReader(participant, self._builtin.BuiltinTopicDcpsPublication)


_TOPICS = "rt"
_DDS_TYPE = re.compile(r"(\w+)::msg::dds_::(\w+)_")


def _dds_topic(topic: str) -> str:
    return f"{_TOPICS}/{topic.strip('/')}"


def _dds_type(message: type[Message]) -> str:
    package, _, name = message.NAME.partition("/")
    return f"{package}::msg::dds_::{name}_"


_MADE: dict[type[Message], Any] = {}


def _idl(message: type[Message]) -> Any:
    """The type of a message as cyclonedds has types, made from its description."""
    if message not in _MADE:
        from cyclonedds.idl import IdlStruct

        notes = {field.name: _idl_field(field) for field in fields_of(message, ROS2)}
        body = {"__annotations__": notes, "__module__": __name__}
        name = _dds_type(message)
        how = {"typename": name}
        made = types.new_class(name.rpartition("::")[2], (IdlStruct,), how, lambda room: room.update(body))
        _MADE[message] = dataclasses.dataclass(made)
    return _MADE[message]


def _idl_field(field: Field) -> Any:
    from cyclonedds.idl import types as idl_types

    idl: Any = idl_types
    words: Any = {"string": str, "bool": bool}
    one = words.get(field.kind) or (getattr(idl, field.kind) if isinstance(field.kind, str) else _idl(field.kind))
    if not field.is_list:
        return one
    return idl.array[one, field.length] if field.length else idl.sequence[one]
