"""Fair queueing: users take turns at a number of places, so that no user's tasks block those of others."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from contextvars import ContextVar

from muster_control.contract import BusyError

CURRENT_USER: ContextVar[str] = ContextVar("muster_current_user", default="")
"""The user of the present request; empty if the server itself works."""


class Turns:
    """A number of places for tasks, given to users in turn.

    A free place goes to the user with the fewest places, and among those to the one whose last turn is longest ago, or
    who has waited longest without one. The tasks of one user run in the order of their requests.

    Parameters
    ----------
    places
        the most tasks that run at once.
    most_of_one
        the most of them of one user; the rest is a reserve for others.
    waiting, waiting_of_one
        the most tasks that wait, in all and of one user; None: no limit.
    """

    def __init__(
        self, places: int, most_of_one: int, *, waiting: int | None = None, waiting_of_one: int | None = None
    ) -> None:
        self._places = places
        self._most_of_one = most_of_one
        self._most_waiting = (waiting, waiting_of_one)
        self._queues: dict[str, deque[asyncio.Event]] = {}
        self._held: Counter[str] = Counter()
        self._last_turn: dict[str, float] = {}  # of users who hold a place or wait for one
        self._newest_turn = 0.0

    @property
    def taken(self) -> int:
        """How many places are taken."""
        return self._held.total()

    @property
    def waiting(self) -> int:
        """How many tasks wait for a place."""
        return sum(map(len, self._queues.values()))

    @asynccontextmanager
    async def turn(self, user: str) -> AsyncIterator[None]:
        """Hold a place within the block, once it is the user's turn.

        Raises
        ------
        BusyError
            if too many tasks wait.
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
        self._last_turn.setdefault(user, self._newest_turn - 0.5)  # behind all who wait already
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
        """Give the free places to the users whose turn it is."""
        while self.taken < self._places:
            may = [user for user, queue in self._queues.items() if queue and self._held[user] < self._most_of_one]
            if not may:
                return
            user = min(may, key=lambda each: (self._held[each], self._last_turn[each]))
            self._queues[user].popleft().set()
            self._held[user] += 1
            self._newest_turn += 1
            self._last_turn[user] = self._newest_turn

    def _release(self, user: str) -> None:
        self._held[user] -= 1
        self._forget_if_gone(user)
        self._grant()

    def _forget_if_gone(self, user: str) -> None:
        """Forget a user without places and waiting tasks: there may be any number of users."""
        if not self._queues.get(user) and not self._held[user]:
            for table in (self._queues, self._held, self._last_turn):
                table.pop(user, None)
