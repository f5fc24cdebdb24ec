"""Endpoints of drones: UDP, listening or connecting, or a serial line, with one drone or several on it."""

from __future__ import annotations

import os
import re
import socket
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.system.extras import needs_extra

_BAUD = 57600
_CALL_AGAIN_S = 2.0
_UNSENT_TCP_BYTES = 65536
"""A connection for which more waits is hung up: nobody reads at its other end."""
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


class TcpLine:
    """Calls an address (`tcp:`), such as that of a simulator or of mavlink-router, and calls again where that ends."""

    def __init__(self, host: str, port: int) -> None:
        self._address = host, port
        self._socket: socket.socket | None = None
        self._called_s = -_CALL_AGAIN_S
        self._unsent = b""
        try:
            self._socket = socket.create_connection(self._address, timeout=_CALL_AGAIN_S)
        except OSError as error:
            expected = "an address at which MAVLink is served"
            raise NetworkError(f"tcp:{host}:{port}: {error.strerror or error}; expected {expected}") from None
        self._socket.setblocking(False)

    def read(self) -> Iterator[tuple[Peer, bytes]]:
        if self._socket is None:
            self._call_again()
        while self._socket is not None:
            try:
                data = self._socket.recv(65535)
            except BlockingIOError:
                return
            except OSError:
                data = b""
            if not data:  # the other end is gone
                self._hang_up()
                return
            yield None, data

    def write(self, data: bytes, peer: Peer | None) -> None:
        if self._socket is None:
            return
        self._unsent += data
        try:
            self._unsent = self._unsent[self._socket.send(self._unsent) :]
        except BlockingIOError:
            if len(self._unsent) > _UNSENT_TCP_BYTES:
                self._hang_up()
        except OSError:
            self._hang_up()

    def close(self) -> None:
        self._hang_up()

    def _hang_up(self) -> None:
        if self._socket is not None:
            self._socket.close()
        self._socket, self._unsent, self._called_s = None, b"", time.monotonic()

    def _call_again(self) -> None:
        """Call again, without waiting: whether somebody answers is seen when something is read."""
        if time.monotonic() < self._called_s + _CALL_AGAIN_S:
            return
        self._called_s = time.monotonic()
        made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        made.setblocking(False)
        try:
            made.connect(self._address)
        except BlockingIOError:
            pass
        except OSError:
            made.close()
            return
        self._socket = made


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
    """What an endpoint names: `udp:`, `udpout:` or `tcp:HOST:PORT`, `serial:DEVICE[:BAUD]`, each with `#SYSTEM` or not.

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
    tcp = re.fullmatch(r"tcp:([^:]+):(\d+)", text)
    if tcp and 0 < int(tcp[2]) < 65536:
        return TcpLine(tcp[1], int(tcp[2]))
    udp = re.fullmatch(r"(udp|udpin|udpout):([^:]+):(\d+)", text)
    if udp and 0 < int(udp[3]) < 65536:
        return UdpLine(udp[2], int(udp[3]), listens=udp[1] != "udpout")
    wire = re.fullmatch(r"serial:([^:]+)(?::(\d+))?", text)
    if wire:
        return SerialLine(wire[1], int(wire[2] or _BAUD))
    raise ParameterError(
        f"endpoint: {text!r}; expected udp:HOST:PORT (listens), udpout:HOST:PORT or tcp:HOST:PORT (call), "
        "or serial:DEVICE[:BAUD]"
    )
