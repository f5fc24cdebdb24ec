"""The application that is mounted under /api/v1."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import Depends, FastAPI
from fastapi.responses import HTMLResponse
from starlette.requests import HTTPConnection

from muster_control.api import about, actions, jobs, missions, plans, records, runs
from muster_control.api.dependencies import require_known_query
from muster_control.api.description import describe, listing
from muster_control.api.problems import add_handlers
from muster_control.api.responses import ALWAYS, errors
from muster_control.contract import User
from muster_control.security import user_of as usual_who_of
from muster_control.services.services import Services

PREFIX = "/api/v1"


def api(services_of: Callable[[], Services], user_of: Callable[[HTTPConnection], User] = usual_who_of) -> FastAPI:
    """The application to mount at PREFIX.

    Parameters
    ----------
    services_of
        gives the services at each request: the application is made before they are opened.
    user_of
        gives the user of a request; raises if there is none.
    """
    app = FastAPI(
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        responses=errors(*ALWAYS),
        dependencies=[Depends(require_known_query)],
    )
    app.state.services_of, app.state.user_of = services_of, user_of
    add_handlers(app)
    for part in (missions, plans, jobs, runs, records, actions, about):
        app.include_router(part.router)
    describe(app)

    @app.get("/openapi.json", include_in_schema=False)
    async def openapi() -> dict[str, object]:
        return app.openapi()

    @app.get("/docs", include_in_schema=False, response_class=HTMLResponse)
    async def docs() -> str:
        return listing(app)

    return app
