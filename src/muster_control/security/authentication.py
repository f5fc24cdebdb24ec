"""Who a request comes from: a token's holder, a session, a user whom a proxy names, or the user of this machine."""

from __future__ import annotations

import hmac
import ipaddress
import stat
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from starlette.requests import HTTPConnection

from muster.mission.errors import ParameterError
from muster_control.contract import User
from muster_control.security.origins import address_in
from muster_control.security.refusal import RefusalError, printable
from muster_control.security.sessions import COOKIE, SECURE_COOKIE, Session, Sessions, kept_secret
from muster_control.security.tokens import Holder, Tokens
from muster_control.settings import Settings

SCOPE_KEY = "muster.caller"
SECRET_HEADER = "x-muster-proxy-secret"  # noqa: S105 - the name of a header
"""In which a reverse proxy shows the secret that it shares with this server."""
_SECRET_BYTES = (16, 1024)
_FORWARDED = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-real-ip")


@dataclass(frozen=True)
class Caller:
    """The user of a request, and how they are known: without holder and session, it is the user of this machine."""

    who: User
    holder: Holder | None = None
    session: Session | None = None


class WrongTokenError(RefusalError):
    """The token of the request is unknown."""

    def __init__(self) -> None:
        super().__init__(401, "nobody has this token; expected one of the server's tokens file")


def user_of(connection: HTTPConnection) -> User:
    """The user of a request or WebSocket behind the guard; of a page: `user_of(client.request)`."""
    caller: Caller = connection.scope[SCOPE_KEY]
    return caller.who


def read_proxy_secret(file: Path) -> bytes:
    """The secret that a reverse proxy shares with this server: the only line of a file.

    Raises
    ------
    ParameterError
        if it is too short, or everybody on this machine may read it.
    OSError
        if it cannot be read.
    """
    least, most = _SECRET_BYTES
    if file.stat().st_mode & (stat.S_IROTH | stat.S_IWOTH):
        raise ParameterError(f"--proxy-secret {file}: everybody may read or write it; expected chmod o-rw {file}")
    secret = file.read_bytes().strip()
    if not least <= len(secret) <= most or not secret.isascii() or b"\n" in secret:
        raise ParameterError(
            f"--proxy-secret {file}: {len(secret)} bytes; expected one line of {least} to {most} ASCII characters "
            "(openssl rand -hex 32)"
        )
    return secret


class Proxies:
    """The trusted reverse proxies.

    Parameters
    ----------
    trusted
        addresses, or networks: `10.0.0.0/24`.
    secret
        what a proxy must send in `SECRET_HEADER` to name users: every process of its machine has the same address.
        None: proxies may not name users.

    Raises
    ------
    ParameterError
        if one of the addresses is wrong.
    """

    def __init__(self, trusted: Iterable[str], secret: bytes | None = None) -> None:
        self._secret = secret
        self._networks = []
        for text in trusted:
            try:
                self._networks.append(ipaddress.ip_network(text))
            except ValueError:
                raise ParameterError(f"--trusted-proxy: {text!r}; expected an IP address or network") from None

    def trust(self, address: str) -> bool:
        found = address_in(address)
        return found is not None and any(found in network for network in self._networks)

    def may_name_users(self, peer: str, headers: Mapping[str, str]) -> bool:
        """Whether a request comes from a trusted address and has the secret."""
        shown = headers.get(SECRET_HEADER, "").encode("latin-1")
        return self._secret is not None and hmac.compare_digest(shown, self._secret) and self.trust(peer)

    def address(self, peer: str, headers: Mapping[str, str]) -> str:
        """The address of the client: the last hop that is not a trusted proxy."""
        if not self.trust(peer):
            return peer
        for hop in reversed(headers.get("x-forwarded-for", "").split(",")):
            found = address_in(hop.strip())
            if found is None:
                break
            if not self.trust(str(found)):
                return str(found)
        return peer


