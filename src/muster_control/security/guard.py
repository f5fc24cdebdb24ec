"""The guard: ASGI middleware that checks host, origin, user and limits of every request, and sets security headers."""

from __future__ import annotations

import asyncio
import json
import logging
import math
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketDisconnect

from muster_control.contract import User
from muster_control.problem import MEDIA_TYPE
from muster_control.security.authentication import SCOPE_KEY, Authenticator, Caller, WrongTokenError
from muster_control.security.headers import is_page, is_static, with_security
from muster_control.security.limits import Buckets, LimitedBody, SocketLimit, network_of
from muster_control.security.origins import Hosts
from muster_control.security.refusal import RefusalError, printable
from muster_control.security.refusal_log import Audit
from muster_control.settings import Settings
from muster_control.work.turns import CURRENT_USER

log = logging.getLogger("muster.security")

OPEN_TO_ALL = {"/healthz": ("GET", "HEAD"), "/login": ("GET", "HEAD", "POST")}
"""Paths and methods that need no login; all others are refused before a page is made."""
REQUEST_KEY = "muster.request"
_READING = ("GET", "HEAD", "OPTIONS")
_AT_ONCE_S = 10.0
_REQUESTS_A_PAGE = 25.0  # a page costs as much time as so many other requests, and half a megabyte for a minute
_PAGES_PER_S, _PAGES_AT_ONCE = 2.0, 40.0  # however few requests there may be
_MESSAGES_PER_S = 100.0
_FAILED_PER_S, _FAILED_AT_ONCE = 0.1, 10.0

Observe = Callable[["CompletedRequest"], None]


@dataclass(frozen=True, kw_only=True)
class CompletedRequest:
    """A completed request, for logs and metrics; `path` is without the query, which may hold secrets."""

    id: str
    scope: Scope
    path: str
    status: int
    seconds: float
    who: User


class GuardState:
    """The state of a server's guard; login and metrics use it too."""

    def __init__(self, settings: Settings, authenticator: Authenticator, audit: Audit) -> None:
        self.settings = settings
        self.authenticator = authenticator
        self.audit = audit
        self.hosts = Hosts.of(settings)
        self.tls = settings.certificate is not None
        rate = settings.requests_per_s
        self.by_address = Buckets(rate, _AT_ONCE_S * rate)
        self.by_user = Buckets(rate, _AT_ONCE_S * rate)
        pages = max(_PAGES_PER_S, rate / _REQUESTS_A_PAGE)
        self.pages = Buckets(pages, _PAGES_AT_ONCE / _PAGES_PER_S * pages)
        self.failed = Buckets(_FAILED_PER_S, _FAILED_AT_ONCE)
        self.sockets = SocketLimit(settings.sockets, settings.sockets_per_address)

    def warning(self) -> str:
        """A warning for the server's administrator; empty if there is none."""
        return "" if self.authenticator.tokens is None else self.authenticator.tokens.look()

    def count_wrong_token(self, address: str) -> None:
        """Count a wrong token of an address. Right tokens are never refused, as others may share the address.

        Guessing is bounded by the rate of requests of an address, and by the 256 random bits of each token.

        Raises
        ------
        RefusalError
            if there were too many.
        """
        wait_s = self.failed.take(network_of(address))
        if wait_s > 0:
            raise RefusalError(429, f"too many wrong tokens; expected a pause of {math.ceil(wait_s)} s", retry_s=wait_s)


@dataclass(frozen=True)
class _Request:
    """The parts of a request that the guard checks."""

    scope: Scope
    headers: dict[str, str]
    address: str

    @property
    def socket(self) -> bool:
        return bool(self.scope["type"] == "websocket")

    @property
    def changes(self) -> bool:
        return self.socket or self.scope["method"] not in _READING


