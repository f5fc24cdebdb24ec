"""The application of mission control: services, API, pages, and the guard before them."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import asynccontextmanager, contextmanager
from typing import Any

from fastapi import FastAPI
from starlette.staticfiles import StaticFiles

from muster_control.contract import StoreError, User
from muster_control.health import health_route
from muster_control.logs import log_answered
from muster_control.metrics import Metrics
from muster_control.security.authentication import Authenticator, user_of
from muster_control.security.guard import CompletedRequest, Guard, GuardState
from muster_control.security.login import login_routes
from muster_control.security.refusal_log import Audit, Keep
from muster_control.security.serving_rules import require_safe
from muster_control.services.services import Services, open_services
from muster_control.settings import Settings


def make_app(settings: Settings) -> FastAPI:
    """Make the application. Its lifespan opens and closes the services, which are `app.state.services` meanwhile.

    At the end `app.state.left` is the number of runs that resume at the next start.

    A test client must name a host of this server: `TestClient(app, base_url="http://localhost")`.

    Raises
    ------
    ParameterError, InputError, OSError
        if the settings are not safe to serve with, or a file cannot be read.
    """
    require_safe(settings)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with open_services(settings, metrics.appended, guard_state.audit.forbade) as services:
            app.state.services = services
            try:
                yield
            finally:
                app.state.left = services.runs.under_way
                await guard_state.audit.settle()
                app.state.services = None

    app = FastAPI(title="Muster", lifespan=lifespan, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.services = None
    app.state.left = 0

    def services_if_open() -> Services | None:
        services: Services | None = app.state.services
        return services

    def services_of() -> Services:
        services = services_if_open()
        if services is None:  # a page or a request still goes on while the server ends
            raise StoreError("the server is ending; ask again when it has started anew")
        return services

    guard_state = GuardState(settings, Authenticator.of(settings), Audit(lambda: _audit_writer(services_if_open())))
    metrics = Metrics(services_if_open, guard_state)
    health = health_route(services_if_open, guard_state.warning)
    app.router.routes += [*login_routes(guard_state), health, metrics.route()]
    if settings.tiles is not None:
        app.mount("/tiles", StaticFiles(directory=settings.tiles))
    _mount_api_and_pages(app, services_of)

    def observe(completed: CompletedRequest) -> None:
        metrics.observe(completed)
        log_answered(completed)

    app.add_middleware(Guard, guard_state=guard_state, observe=observe)  # last, so that nothing is before it
    app.state.guard_state = guard_state
    return app


def _audit_writer(services: Services | None) -> Keep | None:
    """What writes an action into the audit log; None while the services are closed."""
    if services is None:
        return None

    async def keep(who: User, verb: str, data: Mapping[str, Any]) -> object:
        return await services.actions.add(who, verb, data)

    return keep


def _mount_api_and_pages(app: FastAPI, services_of: Any) -> None:
    """Mount the API, and the pages, which take all other paths."""
    from muster_control.api import PREFIX, api
    from muster_control.api.problems import add_handlers

    with _absent("aiohttp", "requests"):  # for clients of socket.io, which is not used here: 0.4 s and 15 MB
        from muster_control.pages import mount

    add_handlers(app)
    app.mount(PREFIX, api(services_of, user_of))
    mount(app, services_of)


@contextmanager
def _absent(*modules: str) -> Iterator[None]:
    """Hide optional modules from imports within the block, unless they are imported already."""
    hidden = [name for name in modules if name not in sys.modules]
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type]  # None: the import system's own way
    try:
        yield
    finally:
        for name in hidden:
            del sys.modules[name]
