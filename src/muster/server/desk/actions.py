"""What users did: written down before it is done, with what came of it afterwards."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any

from muster.mission.errors import MusterError
from muster.server.store import Store
from muster.server.words import Action, Who

_LONGEST_OUTCOME = 500


class Actions:
    """The audit log."""

    def __init__(self, store: Store) -> None:
        self._table = store.actions

    async def add(self, who: Who, verb: str, data: Mapping[str, Any], run: int | None = None) -> Action:
        """Write down what somebody wants to do; its outcome is not known yet."""
        return await asyncio.to_thread(self._table.add, who, verb, data, run)

    async def settle(self, action: int, outcome: str, applied_s: float | None = None) -> None:
        """Write down what came of it: `done`, or why it was refused."""
        await asyncio.to_thread(self._table.settle, action, outcome[:_LONGEST_OUTCOME], applied_s)

    @asynccontextmanager
    async def of(self, who: Who, verb: str, data: Mapping[str, Any], run: int | None = None) -> AsyncIterator[Action]:
        """Around what a user does: it is done if nothing is raised, and otherwise refused for that reason.

        Raises
        ------
        ForbiddenError
            if they may only watch; nothing is done, nor written down, then.
        """
        who.require_command()
        action = await self.add(who, verb, data, run)
        try:
            yield action
        except MusterError as error:
            await self.settle(action.id, _first_line(error))
            raise
        except BaseException as error:  # a fault of Muster's own, or whoever asked went away
            await self.settle(action.id, f"broken off: {type(error).__name__}")
            raise
        await self.settle(action.id, "done")

    async def list(self, run: int | None = None, limit: int = 200, before: int | None = None) -> list[Action]:
        """Actions, of one run or all, the newest first; with ids below `before`, if given."""
        return await asyncio.to_thread(self._table.list, run, limit, before)


def _first_line(error: MusterError) -> str:
    lines = str(error).splitlines()
    return lines[0] if lines else type(error).__name__