class Authenticator:
    """Finds the user of a request.

    Parameters
    ----------
    tokens, sessions
        None: no token is needed, and everybody who reaches the loopback address may command.
    user_header
        the header in which `proxies` name the user, together with their secret.
    """

    def __init__(
        self, tokens: Tokens | None, sessions: Sessions | None, user_header: str | None, proxies: Proxies
    ) -> None:
        self.tokens = tokens
        self.sessions = sessions
        self.proxies = proxies
        self._user_header = user_header.lower() if user_header else None

    @classmethod
    def of(cls, settings: Settings) -> Authenticator:
        """The authenticator of a server with these settings; reads the tokens, and creates the secret of sessions."""
        secret = None if settings.proxy_secret is None else read_proxy_secret(settings.proxy_secret)
        proxies = Proxies(settings.trusted_proxies, secret)
        if settings.tokens is None:
            return cls(None, None, None, proxies)
        sessions = Sessions(kept_secret(Path(settings.folder) / "session.key"))
        return cls(Tokens(settings.tokens), sessions, settings.user_header, proxies)

    @property
    def once(self) -> frozenset[str]:
        """Headers that a request may have once only: with two it would be unclear which counts."""
        counting = {"host", "origin", "authorization", "content-length", SECRET_HEADER}
        return frozenset(counting | ({self._user_header} if self._user_header else set()))

    def caller(self, headers: Mapping[str, str], peer: str, address: str) -> Caller | None:
        """The caller; None if the request names nobody.

        Parameters
        ----------
        peer
            the address of the connection.
        address
            the address of the client, as the proxy says if there is one.

        Raises
        ------
        WrongTokenError
            if the token is unknown.
        RefusalError
            if it came through a proxy to a server without tokens.
        """
        if self.tokens is None:
            if any(name in headers for name in _FORWARDED):
                raise RefusalError(403, "it came through a proxy; expected a server with --tokens behind one")
            return Caller(User("local", "command", address))
        user = self._user(headers)
        if user and self.proxies.may_name_users(peer, headers):
            holder = self.tokens.named(user) or self.tokens.named("*")
            if holder is None:
                return None
            if not holder.digest:  # users with a token must send it; a proxy cannot name them
                return _held(holder, address, name=user)
        scheme, _, token = headers.get("authorization", "").partition(" ")
        if scheme.lower() == "bearer":
            holder = self.tokens.holder(token.strip())
            if holder is None:
                raise WrongTokenError
            return _held(holder, address)
        return self._of_session(headers.get("cookie", ""), address)

    def _user(self, headers: Mapping[str, str]) -> str:
        """The user whom a proxy names; `*` names nobody, as it stands for all others in the file of tokens."""
        user = headers.get(self._user_header, "").strip() if self._user_header else ""
        return "" if user == "*" else user

    def _of_session(self, cookies: str, address: str) -> Caller | None:
        assert self.tokens is not None
        assert self.sessions is not None
        for value in _session_cookies(cookies):
            session = self.sessions.read(value)
            holder = self.tokens.named(session.name) if session else None
            if session and holder and holder.digest and holder.digest.startswith(session.token):
                return _held(holder, address, session)
        return None

    def holds(self, caller: Caller) -> bool:
        """Whether a caller still has the same rights; checked for WebSockets, which stay open."""
        if caller.holder is None or self.tokens is None or self.sessions is None:
            return True
        if self.tokens.named(caller.holder.name) != caller.holder:
            return False
        return caller.session is None or self.sessions.holds(caller.session)


def _held(holder: Holder, address: str, session: Session | None = None, name: str | None = None) -> Caller:
    return Caller(User(printable(name or holder.name, 64), holder.role, address), holder, session)


def _session_cookies(header: str) -> Iterator[str]:
    """The values of our cookie, first the one that only this host can set."""
    pairs = [pair.strip().partition("=") for pair in header.split(";")[:100]]
    for wanted in (SECURE_COOKIE, COOKIE):
        yield from (value for name, _, value in pairs if name == wanted)
