"""What users did: written down before it is done, with what came of it afterwards."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from typing import Any

from muster.exchange.mission_control import Action, ForbiddenError, StoreError, Who
from muster.mission.errors import MusterError
from muster.server.store import Store

Refused = Callable[[Who, str, str], None]
"""Is told who may only watch, what they wanted to do, and why they may not; floods of that are not all written down."""
_LONGEST_OUTCOME = 500
_log = logging.getLogger(__name__)


def unheard(who: Who, verb: str, why: str) -> None:
    """Nobody is told."""


class Actions:
    """The audit log."""

    def __init__(self, store: Store, refused: Refused = unheard) -> None:
        self._table = store.actions
        self._refused = refused

    def require_command(self, who: Who, verb: str) -> None:
        """Raise ForbiddenError where they may only watch."""
        try:
            who.require_command()
        except ForbiddenError as error:
            self._refused(who, verb, str(error))
            raise

    async def add(self, who: Who, verb: str, data: Mapping[str, Any], run: int | None = None) -> Action:
        """Write down what somebody wants to do; its outcome is not known yet."""
        return await asyncio.to_thread(self._table.add, who, verb, data, run)

    async def _settle(self, action: int, outcome: str) -> None:
        """Write down what came of it: `done`, or why not. Whoever asked hears that, whether it is written or not."""
        try:
            await asyncio.to_thread(self._table.settle, action, outcome)
        except StoreError as error:
            _log.warning("action %d: its outcome is not written down (%s): %s", action, outcome, error)

    @asynccontextmanager
    async def of(self, who: Who, verb: str, data: Mapping[str, Any], run: int | None = None) -> AsyncIterator[Action]:
        """Around what a user does: it is done if nothing is raised, and otherwise refused for that reason.

        Raises
        ------
        ForbiddenError
            if they may only watch; nothing is done then, nor written down here.
        """
        self.require_command(who, verb)
        action = await self.add(who, verb, data, run)
        try:
            yield action
        except MusterError as error:
            await self._settle(action.id, outcome_of(error))
            raise
        except BaseException as error:  # a fault of Muster's own, or whoever asked went away
            await self._settle(action.id, f"broken off: {type(error).__name__}")
            raise
        await self._settle(action.id, "done")

    async def list(self, run: int | None = None, limit: int = 200, before: int | None = None) -> list[Action]:
        """Actions, of one run or all, the newest first; with ids below `before`, if given."""
        return await asyncio.to_thread(self._table.list, run, limit, before)


def outcome_of(error: MusterError) -> str:
    """Why something was refused, in a line."""
    lines = str(error).splitlines()
    return lines[0][:_LONGEST_OUTCOME] if lines else type(error).__name__
