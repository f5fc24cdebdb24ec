"""Repeated requests: a request that is sent again, because its answer did not arrive, creates nothing twice."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, TypeVar

from muster_control.store.request_keys import RepeatedRequestError, RequestKey

if TYPE_CHECKING:
    from muster_control.store.store import Store

T = TypeVar("T")


async def made_once(
    store: Store, request: RequestKey | None, make: Callable[[], Awaitable[T]], get: Callable[[int], Awaitable[T]]
) -> T:
    """The result of a request; of a repeated request the result of the first, as it is now.

    Raises
    ------
    ConflictError
        if another request had its key.
    """
    try:
        if request is not None:
            await asyncio.to_thread(store.request_keys.require_new, request)
        return await make()
    except RepeatedRequestError as repeated:
        return await get(repeated.made)