class Guard:
    """ASGI middleware before all routes, mounts, files and WebSockets.

    Parameters
    ----------
    observe
        receives every completed request.
    """

    def __init__(self, app: ASGIApp, guard_state: GuardState, observe: Observe = lambda _: None) -> None:
        self.app = app
        self._shield = guard_state
        self._observe = observe

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        answer = _Answer(scope, send, tls=self._shield.tls)
        peer = (scope.get("client") or ("",))[0]
        request = _Request(scope, {}, peer)
        caller = None
        began = time.perf_counter()
        try:
            request = self._read(scope, peer)
            caller = self._admitted(request, peer)
            scope[SCOPE_KEY] = caller
            CURRENT_USER.set(caller.who.name or network_of(request.address))
            scope[REQUEST_KEY] = answer.id
            await (self._socket if request.socket else self._http)(request, caller, receive, answer)
        except RefusalError as refusal:
            who = caller.who if caller else User("", "watch", request.address)
            if refusal.status_code != 401 or isinstance(refusal, WrongTokenError):
                self._shield.audit.refused(who, refusal.detail, answer.path, refusal.status_code)
            await answer.refuse(refusal, request)
        except WebSocketDisconnect:
            pass  # the client disconnected
        except Exception as error:  # clients learn only where to look
            if answer.gone:
                log.debug("nobody listens any more: %s", type(error).__name__, extra={"request": answer.id})
                return
            log.error("failed: %s", type(error).__name__, exc_info=error, extra={"request": answer.id})
            await answer.refuse(
                RefusalError(500, f"internal error; the server's log says more of {answer.id}"), request
            )
        finally:
            who = caller.who if caller else User("", "watch", request.address)
            seconds = time.perf_counter() - began
            completed = CompletedRequest(
                id=answer.id, scope=scope, path=answer.path, status=answer.status, seconds=seconds, who=who
            )
            self._observe(completed)

    def _read(self, scope: Scope, peer: str) -> _Request:
        """Read the headers and the client's address.

        Raises
        ------
        RefusalError
            if a header that may be there once is there twice.
        """
        headers: dict[str, str] = {}
        for raw_name, raw in scope["headers"]:
            name, value = raw_name.decode("latin-1").lower(), raw.decode("latin-1")
            if name in headers and name in self._shield.authenticator.once:
                raise RefusalError(400, f"header {name} twice; expected it once")
            headers[name] = f"{headers[name]}; {value}" if name == "cookie" and name in headers else value
        return _Request(scope, headers, self._shield.authenticator.proxies.address(peer, headers))

    def _admitted(self, request: _Request, peer: str) -> Caller:
        """The caller, if the request may be answered.

        Raises
        ------
        RefusalError
            if it may not.
        """
        guard_state, path = self._shield, request.scope["path"]
        if why := guard_state.hosts.why_not_host(request.headers.get("host", "")):
            raise RefusalError(421, why)
        if not is_static(path):
            _take(guard_state.by_address, network_of(request.address))
        caller = self._caller(request, peer)
        reads_all = path.startswith("/_nicegui_ws/")  # NiceGUI's socket while it is polled
        why = guard_state.hosts.why_not_origin(
            request.headers,
            "https" if request.scope["scheme"] in ("https", "wss") else "http",
            changes=request.changes or reads_all,
            by_cookie=caller is not None and caller.session is not None,
        )
        if why:
            raise RefusalError(403, why)
        if caller is None:
            if is_static(path):
                _take(guard_state.by_address, network_of(request.address))
            if request.socket or request.scope["method"] not in OPEN_TO_ALL.get(path, ()):
                raise RefusalError(401, "who asks is not known; expected Authorization: Bearer TOKEN, or a login")
            return Caller(User("", "watch", request.address))
        if caller.holder is not None and not is_static(path):
            _take(guard_state.by_user, caller.who.name)
        if is_page(path):
            _take(guard_state.pages, caller.who.name if caller.holder is not None else network_of(request.address))
        return caller

    def _caller(self, request: _Request, peer: str) -> Caller | None:
        try:
            return self._shield.authenticator.caller(request.headers, peer, request.address)
        except WrongTokenError:
            self._shield.count_wrong_token(request.address)
            raise

    async def _http(self, request: _Request, caller: Caller, receive: Receive, answer: _Answer) -> None:
        body = LimitedBody(receive, self._shield.settings.upload_bytes)
        body.require_announced(request.headers.get("content-length"))
        answer.body = body
        await self.app(request.scope, body.receive, answer.send)
        if body.refused is not None:
            raise body.refused

    async def _socket(self, request: _Request, caller: Caller, receive: Receive, answer: _Answer) -> None:
        """Run a WebSocket while its user keeps their rights; messages that come too fast are delayed."""
        holds = self._shield.authenticator.holds
        pace = Buckets(_MESSAGES_PER_S, 4 * _MESSAGES_PER_S)
        over = False

        async def end() -> None:
            nonlocal over
            over = answer.gone = True
            await answer.send({"type": "websocket.close", "code": 1008, "reason": "the login is over"})

        async def paced() -> Message:
            if over:
                return {"type": "websocket.disconnect", "code": 1008}
            message = await receive()
            if message["type"] == "websocket.receive":
                if not holds(caller):
                    await end()
                    return {"type": "websocket.disconnect", "code": 1008}
                while wait_s := pace.take(""):
                    await asyncio.sleep(wait_s)
            return message

        async def checked(message: Message) -> None:
            if over:
                raise OSError("the login is over")
            if message["type"] == "websocket.send" and not holds(caller):
                await end()
                raise OSError("the login is over")  # as if the connection broke
            await answer.send(message)

        with self._shield.sockets.place(request.address):
            await self.app(request.scope, paced, checked)


