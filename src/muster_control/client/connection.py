"""Requests to a server, its streams, and its errors as Muster's exceptions."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from typing import Any
from urllib.parse import urlsplit
from uuid import uuid4

from muster.mission.errors import (
    Finding,
    InputError,
    MissingExtraError,
    MusterError,
    NetworkError,
    ParameterError,
)
from muster_control.contract import (
    MOST_ROWS,
    BusyError,
    ConflictError,
    ForbiddenError,
    NotFoundError,
    StoreError,
)

PREFIX = "/api/v1"
_ERRORS: Mapping[int, type[MusterError]] = {
    401: ForbiddenError,
    403: ForbiddenError,
    404: NotFoundError,
    409: ConflictError,
    429: BusyError,
    503: StoreError,
}
_UNDER_WAY = re.compile(r"/(run|job)s/(\d+)")
_PURPOSE = "talking to a server"
_TRIES, _PAUSE_S = 3, 0.3


class BrokenConnectionError(NetworkError):
    """The connection broke; the server may or may not have received the request."""


class Connection:
    """A server's API; answers are plain data.

    Parameters
    ----------
    url
        `http://HOST:PORT`, without the path of the API.
    token
        sent as a bearer token; None: none is sent.
    timeout_s
        timeout of one answer, seconds.
    """

    def __init__(self, url: str, token: str | None, timeout_s: float) -> None:
        try:
            import httpx
        except ImportError:
            raise MissingExtraError("client", _PURPOSE) from None
        self._url = _checked(url)
        self._headers = {"User-Agent": f"muster/{version('muster-robotics')}"}
        if token is not None:
            self._headers["Authorization"] = f"Bearer {token}"
        self._timeout_s = timeout_s
        try:
            self._http = httpx.Client(base_url=self._url + PREFIX, headers=self._headers, timeout=timeout_s)
        except (ImportError, OSError, ValueError) as error:
            raise self._no_way(error) from None

    def close(self) -> None:
        self._http.close()

    def get(self, path: str, **query: Any) -> Any:
        """The resource as plain data."""
        return self._json("GET", path, params=_without_none(query))

    def pages(self, path: str, limit: int | None = None, **query: Any) -> Iterator[Any]:
        """The rows of a list, read page by page; at most `limit`, if given."""
        size = MOST_ROWS if limit is None else min(limit, MOST_ROWS)
        answer = self._answer("GET", path, params=_without_none({**query, "limit": size}))
        left = limit
        while True:
            rows = self._read(answer)
            yield from rows[:left]
            left = None if left is None else left - len(rows)
            following = answer.links.get("next")
            if following is None or (left is not None and left <= 0):
                return
            answer = self._answer("GET", str(answer.url.join(following["url"])))

    def post(self, path: str, body: Mapping[str, Any]) -> Any:
        return self._json("POST", path, json=body)

    def post_once(self, path: str, body: Mapping[str, Any]) -> Any:
        """Post exactly once: after a broken connection the request is sent again with the same idempotency key."""
        headers = {"Idempotency-Key": uuid4().hex}
        for _ in range(_TRIES - 1):
            try:
                return self._json("POST", path, json=body, headers=headers)
            except BrokenConnectionError:
                time.sleep(_PAUSE_S)
        return self._json("POST", path, json=body, headers=headers)

    def put(self, path: str, body: Mapping[str, Any]) -> Any:
        return self._json("PUT", path, json=body)

    def delete(self, path: str) -> Any:
        return self._json("DELETE", path)

    def file(self, path: str, **query: Any) -> tuple[str, bytes]:
        """The name and the bytes of a file."""
        answer = self._answer("GET", path, params=_without_none(query))
        named = answer.headers.get("content-disposition", "").partition('filename="')[2].partition('"')[0]
        return named or path.rpartition("/")[2], answer.content

    def stream(self, path: str, **query: Any) -> Iterator[Any]:
        """The messages of a WebSocket, until the server has no more.

        Raises
        ------
        NetworkError
            if the connection breaks.
        """
        try:
            from websockets.exceptions import ConnectionClosedOK, InvalidStatus, WebSocketException
            from websockets.sync.client import connect
        except ImportError:
            raise MissingExtraError("client", _PURPOSE) from None
        asked = "&".join(f"{name}={value}" for name, value in _without_none(query).items())
        address = f"ws{self._url.removeprefix('http')}{PREFIX}{path}" + (f"?{asked}" if asked else "")
        try:
            with connect(
                address, additional_headers=self._headers, open_timeout=self._timeout_s, max_size=None
            ) as socket:
                while True:
                    yield json.loads(socket.recv())
        except ConnectionClosedOK:
            return
        except InvalidStatus as error:
            raise _error(error.response.status_code, bytes(error.response.body or b"")) from None
        except ImportError as error:
            raise self._no_way(error) from None
        except (WebSocketException, OSError) as error:
            raise NetworkError(f"{self._url}: the stream broke off: {_line(error)}; {_goes_on(path)}") from None

    def _no_way(self, error: Exception) -> NetworkError:
        """The error for proxies or certificates of the environment that cannot be used."""
        expected = "expected other proxies or certificates in the environment (ALL_PROXY, SSL_CERT_FILE)"
        return NetworkError(f"{self._url}: cannot be reached: {_line(error)}; {expected}")

    def _json(self, method: str, path: str, **how: Any) -> Any:
        return self._read(self._answer(method, path, **how))

    def _read(self, answer: Any) -> Any:
        if not answer.content:
            return None
        try:
            return answer.json()
        except ValueError:
            raise self._no_server("an answer that is no JSON") from None

    def _answer(self, method: str, path: str, **how: Any) -> Any:
        import httpx

        try:
            answer = self._http.request(method, path, **how)
        except httpx.TimeoutException:
            raise NetworkError(f"{self._url}: no answer within {self._timeout_s:g} s; is it busy?") from None
        except (httpx.HTTPError, httpx.InvalidURL, ValueError) as error:
            why = f"{_line(error)}; expected a server there (muster serve)"
            if _UNDER_WAY.match(path):
                why += f"; {_goes_on(path)}"
            is_broken = isinstance(error, httpx.ReadError | httpx.WriteError | httpx.RemoteProtocolError)
            kind = BrokenConnectionError if is_broken else NetworkError
            raise kind(f"{self._url}: cannot be reached: {why}") from None
        if answer.is_success:
            return answer
        if answer.is_redirect:
            raise self._no_server(f"a redirection to {answer.headers.get('location', 'elsewhere')}")
        raise _error(answer.status_code, answer.content)

    def _no_server(self, found: str) -> NetworkError:
        return NetworkError(f"{self._url}: {found}; expected a server of Muster's mission control")


def _checked(url: str) -> str:
    try:
        parts = urlsplit(url)
        right = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:
        right = False
    if not right or parts.query or parts.fragment or parts.username or parts.path.strip("/"):
        raise ParameterError(f"server: {url}; expected http://HOST:PORT or https://HOST:PORT")
    return url.rstrip("/")


def _error(status: int, content: bytes) -> MusterError:
    """The error of a server as the exception that Muster raises locally."""
    try:
        said = json.loads(content)
        text, found = str(said["error"]), [Finding(**finding) for finding in said.get("findings", ())]
    except (ValueError, TypeError, KeyError):
        return NetworkError(f"the server answers {status}; expected an answer of Muster's mission control")
    if status in _ERRORS:
        return _ERRORS[status](text)
    if status in (400, 422):
        return InputError(found) if found else ParameterError(text)
    return MusterError(text)


def _line(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]


def _without_none(query: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in query.items() if value is not None}


def _goes_on(path: str) -> str:
    """Whether the followed job or run goes on at the server."""
    match = _UNDER_WAY.match(path)
    if match is None:
        return "it can be asked for again"
    return f"{match[1]} {match[2]} goes on, also after the server was started again"
