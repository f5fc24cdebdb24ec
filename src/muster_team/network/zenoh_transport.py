"""Messages over Zenoh (extra `net`): peer to peer, or through routers, for teams that span networks.

Robot r publishes under its own name alone: `muster/MISSION/r/auction` for all, `muster/MISSION/r/auction/x` for robot
x. Each listens to `muster/MISSION/*/auction` and, in all namespaces, to what is for itself; so may other tools. In ids
all but letters, digits and `_.-~` is written as in addresses of the web (`%2F`).

Zenoh is asked to promise nothing: best effort, drop where a link is congested. Its threads call one function, which
puts what came in a queue; nothing of Muster runs on them. The session is closed by `close`, at the latest at exit.

For a callback that is a plain function Zenoh starts a thread of Python's, for whose end the interpreter waits before it
runs what was registered for the exit, so for ever; this one is called by Zenoh's own threads (`indirect=False`).
"""

from __future__ import annotations

import atexit
import json
import re
from collections.abc import Sequence
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING
from urllib.parse import quote

from muster.mission.errors import NetworkError, ParameterError
from muster_team.network.optional_parts import require_net

if TYPE_CHECKING:
    import zenoh

ROOM = 60_000
"""The number of bytes that Zenoh sends in one batch over TCP."""

_MOST_WAITING = 50_000  # messages that were received and not read yet; more are lost, and counted
_ENDPOINT = re.compile(r"[a-z0-9_-]+/\S+")
_IN_SOURCES = re.compile(r"\s+at /\S+\.rs:\d+\.?")  # where in Zenoh's own sources


class ZenohTransport:
    """One Zenoh session.

    Parameters
    ----------
    mission
        a name that keeps teams apart; other tools find the team by it. The seal keeps strangers out, not this.
    robot
        whose messages are sent.
    connect
        endpoints of routers or peers, such as `tcp/10.0.0.1:7447`; none: peers of the local network find each other.
    listen
        endpoints on which peers can connect; none: Zenoh's own choice.
    mode
        `client`: all goes through the first of `connect` that answers, be it a router or a peer, which hands on to
        others. `peer`: directly to each other; nothing is handed on between peers that do not reach each other. By
        default `client` where there is something to connect to and nothing to listen on.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    NetworkError
        if an endpoint is none, is in use, or, for a client, nobody is there.
    ParameterError
        for an unknown mode.
    """

    room = ROOM

    def __init__(
        self,
        mission: str,
        robot: str,
        *,
        connect: Sequence[str] = (),
        listen: Sequence[str] = (),
        mode: str | None = None,
    ) -> None:
        require_net("zenoh")
        mode = mode or ("client" if connect and not listen else "peer")
        if mode not in ("client", "peer"):
            raise ParameterError(f"mode: {mode}; expected client or peer")
        self.datagrams = self.bytes_sent = self.lost_here = 0
        self._came: SimpleQueue[bytes] = SimpleQueue()
        self._own = f"muster/{_escaped(mission)}/{_escaped(robot)}/auction"
        self._session = _opened(mode, connect, listen)
        atexit.register(self.close)
        team = f"muster/{_escaped(mission)}/*/auction"
        self._publishers: dict[str | None, zenoh.Publisher] = {}
        self._subscribers = [self._subscriber(key) for key in (team, f"{team}/{_escaped(robot)}")]
        self._publisher(None)

    def send(self, data: bytes, to: str | None = None) -> None:
        """Send to a robot; None: to all."""
        self._publisher(to).put(data)
        self.datagrams += 1
        self.bytes_sent += len(data)

    def receive(self, wait_s: float) -> list[bytes]:
        """All messages that have arrived."""
        came: list[bytes] = []
        with suppress(Empty):
            came.append(self._came.get(timeout=max(0.0, wait_s)))
            came += (self._came.get_nowait() for _ in range(self._came.qsize()))
        return came

    def close(self) -> None:
        """Close the session."""
        atexit.unregister(self.close)
        if not self._session.is_closed():
            self._session.close()  # type: ignore[no-untyped-call]

    def _take(self, sample: zenoh.Sample) -> None:
        """Called by Zenoh's threads."""
        if self._came.qsize() < _MOST_WAITING:
            self._came.put(sample.payload.to_bytes())
        else:
            self.lost_here += 1

    def _subscriber(self, key: str) -> zenoh.Subscriber[None]:
        from zenoh.handlers import Callback

        return self._session.declare_subscriber(key, Callback(self._take, indirect=False))

    def _publisher(self, to: str | None) -> zenoh.Publisher:
        import zenoh

        if to not in self._publishers:
            self._publishers[to] = self._session.declare_publisher(
                self._own if to is None else f"{self._own}/{_escaped(to)}",
                congestion_control=zenoh.CongestionControl.DROP,
                reliability=zenoh.Reliability.BEST_EFFORT,
                express=False,  # several go as one where a link is busy: a router would drop most of them one by one
                allowed_destination=zenoh.Locality.REMOTE,
            )
        return self._publishers[to]


def _opened(mode: str, connect: Sequence[str], listen: Sequence[str]) -> zenoh.Session:
    import zenoh

    for endpoint in (*connect, *listen):
        if not _ENDPOINT.fullmatch(endpoint):
            raise NetworkError(f"{endpoint}: no endpoint; expected such as tcp/10.0.0.1:7447")
    config = zenoh.Config()
    config.insert_json5("mode", json.dumps(mode))
    if connect:
        config.insert_json5("connect/endpoints", json.dumps(list(connect)))
        config.insert_json5("scouting/multicast/enabled", "false")
    if listen:
        config.insert_json5("listen/endpoints", json.dumps(list(listen)))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        asked = ", ".join((*connect, *listen))
        raise NetworkError(f"Zenoh: {asked}: {_IN_SOURCES.sub('', str(error)).strip()}") from None


def _escaped(name: str) -> str:
    return quote(name, safe="") or "%"