def _take(buckets: Buckets, key: str) -> None:
    wait_s = buckets.take(key)
    if wait_s > 0:
        raise RefusalError(429, "too many requests; expected fewer", retry_s=wait_s)


class _Answer:
    """A response with security headers; it can become a refusal until it has begun."""

    def __init__(self, scope: Scope, send: Send, *, tls: bool) -> None:
        self._scope = scope
        self._send = send
        self._tls = tls
        self._begun = False
        self.gone = False  # whether the connection is closed: errors are no defect of ours then
        self.path = printable(scope["path"])  # before mounts change it
        self.id = uuid.uuid4().hex[:12]
        self.status = 101 if scope["type"] == "websocket" else 500
        self.body: LimitedBody | None = None

    async def send(self, message: Message) -> None:
        if self.body is not None and self.body.refused is not None and not self._begun:
            return  # the refusal replaces the application's response
        if message["type"] in ("http.response.start", "websocket.http.response.start"):
            self._begun = True
            self.status = message["status"]
            headers = with_security(list(message.get("headers", ())), self.path, tls=self._tls)
            message = {**message, "headers": [*headers, (b"x-request-id", self.id.encode())]}
        elif message["type"] in ("websocket.accept", "websocket.close"):
            self._begun = True
        try:
            await self._send(message)
        except OSError:
            self.gone = True
            raise

    async def refuse(self, refusal: RefusalError, request: _Request) -> None:
        """Answer with the refusal, if no response has begun."""
        if self._begun:
            return
        self.body = None
        if request.socket and "websocket.http.response" not in self._scope.get("extensions", {}):
            self.status = refusal.status_code
            await self.send({"type": "websocket.close", "code": 1008, "reason": refusal.detail[:100]})
            return
        status, headers, content = refusal.status_code, dict(refusal.headers or {}), refusal.as_problem()
        if status == 401:
            headers["www-authenticate"] = "Bearer"
        if status == 408:
            headers["connection"] = "close"  # the rest of the body does not arrive
        if status == 401 and _is_page(request):
            status, headers["location"] = 303, f"/login?next={quote(request.scope['path'])}"
        await self._respond(status, headers, content)

    async def _respond(self, status: int, headers: dict[str, str], content: Any) -> None:
        body = json.dumps(content).encode()
        raw = [(name.encode(), value.encode("latin-1")) for name, value in headers.items()]
        raw += [(b"content-type", MEDIA_TYPE.encode()), (b"content-length", str(len(body)).encode())]
        kind = "websocket.http.response" if self._scope["type"] == "websocket" else "http.response"
        await self.send({"type": f"{kind}.start", "status": status, "headers": raw})
        await self.send({"type": f"{kind}.body", "body": body})


def _is_page(request: _Request) -> bool:
    """Whether a browser asks for a page."""
    scope = request.scope
    wants = "text/html" in request.headers.get("accept", "")
    return not request.socket and scope["method"] == "GET" and wants and not scope["path"].startswith("/api/")
