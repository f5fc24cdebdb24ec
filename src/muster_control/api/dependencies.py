"""Dependencies of routes: the services, the user, checks for unknown parameters, and keys of requests."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from hashlib import sha256
from typing import Annotated, Any, TypeVar

from fastapi import Depends, Header, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel
from starlette.requests import HTTPConnection

from muster.mission.texts.near_matches import did_you_mean
from muster_control.api.parameter_types import Limit
from muster_control.contract import PAGE_ROWS, User
from muster_control.services.services import Services
from muster_control.store.request_keys import RequestKey

T = TypeVar("T")


def _services(connection: HTTPConnection) -> Services:
    found: Services = connection.app.state.services_of()
    return found


def _user(connection: HTTPConnection) -> User:
    found: User = connection.app.state.user_of(connection)
    return found


class Page:
    """The page of a list that a request asks for."""

    def __init__(self, request: Request, response: Response, limit: Limit = PAGE_ROWS) -> None:
        self._request, self._response, self._limit = request, response, limit
        self.rows = limit + 1  # one more says whether there is a next page

    def of(self, rows: Sequence[T], **place: Callable[[T], object]) -> list[T]:
        """The rows of the page. If there are more, `Link` names the next page: by the `place` of the last row."""
        page = list(rows[: self._limit])
        if len(rows) > len(page):
            query = self._request.url.include_query_params(**{name: of(page[-1]) for name, of in place.items()}).query
            self._response.headers["Link"] = f'<{self._request.url.path}?{query}>; rel="next"'
        return page


def require_known_query(connection: HTTPConnection) -> None:
    """Refuse a query with parameters that the route does not have: a mistyped one would do nothing.

    Raises
    ------
    RequestValidationError
        naming them, and what is known.
    """
    dependant = connection.scope["route"].dependant
    known = [field.alias for part in (dependant, *dependant.dependencies) for field in part.query_params]
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


def key_of(who: User, key: str | None, path: str, body: BaseModel) -> RequestKey | None:
    """The key of a request, with a digest of what it asks for."""
    if key is None:
        return None
    asked = json.dumps([path, body.model_dump(mode="json")], sort_keys=True)
    return RequestKey(who.name, key, sha256(asked.encode()).hexdigest())


IdempotencyKey = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        min_length=1,
        max_length=200,
        pattern=r"^[\x21-\x7e]+$",
        description="The same request with the same key, within a day, makes nothing again: it is answered as before.",
    ),
]
TheServices = Annotated[Services, Depends(_services)]
TheUser = Annotated[User, Depends(_user)]
ThePage = Annotated[Page, Depends()]
