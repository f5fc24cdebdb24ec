"""What carries messages: bytes to one robot or to all. Nothing is promised: not delivery, order, or that it is once."""

from __future__ import annotations

from typing import Protocol


class Transport(Protocol):
    """A robot's way to the others. One thread uses it.

    Attributes
    ----------
    room
        the most bytes that travel in one piece; more may be sent, and is lost more easily.
    datagrams, bytes_sent
        how often `send` has sent something to somebody, and how many bytes in all: a message to n peers counts n times
        where it is sent n times.
    lost_here
        what this side knows to be lost: received faster than it was read, or refused by the network.
    """

    @property
    def room(self) -> int: ...

    @property
    def datagrams(self) -> int: ...

    @property
    def bytes_sent(self) -> int: ...

    @property
    def lost_here(self) -> int: ...

    def send(self, data: bytes, to: str | None = None) -> None:
        """Send to a robot; None: to all. Never waits."""
        ...

    def receive(self, wait_s: float) -> list[bytes]:
        """All that has come; waits for the first for so long at most. Empty: nothing came."""
        ...

    def close(self) -> None:
        """Send and receive no more. Closing again does nothing."""
        ...


class Around:
    """A transport around another, which does all: for those that change some of it."""

    def __init__(self, transport: Transport) -> None:
        self._transport = transport

    @property
    def room(self) -> int:
        return self._transport.room

    @property
    def datagrams(self) -> int:
        return self._transport.datagrams

    @property
    def bytes_sent(self) -> int:
        return self._transport.bytes_sent

    @property
    def lost_here(self) -> int:
        return self._transport.lost_here

    def send(self, data: bytes, to: str | None = None) -> None:
        self._transport.send(data, to)

    def receive(self, wait_s: float) -> list[bytes]:
        return self._transport.receive(wait_s)

    def close(self) -> None:
        self._transport.close()
