"""Endpoints of drones: UDP, listening or connecting, or a serial line, with one drone or several on it."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.system.extras import needs_extra

_BAUD = 57600
_UNSENT_BYTES = 4096
"""How much waits at the most for a serial line that takes nothing: what is older is of no use any more."""


@dataclass(frozen=True)
class Endpoint:
    """What `udp:HOST:PORT#2` names: a line, and the system id of a drone on it; None: the one drone that is there."""

    line: str
    system: int | None


Peer = Any
"""Who spoke, as the line has it."""


class Line(Protocol):
    """Bytes to and from drones; nothing waits."""

    def read(self) -> Iterator[tuple[Peer, bytes]]:
        """What came, and from whom."""
        ...

    def write(self, data: bytes, peer: Peer | None) -> None:
        """Send to the last sender; None: to the end of the line."""
        ...

    def close(self) -> None: ...


class UdpLine:
    """Listens at an address and answers senders (`udp:`), or sends to an address from the start (`udpout:`)."""

    def __init__(self, host: str, port: int, *, listens: bool) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._called: Peer | None = None if listens else (host, port)
        if listens:
            try:
                self._socket.bind((host, port))
            except OSError as error:
                self._socket.close()
                raise NetworkError(f"udp:{host}:{port}: {error.strerror}; expected an address that is free") from None

    def read(self) -> Iterator[tuple[Peer, bytes]]:
        while True:
            try:
                data, peer = self._socket.recvfrom(65535)
            except OSError:  # nothing more, or the link is down: heartbeats that are missed say so
                return
            yield peer, data

    def write(self, data: bytes, peer: Peer | None) -> None:
        to = self._called if peer is None else peer
        if to is not None:
            try:
                self._socket.sendto(data, to)
            except OSError:  # the same
                return

    def close(self) -> None:
        self._socket.close()


class SerialLine:
    """A telemetry radio or a cable, by pyserial."""

    def __init__(self, device: str, baud: int) -> None:
        with needs_extra("mavlink", f"serial:{device}"):
            import serial
        try:
            self._port = serial.Serial(device, baud, timeout=0, write_timeout=0)
        except (OSError, ValueError) as error:
            raise NetworkError(f"serial:{device}: {error}; expected a serial device") from None
        self._unsent: list[bytes] = []  # packets; of the first a part may have left

    def read(self) -> Iterator[tuple[Peer, bytes]]:
        try:
            data = bytes(self._port.read(65535))
        except OSError:  # unplugged: heartbeats that are missed say so
            return
        if data:
            yield None, data

    def write(self, data: bytes, peer: Peer | None) -> None:
        self._unsent.append(data)
        while len(self._unsent) > 2 and sum(map(len, self._unsent)) > _UNSENT_BYTES:
            del self._unsent[1]
        try:
            while self._unsent:
                sent = os.write(self._port.fileno(), self._unsent[0])  # `Serial.write` waits where there is no room
                self._unsent[0] = self._unsent[0][sent:]
                if self._unsent[0]:
                    return
                del self._unsent[0]
        except BlockingIOError:
            return
        except OSError:  # unplugged
            self._unsent = []

    def close(self) -> None:
        self._port.close()


def endpoint_of(text: str) -> Endpoint:
    """What an endpoint names: `udp:HOST:PORT`, `udpout:HOST:PORT`, `serial:DEVICE[:BAUD]`, each with `#SYSTEM` or not.

    Raises
    ------
    ParameterError
        if it names none.
    """
    line, sign, number = text.partition("#")
    if not sign:
        return Endpoint(line, None)
    if not re.fullmatch(r"\d{1,3}", number) or not 0 < int(number) < 255:
        raise ParameterError(f"endpoint: {text!r}; expected a system id from 1 to 254 after #")
    return Endpoint(line, int(number))


def line_to(text: str) -> Line:
    """The line of an endpoint, opened.

    Raises
    ------
    ParameterError
        if it names none.
    NetworkError
        if it cannot be opened.
    """
    udp = re.fullmatch(r"(udp|udpin|udpout):([^:]+):(\d+)", text)
    if udp and 0 < int(udp[3]) < 65536:
        return UdpLine(udp[2], int(udp[3]), listens=udp[1] != "udpout")
    wire = re.fullmatch(r"serial:([^:]+)(?::(\d+))?", text)
    if wire:
        return SerialLine(wire[1], int(wire[2] or _BAUD))
    raise ParameterError(
        f"endpoint: {text!r}; expected udp:HOST:PORT (listens), udpout:HOST:PORT (calls) or serial:DEVICE[:BAUD]"
    )
