"""Logins and refusals in the audit log, limited so that a flood does not fill the disk."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from muster.mission.errors import MusterError
from muster_control.contract import User
from muster_control.security.limits import Buckets, network_of

log = logging.getLogger("muster.security")
Keep = Callable[[User, str, Mapping[str, Any]], Awaitable[object]]

_OF_ONE_S = 10.0
_IN_ALL_S = 10.0
_AT_ONCE = 100
_WAITING = 50
_SETTLES_S = 2.0


class Audit:
    """Writes logins and refusals to the audit log.

    It writes one refusal per address in ten seconds, and of all addresses 100 at once and 360 per hour: at most 3 MB a
    day. Each entry tells how many refusals were left out before it.

    Parameters
    ----------
    keep
        gives the function that writes an entry; None while there is no database.
    """

    def __init__(self, keep: Callable[[], Keep | None], clock: Callable[[], float] = time.monotonic) -> None:
        self._keep = keep
        self._of_one = Buckets(1 / _OF_ONE_S, 1.0, clock=clock)
        self._in_all = Buckets(1 / _IN_ALL_S, _AT_ONCE, clock=clock)
        self._left_out = 0
        self._under_way: set[asyncio.Task[None]] = set()

    def refused(self, who: User, why: str, path: str, status: int) -> None:
        """Write a refused request."""
        self._refuse(who, {"why": why, "path": path, "status": status})

    def forbade(self, who: User, verb: str, why: str) -> None:
        """Write that a watcher tried a command, by the API or by a page."""
        self._refuse(who, {"why": why, "command": verb})

    def _refuse(self, who: User, data: dict[str, Any]) -> None:
        if self._of_one.take(network_of(who.address)) or self._in_all.take("") or len(self._under_way) >= _WAITING:
            self._left_out += 1
            return
        log.warning("refused: %s", data["why"], extra={"address": who.address, **data})
        if self._left_out:
            data["left_out"] = self._left_out
            self._left_out = 0
        self._note(who, "refused", data)

    def logged_in(self, who: User) -> None:
        """Write a login."""
        log.info("login of %s", who.name, extra={"user": who.name, "address": who.address})
        self._note(who, "login", {"role": who.role})

    def logged_out(self, who: User) -> None:
        """Write a logout."""
        self._note(who, "logout", {})

    def _note(self, who: User, verb: str, data: Mapping[str, Any]) -> None:
        task = asyncio.get_running_loop().create_task(self._write(who, verb, data))
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)

    async def _write(self, who: User, verb: str, data: Mapping[str, Any]) -> None:
        keep = self._keep()
        if keep is None:
            return
        try:
            await keep(who, verb, data)
        except MusterError as error:  # a full disk changes nobody's rights
            log.error("not in the audit log: %s of %s: %s", verb, who.name, error)

    async def settle(self) -> None:
        """Wait until everything is written, for a short time only: robots are stopped after it."""
        if self._under_way:
            await asyncio.wait(self._under_way, timeout=_SETTLES_S)
