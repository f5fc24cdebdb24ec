"""What was refused, in the audit log; so rarely that a flood of it fills no disk."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from muster.exchange.mission_control import User
from muster.mission.errors import MusterError
from muster.server.security.limits import Buckets, network_of

log = logging.getLogger("muster.security")
Keep = Callable[[User, str, Mapping[str, Any]], Awaitable[object]]

_OF_ONE_S = 10.0
_IN_ALL_S = 10.0
_AT_ONCE = 100
_WAITING = 50
_SETTLES_S = 2.0


class Audit:
    """Logins and refusals, on their way to the audit log.

    Of one address one refusal in ten seconds is kept, and 100 at once and 360 an hour of all: 3 MB a day at the very
    most. The number that was left out before goes with the next one.

    Parameters
    ----------
    keep
        writes one into the audit log; None while there is no database.
    """

    def __init__(self, keep: Callable[[], Keep | None], clock: Callable[[], float] = time.monotonic) -> None:
        self._keep = keep
        self._of_one = Buckets(1 / _OF_ONE_S, 1.0, clock=clock)
        self._in_all = Buckets(1 / _IN_ALL_S, _AT_ONCE, clock=clock)
        self._left_out = 0
        self._under_way: set[asyncio.Task[None]] = set()

    def refused(self, who: User, why: str, path: str, status: int) -> None:
        """Note that a request was refused."""
        self._refuse(who, {"why": why, "path": path, "status": status})

    def forbade(self, who: User, verb: str, why: str) -> None:
        """Note that somebody who may only watch wanted to command, over the API or by a page."""
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
        """Note a login."""
        log.info("login of %s", who.name, extra={"user": who.name, "address": who.address})
        self._note(who, "login", {"role": who.role})

    def logged_out(self, who: User) -> None:
        """Note a logout."""
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
        except MusterError as error:  # nobody is let in or kept out by a full disk
            log.error("not in the audit log: %s of %s: %s", verb, who.name, error)

    async def settle(self) -> None:
        """Until everything noted is written; not for long, as robots are told to stand after it."""
        if self._under_way:
            await asyncio.wait(self._under_way, timeout=_SETTLES_S)
