"""Limits that hold before anything is read or stored: rates of requests, WebSockets, sizes and times of bodies."""

from __future__ import annotations

import asyncio
import ipaddress
import time
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from starlette.types import Message, Receive

from muster_control.security.origins import address_in
from muster_control.security.refusal import RefusalError

_BODY_FIRST_S = 20.0
_BODY_BYTES_PER_S = 16 * 1024  # slower than any link on which this page can be used


def network_of(address: str) -> str:
    """The network that one person has: an address of IPv4, a /64 of IPv6."""
    found = address_in(address)
    if isinstance(found, ipaddress.IPv6Address) and not found.is_loopback:
        return str(ipaddress.ip_network((found, 64), strict=False))
    return str(found) if found is not None else address


class Buckets:
    """Token buckets by key: `burst` at once and `rate` per second on average. The least recently used are dropped.

    Parameters
    ----------
    clock
        monotonic seconds.
    most
        how many keys are remembered.
    """

    def __init__(
        self, rate: float, burst: float, *, clock: Callable[[], float] = time.monotonic, most: int = 10_000
    ) -> None:
        self._rate = rate
        self._burst = burst
        self._clock = clock
        self._most = most
        self._levels: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, key: str) -> float:
        """Take one token; returns 0, or the seconds until there is one."""
        level = self._level(key)
        if level < 1.0:
            return (1.0 - level) / self._rate
        self._levels[key] = (level - 1.0, self._clock())
        self._levels.move_to_end(key)
        if len(self._levels) > self._most:
            self._levels.popitem(last=False)
        return 0.0

    def _level(self, key: str) -> float:
        now = self._clock()
        level, since = self._levels.get(key, (self._burst, now))
        return min(self._burst, level + (now - since) * self._rate)


class SocketLimit:
    """Limits how many WebSockets are open, in all and per address."""

    def __init__(self, most: int, most_of_one: int) -> None:
        self._most = most
        self._most_of_one = most_of_one
        self._open: Counter[str] = Counter()

    @property
    def taken(self) -> int:
        return self._open.total()

    @contextmanager
    def place(self, address: str) -> Iterator[None]:
        """Count one more open WebSocket within the block.

        Raises
        ------
        RefusalError
            if the limit is reached.
        """
        key = network_of(address)
        if self.taken >= self._most or self._open[key] >= self._most_of_one:
            limit = f"{self._most} WebSockets are open, or {self._most_of_one} from {key}"
            raise RefusalError(429, f"{limit}; expected that one is closed first", retry_s=5.0)
        self._open[key] += 1
        try:
            yield
        finally:
            self._open[key] -= 1
            if not self._open[key]:
                del self._open[key]


class LimitedBody:
    """A request's body with a limit of its size and a minimum rate.

    Attributes
    ----------
    refused
        why reading stopped; None if it did not.
    """

    def __init__(self, receive: Receive, most_bytes: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._receive = receive
        self._most = most_bytes
        self._clock = clock
        self._began = clock()
        self._size = 0
        self._whole = False
        self.refused: RefusalError | None = None

    def require_announced(self, length: str | None) -> None:
        """Check Content-Length before anything is read."""
        if length is None:
            return
        if not (length.isascii() and length.isdigit()):
            raise RefusalError(400, f"Content-Length: {length!r}; expected a number")
        if len(length) > 18 or int(length) > self._most:
            raise self._too_large()

    async def receive(self) -> Message:
        """The next piece.

        Raises
        ------
        RefusalError
            if the body is too large or too slow.
        """
        if self._whole:
            return await self._receive()  # waits for the end of the connection, without a limit
        left = self._began + _BODY_FIRST_S + self._size / _BODY_BYTES_PER_S - self._clock()
        try:
            message = await asyncio.wait_for(self._receive(), max(0.0, left))
        except TimeoutError:
            self.refused = RefusalError(408, "the body does not come; expected the whole of it sooner")
            raise self.refused from None
        self._size += len(message.get("body", b""))
        self._whole = not message.get("more_body", False)
        if self._size > self._most:
            self.refused = self._too_large()
            raise self.refused
        return message

    def _too_large(self) -> RefusalError:
        return RefusalError(413, f"the body is too large; expected at most {self._most} bytes")
