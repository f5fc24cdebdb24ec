"""The HTTP server: headers that do not come, or do not end, cost a connection and nothing else."""

import asyncio
import shutil
import subprocess

import pytest
import uvicorn
from uvicorn.server import ServerState

from muster.mission.errors import ParameterError
from muster_control import serving
from muster_control.serving import PatientProtocol, require_certificate

_WHOLE = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"


async def _app(scope, receive, send):
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"ok"})


async def _told(*pieces):
    """What a server answers to these pieces, until it ends the connection or has completed nothing for a while."""
    config = uvicorn.Config(_app, http=PatientProtocol, log_config=None, lifespan="off", timeout_keep_alive=0.2)
    config.load()
    state = ServerState()
    loop = asyncio.get_running_loop()
    server = await loop.create_server(
        lambda: PatientProtocol(config=config, server_state=state, app_state={}, _loop=loop), "127.0.0.1", 0
    )
    async with server:
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
        answer, ended = b"", False
        try:
            for piece in pieces:
                writer.write(piece)
                await writer.drain()
                if piece.endswith(b"\r\n\r\n"):
                    answer += await reader.readuntil(b"ok")
            ended = await reader.read() == b""
        except ConnectionError:
            ended = True
        writer.close()
    return answer, ended


@pytest.mark.parametrize("before", [(), (_WHOLE,)])
def test_headers_that_do_not_come(monkeypatch, before):
    monkeypatch.setattr(serving, "_HEADERS_S", 0.5)  # within which those that are whole are there, busy as it may be
    answer, ended = asyncio.run(asyncio.wait_for(_told(*before, b"GET / HTTP/1.1\r\nHost: loc"), 30))
    assert ended
    assert answer.count(b"200 OK") == len(before)


def test_headers_that_do_not_end():
    more = b"X: " + b"x" * 4000 + b"\r\n"
    answer, ended = asyncio.run(asyncio.wait_for(_told(b"GET / HTTP/1.1\r\n", *[more] * 100), 15))
    assert ended
    assert answer == b""


def test_headers_in_pieces_and_again():
    async def told():
        answer, _ = await asyncio.wait_for(_told(_WHOLE[:5], _WHOLE[5:20], _WHOLE[20:], _WHOLE), 30)
        return answer

    assert asyncio.run(told()).count(b"200 OK") == 2


@pytest.mark.parametrize(("rest", "answers"), [(50_000, 2), (99_000, 2), (500_000, 1)])
def test_the_rest_of_a_body_that_was_answered_before_is_thrown_away_while_it_is_little(monkeypatch, rest, answers):
    monkeypatch.setattr(serving, "_REST_BYTES", 100_000)
    begin = b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % rest
    answer, _ = asyncio.run(asyncio.wait_for(_told(begin, b"x" * rest, _WHOLE), 30))
    assert answer.count(b"200 OK") == answers


def test_the_rest_of_a_body_that_does_not_come(monkeypatch):
    monkeypatch.setattr(serving, "_REST_S", 0.05)
    begin = b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n"
    answer, ended = asyncio.run(asyncio.wait_for(_told(begin, b"x"), 30))
    assert ended
    assert answer.count(b"200 OK") == 1


@pytest.mark.skipif(shutil.which("openssl") is None, reason="no openssl here to make a key with")
def test_a_key_with_a_pass_phrase_is_refused_without_asking_for_it(tmp_path):
    certificate, key = tmp_path / "cert.pem", tmp_path / "key.pem"
    how = [
        "-newkey",
        "rsa:2048",
        "-passout",
        "pass:abcd",
        "-subj",
        "/CN=localhost",
        "-keyout",
        key,
        "-out",
        certificate,
    ]
    subprocess.run(["openssl", "req", "-x509", *how], check=True, capture_output=True)
    with pytest.raises(ParameterError, match=f"{key}: the key has a pass phrase; expected one without"):
        require_certificate(certificate, key)
