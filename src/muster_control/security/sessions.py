"""Sessions of the pages: signed cookies that name the user.

The signature is HMAC-SHA-256 (RFC 2104) with a secret that is made at the first start and stored beside the database,
readable by its owner only. The cookie holds part of the token's digest, not the token: deleting a token ends its
sessions.
"""

from __future__ import annotations

import base64
import hmac
import json
import os
import secrets
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from muster_control.contract import Role
from muster_control.security.tokens import Holder

COOKIE = "muster_session"
SECURE_COOKIE = f"__Host-{COOKIE}"  # browsers accept it over TLS only, and from this host only
LASTS_S: dict[Role, float] = {"command": 12 * 3600.0, "watch": 7 * 24 * 3600.0}  # a wall screen watches for days
_SECRET_BYTES = 32
_MOST_ENDED = 10_000


@dataclass(frozen=True)
class Session:
    """A login: of whom, and until when (Unix seconds); `id` tells it from others of the same user."""

    name: str
    token: str
    until: float
    id: str


def kept_secret(file: Path) -> bytes:
    """The secret of this database's sessions, created if there is none.

    Raises
    ------
    OSError
        if it can be neither read nor created.
    """
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    try:
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        kept = file.read_bytes()
        if len(kept) >= _SECRET_BYTES:
            return kept
        file.unlink()  # incomplete: the process ended while it wrote
        return kept_secret(file)
    with os.fdopen(descriptor, "wb") as stream:
        secret = secrets.token_bytes(_SECRET_BYTES)
        stream.write(secret)
    return secret


class Sessions:
    """Creates and reads cookies.

    Parameters
    ----------
    secret
        at least 32 bytes.
    clock
        Unix seconds.
    """

    def __init__(self, secret: bytes, clock: Callable[[], float] = time.time) -> None:
        self._secret = secret
        self._clock = clock
        self._ended: dict[str, float] = {}

    def begin(self, holder: Holder) -> tuple[str, float]:
        """The cookie of a new session, and its lifetime in seconds."""
        lasts = LASTS_S[holder.role]
        words = [holder.name, holder.digest[:16], self._clock() + lasts, secrets.token_urlsafe(12)]
        body = json.dumps(words).encode()
        return f"{_text(body)}.{_text(self._signature(body))}", lasts

    def read(self, cookie: str) -> Session | None:
        """The session of a cookie; None if the cookie is invalid, expired or logged out."""
        body_text, _, signature = cookie.partition(".")
        try:
            body, signed = _bytes(body_text), _bytes(signature)
        except ValueError:
            return None
        if not hmac.compare_digest(self._signature(body), signed):
            return None
        session = Session(*json.loads(body))
        return session if self.holds(session) else None

    def holds(self, session: Session) -> bool:
        """Whether the session is neither expired nor logged out."""
        return self._clock() < session.until and session.id not in self._ended

    def end(self, session: Session) -> None:
        """Log a session out: all copies of its cookie are invalid."""
        now = self._clock()
        self._ended = {id_: until for id_, until in self._ended.items() if until > now}
        while len(self._ended) >= _MOST_ENDED:
            del self._ended[next(iter(self._ended))]
        self._ended[session.id] = session.until

    def _signature(self, body: bytes) -> bytes:
        return hmac.digest(self._secret, body, "sha256")


def _text(data: bytes) -> str:
    return base64.urlsafe_b64encode(data).decode().rstrip("=")


def _bytes(text: str) -> bytes:
    return base64.b64decode(text.encode("ascii") + b"=" * (-len(text) % 4), altchars=b"-_", validate=True)
