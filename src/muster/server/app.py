"""Mission control as one application: the desk, the API, the pages, and the guard before all of them."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import asynccontextmanager, contextmanager
from typing import Any

from fastapi import FastAPI
from starlette.staticfiles import StaticFiles

from muster.exchange.mission_control import Who
from muster.server.health import health_route
from muster.server.logs import log_answered
from muster.server.metrics import Metrics
from muster.server.security.authentication import Asking, who_of
from muster.server.security.guard import Answered, Guard, Shield
from muster.server.security.login import login_routes
from muster.server.security.refusal_log import Audit, Keep
from muster.server.security.serving_rules import require_safe
from muster.server.services.services import Desk, open_desk
from muster.server.settings import Settings


def make_app(settings: Settings) -> FastAPI:
    """Mission control; its lifespan opens and closes the desk, which is in `app.state.desk` meanwhile.

    `app.state.left` says at the end how many runs go on when the server is started again.

    A test client is to name a host of this server: `TestClient(app, base_url="http://localhost")`.

    Raises
    ------
    ParameterError, InputError, OSError
        if it would not be safe to serve in this way, or a file that it needs cannot be read.
    """
    require_safe(settings)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with open_desk(settings, metrics.appended, shield.audit.forbade) as desk:
            app.state.desk = desk
            try:
                yield
            finally:
                app.state.left = desk.runs.under_way
                await shield.audit.settle()
                app.state.desk = None

    app = FastAPI(title="Muster", lifespan=lifespan, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.desk = None
    app.state.left = 0

    def desk_of() -> Desk:
        desk: Desk = app.state.desk
        return desk

    shield = Shield(settings, Asking.of(settings), Audit(lambda: _keeping(app.state.desk)))
    metrics = Metrics(desk_of, shield)
    app.router.routes += [*login_routes(shield), health_route(desk_of, shield.warning), metrics.route()]
    if settings.tiles is not None:
        app.mount("/tiles", StaticFiles(directory=settings.tiles))
    _mount_faces(app, desk_of)

    def observe(answered: Answered) -> None:
        metrics.observe(answered)
        log_answered(answered)

    app.add_middleware(Guard, shield=shield, observe=observe)  # last, so that nothing is before it
    app.state.shield = shield
    return app


def _keeping(desk: Desk | None) -> Keep | None:
    """What writes into the audit log."""
    if desk is None:
        return None

    async def keep(who: Who, verb: str, data: Mapping[str, Any]) -> object:
        return await desk.actions.add(who, verb, data)

    return keep


def _mount_faces(app: FastAPI, desk_of: Any) -> None:
    """The API, and the pages, which take every path that nothing else has."""
    from muster.server.api import PREFIX, api
    from muster.server.api.problems import add_handlers

    with _absent("aiohttp", "requests"):  # what NiceGUI's socket.io would be a client with: 0.4 s, and 15 MB
        from muster.server.pages import mount

    add_handlers(app)
    app.mount(PREFIX, api(desk_of, who_of))
    mount(app, desk_of)


@contextmanager
def _absent(*modules: str) -> Iterator[None]:
    """Meanwhile these cannot be imported, unless they are already; who can do without them does."""
    hidden = [name for name in modules if name not in sys.modules]
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type]  # None: the import system's own way
    try:
        yield
    finally:
        for name in hidden:
            del sys.modules[name]
