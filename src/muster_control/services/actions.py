"""The audit log: each action of a user is written before it is done, and its outcome afterwards."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from typing import Any

from muster.mission.errors import MusterError
from muster_control.contract import PAGE_ROWS, Action, ForbiddenError, StoreError, User
from muster_control.store import Store

Refused = Callable[[User, str, str], None]
"""Receives the user, the verb and the reason of each command that a watcher tries."""
_LONGEST_OUTCOME = 500
_log = logging.getLogger(__name__)


def ignore_refusal(who: User, verb: str, why: str) -> None:
    """Report a refusal to nobody."""


class Actions:
    """The audit log."""

    def __init__(self, store: Store, refused: Refused = ignore_refusal) -> None:
        self._table = store.actions
        self._refused = refused

    def require_command(self, who: User, verb: str) -> None:
        """Raise ForbiddenError if the user may only watch."""
        try:
            who.require_command()
        except ForbiddenError as error:
            self._refused(who, verb, str(error))
            raise

    async def add(self, who: User, verb: str, data: Mapping[str, Any], run: int | None = None) -> Action:
        """Write an action whose outcome is not known yet."""
        return await asyncio.to_thread(self._table.add, who, verb, data, run)

    async def _settle(self, action: int, outcome: str) -> None:
        """Write the outcome of an action. The user gets the same answer if the database refuses to write it."""
        try:
            await asyncio.to_thread(self._table.settle, action, outcome)
        except StoreError as error:
            _log.warning("action %d: its outcome is not written down (%s): %s", action, outcome, error)

    @asynccontextmanager
    async def of(self, who: User, verb: str, data: Mapping[str, Any], run: int | None = None) -> AsyncIterator[Action]:
        """Write an action, run the block that does it, and write its outcome: `done`, or what the block raised.

        Raises
        ------
        ForbiddenError
            if the user may only watch; the block is not run, and no action is written here.
        """
        self.require_command(who, verb)
        action = await self.add(who, verb, data, run)
        try:
            yield action
        except MusterError as error:
            await self._settle(action.id, outcome_of(error))
            raise
        except BaseException as error:  # a defect of Muster, or the client disconnected
            await self._settle(action.id, f"broken off: {type(error).__name__}")
            raise
        await self._settle(action.id, "done")

    async def list(self, run: int | None = None, limit: int = PAGE_ROWS, before: int | None = None) -> list[Action]:
        """Actions of one run or of all, newest first; only ids below `before`, if given."""
        return await asyncio.to_thread(self._table.list, run, limit, before)


def outcome_of(error: MusterError) -> str:
    """The reason of a refusal in one line."""
    lines = str(error).splitlines()
    return lines[0][:_LONGEST_OUTCOME] if lines else type(error).__name__
