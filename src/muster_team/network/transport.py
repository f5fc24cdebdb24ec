"""The interface of transports: bytes to one robot or to all. Delivery, order and uniqueness are not guaranteed."""

from __future__ import annotations

from typing import Protocol

TRANSPORTS = ("udp", "zenoh")
"""The names of the transports."""


class Transport(Protocol):
    """A robot's connection to the others, used by one thread.

    Attributes
    ----------
    room
        the largest number of bytes that travel in one piece; longer data may be sent, and is lost more easily.
    datagrams, bytes_sent
        the number of datagrams sent and their bytes in all: a message to n peers counts n times where it is sent n
        times.
    lost_here
        the number of messages known to be lost on this side: received faster than read, or refused by the network.
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
        """Send to a robot; None: to all. Never blocks."""
        ...

    def receive(self, wait_s: float) -> list[bytes]:
        """All messages that have arrived; waits for the first one for at most `wait_s`. Empty: none arrived."""
        ...

    def close(self) -> None:
        """Stop sending and receiving. Closing again does nothing."""
        ...
