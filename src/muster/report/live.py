"""A mission shown live in Foxglove: a WebSocket with the topics and schemas of a record.

A client that connects later receives the scene, the map and the plan in force. Nothing is accepted from clients.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self

from muster.mission.errors import NetworkError
from muster.mission.model import Mission
from muster.mission.system.extras import needs_extra
from muster.report.record import json_messages, scene
from muster.report.record.publisher import Publisher
from muster.report.record.schemas import SCHEMAS, TOPICS

_LASTING = ("/map", "/muster/plan")
"""Topics whose last message holds until the next."""
_LAST_WORDS_S = 0.5
"""The server that stops drops what it has not yet sent, and tells nobody what it has."""


class FoxgloveServer(Publisher):
    """Shows a mission to whoever connects, until it is closed.

    Parameters
    ----------
    port
        0: any free port; `address` tells which.
    host
        an address of this computer; by default the one that no other computer reaches. Nobody is asked for a password.
    rate_hz
        how many steps of a second of the mission are shown at most.

    Raises
    ------
    NetworkError
        if the port is taken or the address is none of this computer.
    MissingExtraError
        if the extra `foxglove` is not installed.
    """

    def __init__(self, mission: Mission, port: int, *, host: str = "127.0.0.1", rate_hz: float = 10.0) -> None:
        super().__init__(mission, rate_hz)
        foxglove = _foxglove()
        self._context = context = foxglove.Context()  # kept: its channels close with it
        self._entities: dict[str, Mapping[str, Any]] = {}
        self._last: dict[str, Mapping[str, Any]] = {}
        self._asked: set[str] = set()
        self._watched = False
        self._lock = threading.Lock()
        self._channels = {topic: _channel(foxglove, context, topic) for topic in TOPICS}
        self._tell_mission()
        try:
            self._server: Any = foxglove.start_server(
                name=mission.name, host=host, port=port, context=context, server_listener=_Listener(self._ask)
            )
        except (OSError, RuntimeError, ValueError) as error:
            expected = "expected a free port of this computer"
            raise NetworkError(f"foxglove: {host}:{port}: {_reason(error)}; {expected}") from None
        self.address = f"ws://{host}:{self._server.port}"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, _: BaseException | None, __: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close all connections after clients had time to receive the last messages; may be called again."""
        if self._server is not None:
            if self._watched:
                time.sleep(_LAST_WORDS_S)
            self._server.stop()
            self._server = None

    def _flush(self) -> None:
        """Messages are sent at once; nothing is buffered."""

    def _ask(self, topic: str) -> None:
        """A client has subscribed; called by threads of the server."""
        with self._lock:
            self._asked.add(topic)
            self._watched = True

    def _write(self, topic: str, now: float, message: Mapping[str, Any]) -> None:
        if topic == "/scene":
            self._entities |= {entity["id"]: entity for entity in message["entities"]}
        elif topic in _LASTING:
            self._last[topic] = message
        super()._write(topic, now, message)

    def _add(self, topic: str, now: float, data: bytes) -> None:
        self._answer(now)
        self._log(topic, now, data)

    def _answer(self, now: float) -> None:
        """Send the current state to clients that have subscribed since the last call."""
        with self._lock:
            asked, self._asked = self._asked, set()
        holds = {**self._last, "/scene": scene.update(list(self._entities.values()))}
        for topic in sorted(asked & holds.keys()):
            self._log(topic, now, json_messages.json_bytes(holds[topic]))

    def _log(self, topic: str, now: float, data: bytes) -> None:
        self._channels[topic].log(data, log_time=json_messages.nanoseconds(now))


class _Listener:
    def __init__(self, ask: Any) -> None:
        self._ask = ask

    def on_subscribe(self, client: Any, channel: Any) -> None:
        self._ask(channel.topic)

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        """A client that subscribes again receives the current state again."""


def _foxglove() -> Any:
    with needs_extra("foxglove", "a mission shown live in Foxglove"):
        import foxglove
    return foxglove


def _channel(foxglove: Any, context: Any, topic: str) -> Any:
    name = TOPICS[topic]
    schema = foxglove.Schema(name=name, encoding="jsonschema", data=json_messages.json_bytes(SCHEMAS[name]))
    return foxglove.Channel(topic, schema=schema, message_encoding="json", context=context)


def _reason(error: Exception) -> str:
    return str(error).removeprefix("FoxgloveError: ").lower() or type(error).__name__
