"""`/healthz`: whether the database and the services work; for load balancers, containers and people.

Without a login the answer is only `ok` or `not ok`: reasons name files and hosts.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from muster_control.contract import StoreError
from muster_control.security.authentication import user_of
from muster_control.services.services import Services
from muster_control.store.store import Store

_PATIENCE_S = 2.0
"""Less than who asks waits: a container's check ends after 5 s."""
_HOLDS_S = 1.0  # so that requests cannot keep the database busy


def health_route(services_of: Callable[[], Services | None], warning: Callable[[], str] = str) -> Route:
    """The route, which answers 200 or 503, and to users who are logged in a `warning`."""
    checked_at, found = float("-inf"), ["not checked yet"]
    check = _Check()
    turn = asyncio.Lock()

    async def healthz(request: Request) -> Response:
        nonlocal checked_at, found
        async with turn:
            if time.monotonic() > checked_at + _HOLDS_S:
                found = await _reasons(services_of(), check)
                checked_at = time.monotonic()
        content: dict[str, object] = {"status": "not ok" if found else "ok"}
        if found and user_of(request).name:
            content["reasons"] = found
        said = warning()
        if said and user_of(request).name:
            content["warning"] = said
        return JSONResponse(content, 503 if found else 200)

    return Route("/healthz", healthz, methods=["GET"], include_in_schema=False)


class _Check:
    """Checks the database, once at a time: a slow check must not occupy more threads."""

    _under_way: asyncio.Task[None] | None = None

    async def why_not(self, store: Store) -> str:
        """What is wrong with the database; empty if nothing is."""
        if self._under_way is None:
            self._under_way = asyncio.create_task(asyncio.to_thread(store.check))
        done, _ = await asyncio.wait({self._under_way}, timeout=_PATIENCE_S)
        if not done:
            return f"database: no answer within {_PATIENCE_S:g} s"
        check, self._under_way = self._under_way, None
        try:
            check.result()
        except StoreError as error:
            return f"database: {error}"
        return ""


async def _reasons(services: Services | None, check: _Check) -> list[str]:
    """What does not work; empty if all does."""
    if services is None:
        return ["starting or ending"]
    return [why for why in (await check.why_not(services.store), *services.runs.troubles) if why]
