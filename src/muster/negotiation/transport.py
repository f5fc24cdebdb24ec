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
