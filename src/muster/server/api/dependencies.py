"""What every route needs: the desk, who asks, and that nothing unknown is asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from fastapi import Depends, Request
from fastapi.exceptions import RequestValidationError
from starlette.requests import HTTPConnection

from muster.exchange.mission_control import Who
from muster.mission.near_matches import did_you_mean
from muster.server.services.services import Desk


def _desk(connection: HTTPConnection) -> Desk:
    found: Desk = connection.app.state.desk_of()
    return found


def _asker(connection: HTTPConnection) -> Who:
    found: Who = connection.app.state.who_of(connection)
    return found


def require_known_query(connection: HTTPConnection) -> None:
    """Refuse a query with parameters that the route does not have: a mistyped one would do nothing.

    Raises
    ------
    RequestValidationError
        naming them, and what is known.
    """
    known = [field.alias for field in connection.scope["route"].dependant.query_params]
    _require_known("query", connection.query_params, known)


async def require_known_form(request: Request) -> None:
    """Refuse a form with fields that the route does not have, as `require_known_query` does."""
    known = [field.alias for field in request.scope["route"].dependant.body_params]
    _require_known("body", await request.form(), known)


def _require_known(where: str, given: Mapping[str, Any], known: Sequence[str]) -> None:
    expected = f"one of {', '.join(known)}" if known else "none"
    unknown = [
        {"type": "unknown", "loc": (where, name), "msg": f"{expected}{did_you_mean(name, known)}", "input": given[name]}
        for name in given
        if name not in known
    ]
    if unknown:
        raise RequestValidationError(unknown)


TheDesk = Annotated[Desk, Depends(_desk)]
Asker = Annotated[Who, Depends(_asker)]
