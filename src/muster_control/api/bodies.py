"""Reads bodies of requests within limits of length, depth and number of values.

PostgreSQL cannot store NUL, UTF-8 has no lone surrogates, and JSON has neither NaN nor infinity. Bodies with any of
these are refused here, so that no other part has to check for them.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import AsyncGenerator, Callable, Coroutine
from typing import Any

from fastapi import HTTPException, Request, Response
from fastapi.routing import APIRoute
from starlette.types import Receive, Scope

MOST_VALUES = 500_000
"""Of one JSON body, which takes at most about 50 MB in memory."""
DEEPEST = 60
_TEXT = re.compile(rb'"[^"\\]*(?:\\.[^"\\]*)*(?:"|\\?\Z)', re.DOTALL)
"""A JSON string, or the rest of the body after an opening quote, so that no byte is read twice."""
_TOO_LARGE, _BAD = 413, 400


class BoundedRequest(Request):
    """A request whose body is refused if it exceeds the server's limits or cannot be stored."""

    def __init__(self, scope: Scope, receive: Receive, most_bytes: int) -> None:
        super().__init__(scope, receive)
        self.most_bytes = most_bytes

    async def stream(self) -> AsyncGenerator[bytes, None]:
        """The body in pieces; all other ways of reading it use this one."""
        length = self.headers.get("content-length", "")
        if length.isdecimal() and (len(length) > 18 or int(length) > self.most_bytes):
            raise too_long(self.most_bytes)
        read = 0
        async for piece in super().stream():
            read += len(piece)
            if read > self.most_bytes:
                raise too_long(self.most_bytes)
            yield piece

    async def json(self) -> Any:
        """The body as plain data."""
        return strict_json(await self.body())


class BoundedRoute(APIRoute):
    """A route whose requests are BoundedRequests."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """The handler of a request."""
        handle = super().get_route_handler()

        async def bounded(request: Request) -> Response:
            most_bytes = request.app.state.services_of().settings.upload_bytes  # raises while the server ends
            return await handle(BoundedRequest(request.scope, request.receive, most_bytes))

        return bounded


def too_long(most: int) -> HTTPException:
    return HTTPException(_TOO_LARGE, f"the body is too long; expected at most {most} bytes")


def strict_json(body: bytes) -> Any:
    """JSON as plain data.

    Raises
    ------
    HTTPException
        400 or 413, if it is no JSON, is too deep, has too many values, or numbers or texts that cannot be stored.
    """
    if _values(body) > MOST_VALUES and _values(_TEXT.sub(b"", body)) > MOST_VALUES:
        raise HTTPException(_TOO_LARGE, f"the body has too many values; expected at most {MOST_VALUES}")
    try:
        text = body.decode("utf-8")
        data = json.loads(text, parse_constant=_refuse, parse_float=_finite)
    except UnicodeDecodeError as error:
        raise HTTPException(_BAD, f"the body is no UTF-8 at byte {error.start}; expected JSON") from None
    except json.JSONDecodeError as error:
        raise HTTPException(_BAD, f"the body is no JSON at character {error.pos}: {error.msg}; expected JSON") from None
    except RecursionError:
        raise _too_deep() from None
    except ValueError as error:  # of numbers
        raise HTTPException(_BAD, f"the body holds {error}; expected finite numbers") from None
    _require_flat(data)
    if "\\u" in text:
        _require_whole_texts(data)
    return data


def _values(body: bytes) -> int:
    return body.count(b",") + body.count(b"[") + body.count(b"{")


def _refuse(word: str) -> float:
    raise ValueError(word)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(text[:20])
    return value


def _too_deep() -> HTTPException:
    return HTTPException(_BAD, f"the body is too deep; expected at most {DEEPEST} levels of lists and mappings")


def _require_flat(data: Any) -> None:
    level = [data]
    for _ in range(DEEPEST + 1):
        level = [
            item
            for value in level
            if isinstance(value, dict | list)
            for item in (value.values() if isinstance(value, dict) else value)
            if isinstance(item, dict | list)
        ]
        if not level:
            return
    raise _too_deep()


def _require_whole_texts(data: Any) -> None:
    plain = json.dumps(data, ensure_ascii=False)
    try:
        plain.encode("utf-8")
    except UnicodeEncodeError:
        raise HTTPException(_BAD, "the body holds half a character (a lone surrogate); expected whole texts") from None
    if "\\u0000" in json.dumps(data).replace("\\\\", ""):
        raise HTTPException(_BAD, "the body holds a NUL character; expected texts without") from None
