"""The description of the API: OpenAPI 3.1 as JSON, and a self-contained page that lists all routes."""

from __future__ import annotations

from html import escape
from importlib.metadata import version
from string import Template
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from muster.mission.texts.packaged_files import packaged_text
from muster_control.api.problems import Problem

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
