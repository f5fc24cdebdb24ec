"""How a drone is reached: UDP, to listen or to call, or a serial line."""

from __future__ import annotations

import re
import socket
from typing import Protocol

from muster.mission.errors import NetworkError, ParameterError

_BAUD = 57600


class Line(Protocol):
    """Bytes to and from one drone; nothing waits."""

    def read(self) -> bytes: ...

    def write(self, data: bytes) -> None: ...

    def close(self) -> None: ...


class UdpLine:
    """Listens at an address and answers who spoke last (`udp:`), or speaks to an address from the first (`udpout:`)."""

    def __init__(self, host: str, port: int, *, listens: bool) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._peer: tuple[str, int] | None = None if listens else (host, port)
        if listens:
            try:
                self._socket.bind((host, port))
            except OSError as error:
                self._socket.close()
                raise NetworkError(f"udp:{host}:{port}: {error.strerror}; expected an address that is free") from None

    @property
    def port(self) -> int:
        return int(self._socket.getsockname()[1])

    def read(self) -> bytes:
        parts: list[bytes] = []
        while True:
            try:
                data, self._peer = self._socket.recvfrom(65535)
            except (BlockingIOError, ConnectionRefusedError):  # nothing more; nobody is there yet
                return b"".join(parts)
            parts.append(data)

    def write(self, data: bytes) -> None:
        if self._peer is not None:
            try:
                self._socket.sendto(data, self._peer)
            except OSError:  # a link that is down: heartbeats that are missed say so
                return

    def close(self) -> None:
        self._socket.close()


class SerialLine:
    """A telemetry radio or a cable, by pyserial."""

    def __init__(self, device: str, baud: int) -> None:
        try:
            import serial
        except ImportError:
            raise ParameterError(f"serial:{device}: no pyserial; expected it installed: pip install pyserial") from None
        try:
            self._port = serial.Serial(device, baud, timeout=0, write_timeout=0)
        except (OSError, ValueError) as error:
            raise NetworkError(f"serial:{device}: {error}; expected a serial device") from None

    def read(self) -> bytes:
        return bytes(self._port.read(65535))

    def write(self, data: bytes) -> None:
        self._port.write(data)

    def close(self) -> None:
        self._port.close()


def line_to(endpoint: str) -> Line:
    """The line that an endpoint names: `udp:HOST:PORT`, `udpout:HOST:PORT`, `serial:DEVICE[:BAUD]`.

    Raises
    ------
    ParameterError
        if it names none.
    NetworkError
        if it cannot be opened.
    """
    udp = re.fullmatch(r"(udp|udpin|udpout):([^:]+):(\d+)", endpoint)
    if udp and 0 < int(udp[3]) < 65536:
        return UdpLine(udp[2], int(udp[3]), listens=udp[1] != "udpout")
    wire = re.fullmatch(r"serial:([^:]+)(?::(\d+))?", endpoint)
    if wire:
        return SerialLine(wire[1], int(wire[2] or _BAUD))
    raise ParameterError(
        f"endpoint: {endpoint!r}; expected udp:HOST:PORT (listens), udpout:HOST:PORT (calls) or serial:DEVICE[:BAUD]"
    )
