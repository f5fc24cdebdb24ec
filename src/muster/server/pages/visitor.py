"""Who looks at a page, and at which desk: known from the request with which the page was opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from nicegui import ui
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from muster.exchange.mission_control import Who
from muster.server.security.authentication import SCOPE_KEY, Asker

if TYPE_CHECKING:
    from muster.server.services.services import Desk

PATIENCE_S = 20.0
"""For each page: NiceGUI answers with an error page where one is not built, or as far as `is_seen`, within this.

By its own three seconds it did so wherever a busy machine let a page wait for a thread of the database.
"""
_KEY = "muster.pages"


@dataclass(frozen=True)
class Asked:
    """What pages need of the server that they are mounted in."""

    desk: Callable[[], Desk]
    who_of: Callable[[HTTPConnection], Who]


class WithDesk:
    """Middleware: requests know the desk, so that pages, which NiceGUI keeps once a process, ask the right one."""

    def __init__(self, app: ASGIApp, asked: Asked) -> None:
        self._app = app
        self._asked = asked

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        scope[_KEY] = self._asked
        await self._app(scope, receive, send)


def the_desk() -> Desk:
    """The desk of the page that is built or used now."""
    return _asked().desk()


def the_asker() -> Who:
    """Who looks at the page that is built or used now."""
    return _asked().who_of(ui.context.client.request)


def is_logged_in() -> bool:
    """Whether whoever looks came by the page's own login, and may leave by it."""
    asker = ui.context.client.request.scope.get(SCOPE_KEY)
    return isinstance(asker, Asker) and asker.session is not None


def who_in(scope: Scope) -> Who:
    """Who asks, of any request or WebSocket of the application."""
    asked: Asked = scope[_KEY]
    return asked.who_of(HTTPConnection(scope))


def may_command() -> bool:
    """Whether whoever looks may do more than that."""
    return the_asker().role == "command"


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


def _asked() -> Asked:
    asked: Asked = ui.context.client.request.scope[_KEY]
    return asked
