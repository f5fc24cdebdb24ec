"""A DDS participant that is compatible with ROS 2 nodes in topic names, type names and encoding.

A topic `/r_0/pose` of ROS 2 is `rt/r_0/pose` in DDS, and the type `geometry_msgs/msg/PoseStamped` is
`geometry_msgs::msg::dds_::PoseStamped_` (design.ros2.org, "Topic and Service name mapping to DDS"). Samples are
polled. Which networks are used is told to Cyclone DDS by the environment: ROS_DOMAIN_ID and CYCLONEDDS_URI.
"""

from __future__ import annotations

import dataclasses
import os
import re
import time
import types
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any, Generic, TypeVar

from muster.mission.errors import NetworkError
from muster.mission.system.extras import needs_extra
from muster_robots.navigation import Navigator
from muster_robots.ros2.dds_actions import DdsNavigator
from muster_robots.ros2.dds_endpoints import Endpoint, Endpoints
from muster_robots.ros2.description import ROS2, Field, Message, fields_of, from_foreign, to_foreign
from muster_robots.ros2.message_types import PoseStamped
from muster_robots.ros2.middleware import KEPT, domain_or_own, is_latched, line_of

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
        self.error = self._dds.error
        self._others: list[DdsReader[Any]] = []
        self.publications = Endpoints(self._dds.publications(self._participant))
        self.subscriptions = Endpoints(self._dds.subscriptions(self._participant))

    def writer(self, topic: str, message: type[M]) -> DdsWriter[M]:
        """See `Middleware`."""
        return DdsWriter(self._dds, self._participant, topic, message)

    def reader(self, topic: str, message: type[M], *, latched: bool = False) -> DdsReader[M]:
        """See `Middleware`."""
        return DdsReader(self._dds, self._participant, topic, message, latched=latched or is_latched(topic))

    def others(self, topic: str, message: type[M]) -> DdsReader[M]:
        """See `Middleware`: neither matches the writers of this participant, nor counts as their listener."""
        reader = DdsReader(self._dds, self._participant, topic, message, latched=False, ignores_own=True)
        self._others.append(reader)
        return reader

    def navigator(self, action: str) -> Navigator[PoseStamped]:
        """See `Middleware`."""
        return DdsNavigator(self, action)

    def topics(self) -> Iterable[tuple[str, str]]:
        """See `Middleware`."""
        for endpoint in self.publications.all():
            name = _DDS_TYPE.fullmatch(endpoint.kind)
            if endpoint.topic.startswith(_TOPICS) and name is not None:
                yield endpoint.topic.removeprefix(_TOPICS), f"{name[1]}/{name[2]}"

    def client(
        self, topics: tuple[str, str], messages: tuple[type[Message], type[Message]], theirs: tuple[Endpoint, Endpoint]
    ) -> tuple[Any, Any] | None:
        """Make the writer of requests and the reader of replies of a service.

        Parameters
        ----------
        topics : tuple[str, str]
            Of requests and replies, as in DDS.
        messages : tuple[type, type]
            Their types.
        theirs : tuple[Endpoint, Endpoint]
            A server's ends: where they tell their types, those are taken, so that both match.

        Returns
        -------
        tuple or None
            None while a type that they have is not known yet.
        """
        try:
            kinds = [self._dds.kind_of(self._participant, *one) for one in zip(messages, theirs, strict=True)]
            identity = f"clientid={os.urandom(16).hex('.')};".encode()  # by which the server knows both ends
            return (
                self._dds.writer(self._participant, topics[0], kinds[0], identity),
                self._dds.reader(self._participant, topics[1], kinds[1], identity),
            )
        except self.error:
            return None

    def encoded(self, message: Message, kind: Any) -> Any:
        """Return a message as a sample of the type that a writer has."""
        sample = object.__new__(kind)
        data = to_foreign(message, _idl).serialize()
        sample.__dict__["serialize"] = lambda **_: data
        return sample

    def decoded(self, message: type[M], reader: Any) -> list[tuple[M, bytes]]:
        """Return what a reader has received, as messages and as bytes."""
        samples = reader.take(KEPT)
        return [
            (from_foreign(message, _idl(message).deserialize(one.data)), one.data)
            for one in samples
            if getattr(one, "data", b"")
        ]

    def wait(self, seconds: float) -> None:
        """See `Middleware`: Cyclone DDS receives in threads of its own."""
        time.sleep(seconds)

    def close(self) -> None:
        """See `Middleware`. Readers of what others publish end now: to others they count as receivers of orders."""
        self._participant = None
        for reader in self._others:
            reader.close()


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

    def __init__(
        self,
        dds: _Dds,
        participant: Any,
        topic: str,
        message: type[M],
        *,
        latched: bool,
        ignores_own: bool = False,
    ) -> None:
        self._message = message
        if ignores_own:
            self._reader = dds.others(participant, _dds_topic(topic), _idl(message))
        else:
            self._reader = dds.reader(participant, _dds_topic(topic), _idl(message), latched=latched)

    def close(self) -> None:
        """Hear no more."""
        self._reader = None

    def take(self) -> list[M]:
        samples = () if self._reader is None else self._reader.take(KEPT)
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
        self._hearing_others = qos.Qos(old, kept, policy.Reliability.BestEffort, policy.IgnoreLocal.Participant)
        self._hearing_latched = qos.Qos(old, kept, *lasting)
        self._qos: Any = qos
        self._calling = (old, kept, policy.Reliability.Reliable(10**8))
        self._topic: Any = topic.Topic
        self._writer: Any = pub.DataWriter
        self._reader: Any = sub.DataReader
        self._builtin: Any = builtin
        self.participant: Any = domain.DomainParticipant
        self.error: Any = core.DDSException

    def writer(self, participant: Any, topic: str, kind: Any, identity: bytes = b"") -> Any:
        quality = self._service(identity) if identity else self._publishing
        return self._writer(participant, self._topic(participant, topic, kind), qos=quality)

    def reader(self, participant: Any, topic: str, kind: Any, identity: bytes = b"", *, latched: bool = False) -> Any:
        quality = self._hearing_latched if latched else self._hearing
        quality = self._service(identity) if identity else quality
        return self._reader(participant, self._topic(participant, topic, kind), qos=quality)

    def others(self, participant: Any, topic: str, kind: Any) -> Any:
        """Return a reader that ignores the writers of its own participant."""
        return self._reader(participant, self._topic(participant, topic, kind), qos=self._hearing_others)

    def publications(self, participant: Any) -> Any:
        """The reader of what others publish, and how (DDS 1.4, 2.2.5: DCPSPublication)."""
        return self._builtin.BuiltinDataReader(participant, self._builtin.BuiltinTopicDcpsPublication)

    def subscriptions(self, participant: Any) -> Any:
        """The reader of what others subscribe to (DCPSSubscription)."""
        return self._builtin.BuiltinDataReader(participant, self._builtin.BuiltinTopicDcpsSubscription)

    def kind_of(self, participant: Any, message: type[Message], theirs: Endpoint) -> Any:
        """Return the type of an end of a service, whose samples are bytes: theirs, where they tell it."""
        from cyclonedds import dynamic, util

        if theirs.type_id is None:
            kind = _made(message)
        else:
            within: Any = util.duration(milliseconds=_TYPES_WITHIN_MS)
            kind, _ = dynamic.get_types_for_typeid(participant, theirs.type_id, within)
        kind.deserialize = classmethod(lambda cls, data, **_: SimpleNamespace(data=data))
        kind.deserialize_key = classmethod(lambda cls, data, **_: SimpleNamespace(data=b""))
        return kind

    def _service(self, identity: bytes) -> Any:
        return self._qos.Qos(*self._calling, self._qos.Policy.Userdata(identity))


