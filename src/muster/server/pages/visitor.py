"""The user of a page and the services that it shows, known from the request with which the page was opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from nicegui import ui
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from muster.exchange.mission_control import User
from muster.server.security.authentication import SCOPE_KEY, Caller

if TYPE_CHECKING:
    from muster.server.services.services import Services

PATIENCE_S = 20.0
"""For each page: NiceGUI answers with an error page where one is not built, or as far as `is_seen`, within this.

By its own three seconds it did so wherever a busy machine let a page wait for a thread of the database.
"""
_KEY = "muster.pages"


@dataclass(frozen=True)
class PageContext:
    """What pages need of the server that they are mounted in."""

    services: Callable[[], Services]
    user_of: Callable[[HTTPConnection], User]


class WithServices:
    """Middleware: requests know the services, so that pages, which NiceGUI keeps once a process, ask the right one."""

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
    """Whether the user came by the page's own login, and may leave by it."""
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
    """Whether the page is shown on a wall (`?wall=1`): large, and without anything to press."""
    return ui.context.client.request.query_params.get("wall", "") not in ("", "0")


async def is_seen() -> bool:
    """Wait until the page as it is so far is seen; False: by nobody, so that nothing more is to be built.

    A page that is not built within PATIENCE_S is an error page; what takes its time, as a database that does not
    answer or workers that are busy, comes after this.
    """
    client = ui.context.client
    await client.connected()
    return not client.is_deleted


def _context() -> PageContext:
    context: PageContext = ui.context.client.request.scope[_KEY]
    return context
