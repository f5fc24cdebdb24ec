"""The application that is mounted under /api/v1.

The description of the API: OpenAPI 3.1 as JSON, and a self-contained page that lists all routes.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from importlib.metadata import version
from string import Template
from typing import Any

from fastapi import Depends, FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.responses import HTMLResponse
from starlette.requests import HTTPConnection

from muster.mission.texts.packaged_files import packaged_text
from muster_control.api import about, actions, jobs, missions, plans, records, runs
from muster_control.api.dependencies import require_known_query
from muster_control.api.problems import Problem, add_handlers
from muster_control.api.responses import ALWAYS, errors
from muster_control.contract import User
from muster_control.security import user_of as usual_who_of
from muster_control.services.services import Services

_SUMMARY = "Plan, watch and steer a team of robots"
_TEXT = """The same functions as the command `muster`. Long work answers 202 with a job; jobs and runs can be followed
by WebSockets (`/jobs/{id}/stream`, `/runs/{id}/stream`), which docs/mission-control-api.md describes. On loopback no
token is needed unless the server was given a file of tokens. The role `watch` may read, `command` may do all."""
_TAGS = {
    "missions": "What is to be done, by whom; every change is a new version.",
    "plans": "Which robot does what, in which order.",
    "jobs": "Long work.",
    "runs": "Plans that are carried out.",
    "records": "What happened.",
    "actions": "What users did.",
    "about": "This server.",
}
_PAGE = Template(packaged_text("muster_control.api", "description.html"))


def describe(app: FastAPI) -> None:
    """Set the description of the application."""

    def openapi() -> dict[str, Any]:
        if not app.openapi_schema:
            app.openapi_schema = _openapi(app)
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's own way of changing it


def _openapi(app: FastAPI) -> dict[str, Any]:
    tags = [{"name": name, "description": text} for name, text in _TAGS.items()]
    described = get_openapi(
        title="Muster mission control",
        version=version("muster-robotics"),
        summary=_SUMMARY,
        description=_TEXT,
        routes=app.routes,
        tags=tags,
        servers=[{"url": "/api/v1"}],
    )
    parts = described.setdefault("components", {})
    schema = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
    parts["schemas"] = {**parts.get("schemas", {}), **schema.pop("$defs"), "Problem": schema}
    for unused in ("HTTPValidationError", "ValidationError"):
        parts["schemas"].pop(unused, None)
    parts["securitySchemes"] = {
        "bearer": {"type": "http", "scheme": "bearer", "description": "A token of this server."}
    }
    described["security"] = [{"bearer": []}, {}]
    return described


def listing(app: FastAPI) -> str:
    """All routes as HTML."""
    paths: dict[str, dict[str, Any]] = app.openapi()["paths"]
    tables = []
    for tag, text in _TAGS.items():
        rows = [
            f"<tr><td><code>{method.upper()} {escape(path)}</code></td><td>{escape(told['summary'])}</td></tr>"
            for path, methods in paths.items()
            for method, told in methods.items()
            if tag in told["tags"]
        ]
        tables.append(f"<h2>{tag}</h2>\n<p>{escape(text)}</p>\n<table>{''.join(rows)}</table>")
    return _PAGE.substitute(summary=_SUMMARY, tables="\n".join(tables))


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