_TYPES_WITHIN_MS = 200
"""For how long the types that a server of an action tells are waited for, before they are asked for anew."""
_TOPICS = "rt"
_DDS_TYPE = re.compile(r"(\w+)::msg::dds_::(\w+)_")


def _dds_topic(topic: str) -> str:
    return f"{_TOPICS}/{topic.strip('/')}"


def _dds_type(message: type[Message]) -> str:
    package, *room, name = message.NAME.split("/")
    return f"{package}::{room[0] if room else 'msg'}::dds_::{name}_"


_MADE: dict[type[Message], Any] = {}


def _idl(message: type[Message]) -> Any:
    """The type of a message as cyclonedds has types, made once from its description."""
    if message not in _MADE:
        _MADE[message] = _made(message)
    return _MADE[message]


def _made(message: type[Message]) -> Any:
    from cyclonedds.idl import IdlStruct

    notes = {field.name: _idl_field(field) for field in fields_of(message, ROS2)}
    body = {"__annotations__": notes, "__module__": __name__}
    name = _dds_type(message)
    made = types.new_class(name.rpartition("::")[2], (IdlStruct,), {"typename": name}, lambda room: room.update(body))
    return dataclasses.dataclass(made)


def _idl_field(field: Field) -> Any:
    from cyclonedds.idl import types as idl_types

    idl: Any = idl_types
    words: Any = {"string": str, "bool": bool}
    one = words.get(field.kind) or (getattr(idl, field.kind) if isinstance(field.kind, str) else _idl(field.kind))
    if not field.is_list:
        return one
    return idl.array[one, field.length] if field.length else idl.sequence[one]
