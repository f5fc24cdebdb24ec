"""The file of tokens: users and their roles.

Each line is ROLE NAME DIGEST. ROLE is `watch` or `command`. DIGEST is the SHA-256 of the token, so the file holds no
secret; a plain digest is enough, as tokens have 256 random bits (`muster serve --new-token NAME`). DIGEST is `-` for a
user whom a reverse proxy names, and NAME `*` then stands for all others whom the proxy names. `#` begins a comment. The
file is read again when it changes; deleting a line ends its sessions.
"""

from __future__ import annotations

import hmac
import logging
import re
import secrets
import stat
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import cast

from muster.mission.errors import Finding, InputError
from muster.mission.texts.near_matches import did_you_mean
from muster_control.contract import Role

PREFIX = "muster_"
ROLES = ("watch", "command")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@+-]{0,63}")
_DIGEST = re.compile(r"[0-9a-f]{64}")
_LOOK_AGAIN_S = 1.0
_SAY_AGAIN_S = 60.0

log = logging.getLogger("muster.security")


@dataclass(frozen=True)
class Holder:
    """A user of the file; `digest` is empty for a user whom the proxy names."""

    name: str
    role: Role
    digest: str


def new_token() -> str:
    """A new token; its prefix tells it from other text."""
    return PREFIX + secrets.token_urlsafe(32)


def digest_of(token: str) -> str:
    """The digest of a token."""
    return sha256(token.encode("utf-8", "surrogateescape")).hexdigest()


def line_of(name: str, role: Role, token: str) -> str:
    """The line of the file for a token.

    Raises
    ------
    InputError
        if the name is invalid.
    """
    if not _NAME.fullmatch(name):
        raise InputError(
            [Finding("--new-token", None, "name", repr(name), "up to 64 of letters, digits and . _ @ + -")]
        )
    return f"{role} {name} {digest_of(token)}"


def read_holders(file: Path) -> tuple[Holder, ...]:
    """The users of the file.

    Raises
    ------
    InputError
        if a line is invalid, or everybody on this machine may write the file.
    OSError
        if it cannot be read.
    """
    if file.stat().st_mode & stat.S_IWOTH:
        raise InputError([Finding(str(file), None, "", "may be written by anybody", f"chmod o-w {file}")])
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        raise InputError([Finding(str(file), None, "", "is no text", "lines of ROLE NAME DIGEST")]) from None
    holders: dict[str, Holder] = {}
    for number, line in enumerate(lines, start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        holder = _holder(file, number, words)
        if holder.name in holders:
            raise InputError([Finding(str(file), number, "name", f"{holder.name} again", "each name once")])
        holders[holder.name] = holder
    return tuple(holders.values())


def _holder(file: Path, number: int, words: list[str]) -> Holder:
    def wrong(field: str, value: str, expected: str) -> InputError:
        return InputError([Finding(str(file), number, field, value, expected)])

    if len(words) != 3:
        raise wrong("", f"{len(words)} words", "ROLE NAME DIGEST")
    role, name, digest = words
    if role not in ROLES:
        raise wrong("role", repr(role), f"watch or command{did_you_mean(role, ROLES)}")
    if not _NAME.fullmatch(name) and not (name == "*" and digest == "-"):
        raise wrong("name", repr(name), "up to 64 of letters, digits and . _ @ + -")
    if digest.startswith(PREFIX):  # a secret: its value is not shown
        raise wrong("digest", "a token", "its SHA-256, as muster serve --new-token prints it")
    if digest != "-" and not _DIGEST.fullmatch(digest):
        raise wrong("digest", f"{len(digest)} characters", "64 of 0-9 and a-f, or - for a user of the proxy alone")
    return Holder(name, cast("Role", role), "" if digest == "-" else digest)


class Tokens:
    """The present content of the file of tokens.

    Parameters
    ----------
    file
        is read at once, and again when it has changed. While it cannot be read the former content stays valid, and
        `trouble` and the log say why. A file whose last line was deleted lets nobody in.
    clock
        monotonic seconds.

    Raises
    ------
    InputError
        if at the start a line is invalid, there is no line, or everybody on this machine may write the file.
    OSError
        if it cannot be read then.
    """

    def __init__(self, file: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self._file = file
        self._clock = clock
        self._looked_at = clock()
        self._stamp = self._stamp_now()
        self._holders = read_holders(file)
        if not self._holders:
            raise InputError(
                [Finding(str(file), None, "", "no token", "a line ROLE NAME DIGEST (muster serve --new-token)")]
            )
        self._said_at = self._looked_at
        self.trouble = ""

    def holder(self, token: str) -> Holder | None:
        """The holder of a token, in constant time; None if it is unknown."""
        self._refresh()
        digest = digest_of(token)
        found = None
        for holder in self._holders:
            if hmac.compare_digest(holder.digest, digest):
                found = holder
        return found

    def named(self, name: str) -> Holder | None:
        """The holder with this name."""
        self._refresh()
        return _first(holder for holder in self._holders if holder.name == name)

    def _refresh(self) -> None:
        now = self._clock()
        if now < self._looked_at + _LOOK_AGAIN_S:
            return
        self._looked_at = now
        stamp = self._stamp_now()
        if stamp != self._stamp:
            self._stamp = stamp
            self._read(now)
        elif self.trouble and now >= self._said_at + _SAY_AGAIN_S:
            self._say(now)

    def _read(self, now: float) -> None:
        try:
            self._holders = read_holders(self._file)
            self.trouble = ""
            if not self._holders:
                log.warning("%s: no token; nobody is let in", self._file)
        except (InputError, OSError) as error:
            self.trouble = f"the tokens are as before: {error}"
            self._say(now)

    def _say(self, now: float) -> None:
        self._said_at = now
        log.error("%s", self.trouble)

    def look(self) -> str:
        """Read the file if it has changed; returns what is wrong with it, or an empty text."""
        self._refresh()
        return self.trouble

    def _stamp_now(self) -> tuple[int, int, int] | None:
        try:
            found = self._file.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino


def _first(holders: Iterable[Holder]) -> Holder | None:
    return next(iter(holders), None)
