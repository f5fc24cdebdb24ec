"""The user of a page and the services that it shows, known from the request with which the page was opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from nicegui import ui
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from muster_control.contract import User
from muster_control.security.authentication import SCOPE_KEY, Caller

if TYPE_CHECKING:
    from muster_control.services.services import Services

PATIENCE_S = 20.0
"""Seconds for building a page, up to `is_seen`; NiceGUI's default of three is too short on a busy machine."""
_KEY = "muster.pages"


@dataclass(frozen=True)
class PageContext:
    """What pages need from their server."""

    services: Callable[[], Services]
    user_of: Callable[[HTTPConnection], User]


class WithServices:
    """Middleware that passes the services with each request: NiceGUI has its pages once per process."""

    def __init__(self, app: ASGIApp, context: PageContext) -> None:
        self._app = app
        self._context = context

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        scope[_KEY] = self._context
        await self._app(scope, receive, send)


def the_services() -> Services:
    """The services of the page that is built or used now."""
    return _context().services()


def the_user() -> User:
    """The user of the page that is built or used now."""
    return _context().user_of(ui.context.client.request)


def is_logged_in() -> bool:
    """Whether the user logged in on the login page, and can log out."""
    caller = ui.context.client.request.scope.get(SCOPE_KEY)
    return isinstance(caller, Caller) and caller.session is not None


def user_in(scope: Scope) -> User:
    """The user of any request or WebSocket of the application."""
    context: PageContext = scope[_KEY]
    return context.user_of(HTTPConnection(scope))


def may_command() -> bool:
    """Whether the user may do more than watch."""
    return the_user().role == "command"


def on_the_wall() -> bool:
    """Whether the page is for a wall screen (`?wall=1`): large, and without controls."""
    return ui.context.client.request.query_params.get("wall", "") not in ("", "0")


async def is_seen() -> bool:
    """Wait until the browser shows the page so far; False if it has left.

    NiceGUI shows an error page if a page is not built within PATIENCE_S, so slow work comes after this.
    """
    client = ui.context.client
    await client.connected()
    return not client.is_deleted


def _context() -> PageContext:
    context: PageContext = ui.context.client.request.scope[_KEY]
    return context
