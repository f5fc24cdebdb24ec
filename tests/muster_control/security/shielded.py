"""A small application behind the guard, and tokens for it."""

from __future__ import annotations

import asyncio
import warnings
from contextlib import contextmanager
from pathlib import Path

from fastapi import FastAPI, Request, WebSocket

from muster_control.security import user_of
from muster_control.security.authentication import Authenticator
from muster_control.security.guard import Guard, GuardState
from muster_control.security.login import login_routes
from muster_control.security.refusal_log import Audit
from muster_control.security.tokens import line_of, new_token
from muster_control.settings import Settings

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it would rather have httpx2, which is not httpx
    from starlette.testclient import TestClient, WebSocketDenialResponse

__all__ = ["TestClient", "WebSocketDenialResponse"]
HOME, SOCKET = "http://localhost", "ws://localhost/echo"
FOREIGN = {"origin": "https://evil.example"}
COMMANDER, WATCHER = new_token(), new_token()
TOKENS = f"# the team\n{line_of('anna', 'command', COMMANDER)}\n{line_of('wall', 'watch', WATCHER)}\n"


def bearer(token: str) -> dict[str, str]:
    return {"authorization": f"Bearer {token}"}


PROXY_SECRET = "0123456789abcdef" * 4
SHOWN = {"x-muster-proxy-secret": PROXY_SECRET}


def behind_proxy(folder: Path, user_header: str, *trusted: str) -> dict[str, object]:
    """Settings of a server that believes a proxy who asks."""
    file = folder / "proxy-secret"
    file.write_text(f"{PROXY_SECRET}\n", encoding="ascii")
    file.chmod(0o600)
    return {"user_header": user_header, "trusted_proxies": trusted, "proxy_secret": file}


def settings_in(folder: Path, *, tokens: str | None = None, **more: object) -> Settings:
    """Settings whose files are in the folder; with a file of these tokens."""
    if tokens is not None:
        file = folder / "tokens.txt"
        file.write_text(tokens, encoding="utf-8")
        file.chmod(0o600)
        more["tokens"] = file
    return Settings(database=f"sqlite:///{folder / 'muster.db'}", **more)  # type: ignore[arg-type]


class Shielded:
    """The application, what was noted in its audit log, and what its guard saw."""

    def __init__(self, settings: Settings) -> None:
        self.noted = []
        self.completed = []
        self.guard_state = GuardState(settings, Authenticator.of(settings), Audit(lambda: self._keep))
        self.app = FastAPI()
        self.app.router.routes += login_routes(self.guard_state)
        self.app.add_api_route("/who", _who, methods=["GET", "POST"])
        self.app.add_api_route("/api/body", _body, methods=["POST"])
        self.app.add_api_route("/healthz", lambda: "ok")
        self.app.add_api_route("/fails", _fails)
        self.app.add_api_websocket_route("/echo", _echo)
        self.app.add_middleware(Guard, guard_state=self.guard_state, observe=self.completed.append)

    async def _keep(self, who, verb, data):
        self.noted.append((who.name, verb, dict(data)))

    @contextmanager
    def client(self, *, base_url=HOME, peer="127.0.0.1", **more):
        """A client, which follows no redirects."""
        with TestClient(self.app, base_url=base_url, client=(peer, 5000), follow_redirects=False, **more) as client:
            yield client

    def noted_after(self, client):
        """The audit log, when everything is in it."""
        client.portal.call(self.guard_state.audit.settle)
        return self.noted


async def _who(request: Request):
    who = user_of(request)
    return {"name": who.name, "role": who.role, "address": who.address}


async def _body(request: Request):
    return len(await request.body())


async def _fails():
    raise RuntimeError("the password is 1234")


async def _echo(socket: WebSocket):
    await socket.accept()
    async for text in socket.iter_text():
        await socket.send_text(f"{user_of(socket).name}: {text}")


def asgi_answer(
    app, *, method="GET", path="/who", headers=(), pieces=(b"",), before_piece=lambda: None, client=("127.0.0.1", 9)
):
    """Status, headers and body of what an application answers to a raw request."""
    scope = {
        "type": "http",
        "asgi": {"version": "3.0"},
        "http_version": "1.1",
        "method": method,
        "scheme": "http",
        "path": path,
        "raw_path": path.encode("latin-1", "replace"),
        "query_string": b"",
        "root_path": "",
        "headers": [(name.encode("latin-1"), value.encode("latin-1")) for name, value in headers],
        "client": client,
        "server": ("127.0.0.1", 8117),
    }
    left = list(pieces)
    sent = []

    async def receive():
        if not left:
            await asyncio.Event().wait()
        before_piece()
        body = left.pop(0)
        return {"type": "http.request", "body": body, "more_body": bool(left)}

    async def send(message):
        sent.append(message)

    asyncio.run(app(scope, receive, send))
    start = next(message for message in sent if message["type"] == "http.response.start")
    body = b"".join(message.get("body", b"") for message in sent if message["type"] == "http.response.body")
    return start["status"], dict(start["headers"]), body
