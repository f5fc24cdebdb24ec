"""The web pages of mission control, built with NiceGUI. All files are served by this server.

| part | what it does |
|---|---|
| `frame` | what every view has: header, navigation, keyboard help, theme |
| `visitor` | the user of a page, and the services that it shows |
| `sockets` | checks that messages for a page come from its user |
| `notices` | errors and news for the user |
| `buttons` | buttons that act once, however often they are clicked |
| `map`, `charts` | the map and the charts, elements with their own scripts |
| `editing` | a mission that is being edited: map, form and text |
| `missions`, `plan`, `live`, `records` | the views, a folder each |
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from fastapi import FastAPI
from starlette.requests import HTTPConnection

from muster.mission.errors import MissingExtraError
from muster_control.contract import User
from muster_control.pages.sockets import OwnUploads, guard_sockets
from muster_control.pages.visitor import PageContext, WithServices

if TYPE_CHECKING:
    from muster_control.services.services import Services

_VIEWS = ("missions", "plan", "live", "records")
_ICON = Path(__file__).parent / "assets" / "icon.svg"


def mount(
    app: FastAPI, services: Callable[[], Services], user_of: Callable[[HTTPConnection], User] | None = None
) -> None:
    """Put the pages under `app`, after its other routes.

    Parameters
    ----------
    services
        gives the services, when the application has started.
    user_of
        gives the user of a request; by default `security.user_of`.

    Raises
    ------
    MissingExtraError
        without the extra `web`.
    """
    try:
        from nicegui import app as pages
        from nicegui import ui
    except ModuleNotFoundError:
        raise MissingExtraError("web", "mission control") from None
    if user_of is None:
        user_of = import_module("muster_control.security").user_of
        assert user_of is not None
    for view in _VIEWS:
        if find_spec(f"{__name__}.{view}"):
            import_module(f"{__name__}.{view}")
    pages.middleware_stack = None  # so that a second server in one process (a test) may add its own
    guard_sockets()
    app.add_middleware(OwnUploads)
    app.add_middleware(WithServices, context=PageContext(services, user_of))
    ui.run_with(
        app,
        title="Muster",
        favicon=_ICON,
        dark=None,
        tailwind=False,
        reconnect_timeout=20.0,
        binding_refresh_interval=None,
        show_welcome_message=False,
    )
