"""Logs on standard error: lines for people, or one JSON object per line. Secrets are removed from both."""

from __future__ import annotations

import asyncio
import json
import logging
import re
import sys
from datetime import UTC, datetime
from typing import Any, Literal

from muster_control.security.guard import CompletedRequest
from muster_control.security.headers import is_static

_SECRETS = (
    (re.compile(r"muster_[A-Za-z0-9_-]{16,}"), "muster_***"),
    (re.compile(r"(?i)\b(bearer|basic)\s+[^\s\"',;]+"), r"\1 ***"),
    (re.compile(r"(?i)((?:__Host-)?muster_session=)[^\s\"',;]+"), r"\1***"),
    (re.compile(r"(\w+://[^\s:/@]+:)[^\s@]+@"), r"\1***@"),  # a password in a URL
    (re.compile(r"(?i)(password\s*=\s*)('[^']*'|\S+)"), r"\1***"),
)
_OWN = frozenset(vars(logging.makeLogRecord({}))) | {"message", "asctime", "color_message"}

_NO_FAILURES = ("ASGI callable returned without completing handshake.",)  # of a WebSocket that was refused as asked

requests = logging.getLogger("muster.requests")


def without_secrets(text: str) -> str:
    """The text with tokens, sessions and passwords replaced by stars."""
    for pattern, stars in _SECRETS:
        text = pattern.sub(stars, text)
    return text


def _extras(record: logging.LogRecord) -> dict[str, Any]:
    return {name: value for name, value in vars(record).items() if name not in _OWN}


def _time_of(record: logging.LogRecord) -> str:
    return datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


class JsonLines(logging.Formatter):
    """One object per line: `time`, `level`, `event`, `logger`, and further fields such as `request` and `user`."""

    def format(self, record: logging.LogRecord) -> str:
        words = {
            "time": _time_of(record),
            "level": record.levelname.lower(),
            "event": record.getMessage(),
            "logger": record.name,
            **_extras(record),
        }
        if record.exc_info:
            words["exception"] = self.formatException(record.exc_info)
        return json.dumps({name: _clean(value) for name, value in words.items()}, ensure_ascii=False)


class TextLines(logging.Formatter):
    """A line for a person; text of clients cannot begin another line."""

    def format(self, record: logging.LogRecord) -> str:
        beside = "".join(f" {name}={value}" for name, value in _extras(record).items() if value not in ("", None))
        said = "".join(c if c.isprintable() else "\\n" if c == "\n" else "?" for c in record.getMessage() + beside)
        line = f"{_time_of(record)} {record.levelname.lower()} {said}"
        if record.exc_info:
            line += "\n" + self.formatException(record.exc_info)
        return without_secrets(line)


def _clean(value: Any) -> Any:
    if value is None or isinstance(value, bool | int | float):
        return value
    return without_secrets(str(value))


def _is_failure(record: logging.LogRecord) -> bool:
    """Whether a message of the HTTP server is a failure; requests that its shutdown breaks off are none."""
    broken_off = record.exc_info is not None and isinstance(record.exc_info[1], asyncio.CancelledError)
    return not broken_off and record.getMessage() not in _NO_FAILURES


def begin_logs(form: Literal["text", "json"], *, quiet: bool, verbose: bool) -> None:
    """Send all logs to standard error in this form.

    Parameters
    ----------
    quiet
        warnings and errors only.
    verbose
        also requests; the form `json` always logs requests.
    """
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonLines() if form == "json" else TextLines())
    root = logging.getLogger()
    root.handlers[:] = [handler]
    root.setLevel(logging.WARNING)
    logging.getLogger("muster").setLevel(logging.WARNING if quiet else logging.INFO)
    logging.getLogger("uvicorn").setLevel(logging.WARNING)  # it would log queries
    logging.getLogger("uvicorn.error").addFilter(_is_failure)
    logging.getLogger("nicegui").setLevel(logging.ERROR)  # likewise for pages that do not exist
    shows_requests = verbose or (form == "json" and not quiet)
    requests.setLevel(logging.INFO if shows_requests else logging.WARNING)


def log_answered(completed: CompletedRequest) -> None:
    """Log a completed request; static files only if they failed."""
    if is_static(completed.path) and completed.status < 400:
        return
    requests.info(
        "%s %s %d",
        completed.scope.get("method", "WEBSOCKET"),
        completed.path,
        completed.status,
        extra={
            "request": completed.id,
            "user": completed.who.name,
            "address": completed.who.address,
            "ms": round(completed.seconds * 1000, 1),
        },
    )
