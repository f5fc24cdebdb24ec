"""The HTTP server: its socket, its time limits, its shutdown."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import signal
import socket
import ssl
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.system.interrupts import TO_END
from muster_control.settings import Settings

_HEADERS_S = 20.0
_HEADERS_BYTES = 64 * 1024
_REST_S = 5.0
_REST_BYTES = 32 * 2**20
_ENDING_S = 3
_CONNECTIONS = 4000
_MESSAGE_BYTES = 4 * 2**20


class PatientProtocol(HttpToolsProtocol):
    """HTTP with limits on the time and size of headers, so that slow clients cannot hold connections.

    The rest of a body that was answered early is read and discarded up to a limit: closing a connection with unread
    data resets it, and the response is lost (RFC 9112, 9.6).
    """

    _late: asyncio.TimerHandle | None = None
    _unread = 0
    _most = _HEADERS_BYTES

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        self._await_headers()

    def on_message_begin(self) -> None:
        super().on_message_begin()
        self._await_headers()

    def data_received(self, data: bytes) -> None:
        awaited = self._late
        super().data_received(data)
        if self._late is not None and self._late is awaited:  # headers, or a body that is discarded, are incomplete
            self._unread += len(data)
            if self._unread > self._most:
                self.transport.abort()

    def on_headers_complete(self) -> None:
        self._stop_waiting()
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        if self.cycle.response_complete and self.cycle.more_body and not self.transport.is_closing():
            self._await(_REST_S, _REST_BYTES)

    def on_message_complete(self) -> None:
        super().on_message_complete()
        if self._late is not None:  # the body is complete; another request may follow
            self._await_headers()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_waiting()
        super().connection_lost(exc)

    def _await_headers(self) -> None:
        self._await(_HEADERS_S, _HEADERS_BYTES)

    def _await(self, within_s: float, most_bytes: int) -> None:
        self._stop_waiting()
        self._unread, self._most = 0, most_bytes
        self._late = self.loop.call_later(within_s, self.transport.abort)

    def _stop_waiting(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None


class _Server(uvicorn.Server):
    """A server that leaves signals alone: they are handled before the application starts."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


def listening(host: str, port: int) -> socket.socket:
    """A listening socket, opened before anything else, as it may fail.

    Raises
    ------
    NetworkError
        if the port is in use or not permitted, or the host is not of this machine.
    """
    try:
        family, *_, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except OSError as error:
        raise NetworkError(f"--host {host}: {error.strerror}; expected a name or address of this machine") from None
    found = socket.socket(family, socket.SOCK_STREAM)
    try:
        found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind(address)
        found.listen(1024)
    except OSError as error:
        found.close()
        raise NetworkError(f"{host} port {port}: {error.strerror}; expected {_instead(error)}") from None
    return found


def _instead(error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return "a free one (--port; 0: any)"
    if error.errno == errno.EACCES:
        return "one from 1024 on (--port), or a reverse proxy on this one"
    return "an address of this machine (--host)"


def require_certificate(certificate: Path, key: Path) -> None:
    """Check a certificate and its key before anything else.

    Raises
    ------
    ParameterError, OSError
        if one of them cannot be read, or they do not belong together.
    """
    for file in (certificate, key):
        with file.open("rb"):
            pass

    def ask() -> str:
        raise ParameterError(
            f"--tls-key {key}: the key has a pass phrase; expected one without (openssl pkey -in {key} -out FILE)"
        )

    try:
        ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(certificate, key, ask)
    except ssl.SSLError as error:
        why = error.reason or "no certificate and key"
        raise ParameterError(
            f"--tls-cert {certificate} --tls-key {key}: {why}; expected PEM files that belong together"
        ) from None


def serve(app: FastAPI, settings: Settings, at: socket.socket, on_ready: Callable[[], Awaitable[None]]) -> None:
    """Serve until SIGTERM, SIGHUP or Ctrl-C, which end it without an error.

    Parameters
    ----------
    on_ready
        called when the server answers; the server ends if it raises.

    Raises
    ------
    MusterError
        if the application does not start, or another server takes its database.
    """
    config = uvicorn.Config(
        app,
        lifespan="off",  # entered below, so that an error of the database is raised, not only logged
        http=PatientProtocol,
        ws="websockets-sansio",
        ws_max_size=_MESSAGE_BYTES,
        ws_per_message_deflate=False,
        log_config=None,
        access_log=False,  # the guard's log also names the user
        proxy_headers=False,  # the guard reads them, from trusted proxies only
        server_header=False,
        limit_concurrency=_CONNECTIONS,
        timeout_graceful_shutdown=_ENDING_S,
        ssl_certfile=settings.certificate,
        ssl_keyfile=settings.key,
    )
    with asyncio.Runner(loop_factory=config.get_loop_factory()) as runner:
        runner.run(_serve(app, config, at, on_ready))


@contextlib.asynccontextmanager
async def _ended_by_signals(server: uvicorn.Server) -> AsyncIterator[None]:
    """Let signals end the server within the block; restore their handlers afterwards."""
    loop = asyncio.get_running_loop()
    before = {each: signal.getsignal(each) for each in TO_END}
    for each in TO_END:
        loop.add_signal_handler(each, server.handle_exit, each, None)
    try:
        yield
    finally:
        for each, handler in before.items():
            loop.remove_signal_handler(each)
            signal.signal(each, handler)


async def _serve(
    app: FastAPI, config: uvicorn.Config, at: socket.socket, on_ready: Callable[[], Awaitable[None]]
) -> None:
    config.load()
    server = _Server(config)
    async with _ended_by_signals(server), app.router.lifespan_context(app):
        serving = asyncio.create_task(server.serve(sockets=[at]))
        taken = app.state.services.taken
        try:
            while not server.started and not serving.done():
                await asyncio.sleep(0.005)
            if server.started:
                await on_ready()
            await asyncio.wait({serving, taken}, return_when=asyncio.FIRST_COMPLETED)
            if taken.done():
                taken.result()
        except BaseException:
            server.should_exit = True
            raise
        finally:
            await serving
