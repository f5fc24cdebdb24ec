"""Errors as problem JSON (RFC 9457)."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any

from fastapi import FastAPI
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import compile_path

from muster.mission.errors import Finding, MissingExtraError, MusterError
from muster.mission.value_types import shown
from muster_control.contract import BusyError, ConflictError, ForbiddenError, NotFoundError, StoreError
from muster_control.problem import MEDIA_TYPE, problem_content

RETRY_S = 2
_STATUS: tuple[tuple[type[MusterError], int], ...] = (
    (NotFoundError, 404),
    (ConflictError, 409),
    (ForbiddenError, 403),
    (BusyError, 429),
    (StoreError, 503),
    (MissingExtraError, 501),
)
"""All other exceptions of Muster are about the input: 400."""
_SAID: Mapping[str, str] = {
    "missing": "this field",
    "extra_forbidden": "no such field",
    "model_attributes_type": "a JSON object (Content-Type: application/json)",
}

log = logging.getLogger("muster.api")


class ProblemFinding(BaseModel):
    """One error and its place."""

    file: str
    line: int | None = Field(description="From 1; null where there are no lines.")
    field: str
    value: str
    expected: str


class Problem(BaseModel):
    """Why a request failed (RFC 9457)."""

    type: str = Field(description="By which programs tell problems apart.", examples=["urn:muster:problem:conflict"])
    title: str = Field(description="The type in words.")
    status: int = Field(description="The status of HTTP.")
    error: str = Field(description="For a person; one line, or one for each finding.")
    findings: list[ProblemFinding]


def problem(
    status: int, error: str, findings: Sequence[Finding] = (), headers: Mapping[str, str] | None = None
) -> JSONResponse:
    """The response for an error."""
    return JSONResponse(problem_content(status, error, findings), status, dict(headers or {}), media_type=MEDIA_TYPE)


def status_of(error: MusterError) -> int:
    """The status of HTTP for an error."""
    return next((status for kind, status in _STATUS if isinstance(error, kind)), 400)


def problem_of(error: MusterError) -> JSONResponse:
    """The response for an exception of Muster."""
    status = status_of(error)
    headers = {"Retry-After": str(RETRY_S)} if status in (429, 503) else {}
    return problem(status, str(error), getattr(error, "findings", ()), headers)


def add_handlers(app: FastAPI) -> None:
    """Answer all errors of an application with problem JSON."""
    app.add_exception_handler(MusterError, _muster)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(Exception, _unexpected)


async def _muster(_: Request, error: Exception) -> Response:
    assert isinstance(error, MusterError)
    return problem_of(error)


async def _http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    said = error.detail
    if error.status_code == 404 and said == "Not Found":
        said = f"{shown(request.url.path)}; expected a path of the API (openapi.json lists them)"
    elif error.status_code == 405:
        allowed = ", ".join(_methods(request))
        return problem(405, f"{shown(request.method)}; expected {allowed}", headers={"Allow": allowed})
    return problem(error.status_code, said, headers=error.headers)


def _methods(request: Request) -> list[str]:
    """The methods of a path, which several routes may share."""
    here = request.scope["path"].removeprefix(request.scope.get("root_path", ""))
    paths = request.app.openapi()["paths"]
    matching = [here] if here in paths else [path for path in paths if compile_path(path)[0].match(here)]
    return sorted({method.upper() for path in matching for method in paths[path]} or {"GET"})


async def _invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    findings = [_finding(each) for each in error.errors()]
    return problem(422, "\n".join(map(str, findings)), findings)


def _finding(error: Mapping[str, Any]) -> Finding:
    """An error of pydantic as a finding."""
    where, *field = error["loc"]
    message = str(error["msg"]).removeprefix("Input should be ")
    expected = _SAID.get(error["type"], message[:1].lower() + message[1:])
    value = "missing" if error["type"] == "missing" else _printable(error.get("input"))
    return Finding(str(where), None, _printable_name(".".join(map(str, field))), value, expected)


def _printable(value: object) -> str:
    if isinstance(value, bytes):
        value = value[:60].decode("utf-8", "backslashreplace")
    return _printable_name(shown(value))


def _printable_name(text: str) -> str:
    return text[:200].encode("utf-8", "backslashreplace").decode()


async def _unexpected(request: Request, error: Exception) -> Response:
    log.error("%s %s failed: %s", request.method, request.url.path, type(error).__name__, exc_info=error)
    return problem(500, f"internal error: {type(error).__name__}; the server's log says more")
