"""Fair queueing: places that users take in turn, so that nobody's work keeps that of others waiting for long."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from contextvars import ContextVar
from itertools import count

from muster.exchange.mission_control import BusyError

CURRENT_USER: ContextVar[str] = ContextVar("muster_current_user", default="")
"""For whom the present request is answered; empty: for the server itself."""


class Turns:
    """A number of places, for which users wait in turn.

    A free place goes to the user who holds the fewest; among those to the one whose last turn is longest ago. The work
    of one user is done in the order in which it comes.

    Parameters
    ----------
    places
        how many pieces of work are under way at most.
    most_of_one
        how many of them one user may have; what is left is a reserve for others.
    waiting, waiting_of_one
        how many pieces may wait, in all and of one user; None: any number.
    """

    def __init__(
        self, places: int, most_of_one: int, *, waiting: int | None = None, waiting_of_one: int | None = None
    ) -> None:
        self._places = places
        self._most_of_one = most_of_one
        self._most_waiting = (waiting, waiting_of_one)
        self._queues: dict[str, deque[asyncio.Event]] = {}
        self._held: Counter[str] = Counter()
        self._last_turn: dict[str, int] = {}  # of users who hold a place or wait for one
        self._numbers = count(1)

    @property
    def taken(self) -> int:
        """How many places are taken."""
        return self._held.total()

    @property
    def waiting(self) -> int:
        """How many pieces of work wait for a place."""
        return sum(map(len, self._queues.values()))

    @asynccontextmanager
    async def turn(self, user: str) -> AsyncIterator[None]:
        """A place of the user's, once it is their turn.

        Raises
        ------
        BusyError
            if as much work waits as may.
        """
        await self._take(user)
        try:
            yield
        finally:
            self._release(user)

    async def _take(self, user: str) -> None:
        self._require_room(user)
        granted = asyncio.Event()
        self._queues.setdefault(user, deque()).append(granted)
        self._grant()
        try:
            await granted.wait()
        except asyncio.CancelledError:
            if granted.is_set():  # in the same moment
                self._release(user)
            else:
                self._queues[user].remove(granted)
                self._forget_if_gone(user)
            raise

    def _require_room(self, user: str) -> None:
        most, most_of_one = self._most_waiting
        own = len(self._queues.get(user, ()))
        if most is not None and self.waiting >= most:
            raise BusyError(f"{self.waiting} requests wait, the most that may; expected to be asked again later")
        if most_of_one is not None and own >= most_of_one:
            raise BusyError(f"{own} requests of {user or 'one user'} wait, the most that may; expected fewer at once")

    def _grant(self) -> None:
        """Give free places to those whose turn it is."""
        while self.taken < self._places:
            may = [user for user, queue in self._queues.items() if queue and self._held[user] < self._most_of_one]
            if not may:
                return
            user = min(may, key=lambda each: (self._held[each], self._last_turn.get(each, 0)))
            self._queues[user].popleft().set()
            self._held[user] += 1
            self._last_turn[user] = next(self._numbers)

    def _release(self, user: str) -> None:
        self._held[user] -= 1
        self._forget_if_gone(user)
        self._grant()

    def _forget_if_gone(self, user: str) -> None:
        """Keep nothing of users who neither hold a place nor wait for one: their names may be any number."""
        if not self._queues.get(user) and not self._held[user]:
            for table in (self._queues, self._held, self._last_turn):
                table.pop(user, None)
