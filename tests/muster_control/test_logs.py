"""Logs: their form, and what is not in them."""

import asyncio
import json
import logging
import sys

import pytest

from muster_control.logs import JsonLines, TextLines, _is_failure, without_secrets
from muster_control.security.sessions import Sessions
from muster_control.security.tokens import Holder, new_token


def _record(text, *words, level=logging.INFO, **extra):
    record = logging.LogRecord("muster.x", level, "file", 1, text, words, extra.pop("exc_info", None))
    record.__dict__.update(extra)
    return record


@pytest.mark.parametrize(
    "text",
    [
        "token {secret} is wrong",
        "Authorization: Bearer {secret}",
        "authorization: basic {secret}",
        "Cookie: a=b; muster_session={secret}; c=d",
        "Cookie: __Host-muster_session={secret}",
        "postgresql://muster:{secret}@host/muster",
        "host=h password={secret} dbname=d",
        "host=h password='{secret}' dbname=d",
    ],
)
@pytest.mark.parametrize("form", [JsonLines(), TextLines()])
def test_secrets_are_starred_out(form, text):
    secret = new_token()
    cookie, _ = Sessions(b"s" * 32).begin(Holder("anna", "watch", "0" * 64))
    for each in (secret, cookie):
        said = text.format(secret=each)
        if each == cookie and said.startswith("token"):
            continue  # a cookie has its name beside it
        for record in (_record(said), _record("%s", said), _record("x", detail=said)):
            line = form.format(record)
            assert each not in line
            assert "***" in line


def test_other_text_stays():
    text = "GET /plan/31T-6R50 http://localhost:8117/ muster_session is a cookie; user anna"
    assert without_secrets(text) == text


def test_an_exception_has_no_secret_either():
    secret = new_token()
    try:
        raise ValueError(secret)
    except ValueError:
        record = _record("failed", exc_info=sys.exc_info())
    for form in (JsonLines(), TextLines()):
        line = form.format(record)
        assert secret not in line
        assert "ValueError" in line


def test_one_object_a_line():
    line = JsonLines().format(_record("a\nb %d", 3, request="r1", user="anna", ms=1.5, level=logging.WARNING))
    assert "\n" not in line
    found = json.loads(line)
    assert found.pop("time").endswith("Z")
    assert found == {
        "level": "warning",
        "event": "a\nb 3",
        "logger": "muster.x",
        "request": "r1",
        "user": "anna",
        "ms": 1.5,
    }


def test_strangers_begin_no_line():
    line = TextLines().format(_record("refused %s", "x\n2026-01-01 info all is well\x1b[2J", path="\r\nx"))
    assert len(line.splitlines()) == 1
    assert "\x1b" not in line


def test_what_the_http_server_says_of_clients_that_leave_is_no_failure():
    assert not _is_failure(_record("ASGI callable returned without completing handshake."))
    cancelled, broken = asyncio.CancelledError(), ValueError()
    assert not _is_failure(_record("Exception in ASGI application", exc_info=(type(cancelled), cancelled, None)))
    assert _is_failure(_record("Exception in ASGI application", exc_info=(type(broken), broken, None)))
