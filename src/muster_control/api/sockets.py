"""WebSockets that send, or answer messages: refused with a problem before they open, closed when the client leaves."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Any

from fastapi import HTTPException, WebSocket, WebSocketDisconnect
from pydantic_core import to_jsonable_python

from muster.mission.errors import MusterError
from muster_control.api.bodies import strict_json

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


async def answer(socket: WebSocket, take: Callable[[Any], Awaitable[Any]]) -> None:
    """Answer each message of a client, JSON as of a body, by what is made of it, until the client disconnects.

    What is refused is answered too: `{"type": "refused", "error": ...}`.
    """
    await socket.accept()
    while (received := await socket.receive())["type"] != "websocket.disconnect":
        body = received.get("bytes") or (received.get("text") or "").encode()
        try:
            await socket.send_text(message("action", await take(strict_json(body))))
        except MusterError as error:
            await socket.send_text(message("refused", {"error": str(error)}))
        except HTTPException as error:
            await socket.send_text(message("refused", {"error": error.detail}))


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
