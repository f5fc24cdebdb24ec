"""WebSockets that only send: refused with a problem before they open, and closed when the client disconnects."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

from fastapi import WebSocket, WebSocketDisconnect
from pydantic_core import to_jsonable_python

from muster.mission.errors import MusterError

_OVER, _FAILED = 1000, 1011
_LONGEST_REASON = 120  # bytes; a close frame takes 123


async def tell(socket: WebSocket, texts: AsyncIterator[str]) -> None:
    """Send texts until there are no more, or the client disconnects. Messages of the client are ignored.

    An exception before the first text becomes the response to the request; a later one of Muster the close reason.
    """
    first = await anext(texts, None)
    await socket.accept()
    speaking = asyncio.create_task(_speak(socket, first, texts))
    listening = asyncio.create_task(_listen(socket))
    try:
        await asyncio.wait({speaking, listening}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        listening.cancel()
        speaking.cancel()
        await asyncio.gather(listening, speaking, return_exceptions=True)
    if speaking.cancelled():
        return
    failure = speaking.exception()
    if failure is None:
        await socket.close(_OVER)
    elif isinstance(failure, MusterError):
        await socket.close(_FAILED, _reason(str(failure)))
    elif not isinstance(failure, WebSocketDisconnect):
        raise failure


def message(kind: str, content: Any) -> str:
    """A message of a stream: data of the API as JSON, with a `type`."""
    return json.dumps({"type": kind, **to_jsonable_python(content)}, ensure_ascii=False, separators=(",", ":"))


async def _speak(socket: WebSocket, first: str | None, texts: AsyncIterator[str]) -> None:
    if first is not None:
        await socket.send_text(first)
    async for text in texts:
        await socket.send_text(text)


async def _listen(socket: WebSocket) -> None:
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass


def _reason(text: str) -> str:
    return text.encode()[:_LONGEST_REASON].decode("utf-8", "ignore")
