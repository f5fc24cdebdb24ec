"""Checks that messages and uploads for a page come from the user who opened it.

NiceGUI identifies a page by its id only: anybody with the id could press its buttons, and a browser whose login has
changed reconnects its old pages. So the user of the socket or upload must be that of the page, with the same role.
"""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable
from functools import cache
from inspect import isawaitable
from typing import Any
from urllib.parse import parse_qs

from nicegui import Client, core
from starlette.types import ASGIApp, Receive, Scope, Send

from muster_control.pages.visitor import user_in
from muster_control.security.refusal import RefusalError

_SAID = ("handshake", "event", "javascript_response", "ack")
_OF_A_PAGE = re.compile(r"/_nicegui/client/([^/]+)/")


@cache
def guard_sockets() -> None:
    """Check every message of NiceGUI's socket; installed once per process.

    Log messages of browsers are ignored, as they could fill the server's log.
    """
    theirs = dict(core.sio.handlers["/"])

    async def connect(sid: str, environ: dict[str, Any], auth: Any = None) -> Any:
        page = parse_qs(environ.get("QUERY_STRING", "")).get("client_id", [""])[0]
        if page in Client.instances and not is_own(page, environ["asgi.scope"]):
            return False
        return await theirs["connect"](sid, environ, auth)

    def asked(name: str) -> Callable[[str, Any], Awaitable[Any]]:
        async def said(sid: str, message: Any) -> Any:
            page = message.get("client_id") if isinstance(message, dict) else None
            if not isinstance(page, str) or not is_own(page, core.sio.get_environ(sid)["asgi.scope"]):
                return False
            try:
                answer = theirs[name](sid, message)
                return await answer if isawaitable(answer) else answer
            except (
                KeyError,
                TypeError,
                ValueError,
            ):  # no message of NiceGUI's own scripts; what it runs is not in here
                return False

        return said

    async def ignored(sid: str, message: Any) -> None: ...

    core.sio.on("connect", connect)
    core.sio.on("log", ignored)
    for name in _SAID:
        core.sio.on(name, asked(name))


class OwnUploads:
    """Middleware before NiceGUI's routes of single pages, to which files are sent."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        page = _OF_A_PAGE.match(scope["path"]) if scope["type"] == "http" else None
        if page is not None and not is_own(page[1], scope):
            raise RefusalError(404, "there is no such page of yours; expected one that is open")
        await self._app(scope, receive, send)


def is_own(page: str, scope: Scope) -> bool:
    """Whether the page is open, and its user and role are those of the request."""
    client = Client.instances.get(page)
    if client is None:
        return False
    opened, now = user_in(client.request.scope), user_in(scope)
    return (opened.name, opened.role) == (now.name, now.role)
