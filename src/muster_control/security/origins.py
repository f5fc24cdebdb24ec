"""Checks of the host that a request names and of the origin that it comes from.

A page of another site can make a browser send requests here (CSRF), open WebSockets here, and, by pointing a name of
its own at this machine (DNS rebinding), even read the answers. The first two show in Origin and Sec-Fetch-Site, which
pages cannot forge, the third in Host. Source: Fetch standard and Fetch Metadata (W3C).
"""

from __future__ import annotations

import ipaddress
import re
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from muster_control.settings import Settings

_HOST = re.compile(r"(?P<name>[A-Za-z0-9._-]+|\[[0-9A-Fa-f:.]+\])(?P<port>:[0-9]{1,5})?")
_LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})


def is_loopback(host: str) -> bool:
    """Whether a server that listens there can be reached from this machine only."""
    if host == "localhost":
        return True
    address = address_in(host)
    return address is not None and address.is_loopback


def address_in(text: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """The IP address in the text; an IPv4-mapped IPv6 address becomes IPv4. None if it is no address."""
    try:
        address = ipaddress.ip_address(text.strip("[]").partition("%")[0])
    except ValueError:
        return None
    mapped = getattr(address, "ipv4_mapped", None)
    return mapped if mapped is not None else address


@dataclass(frozen=True)
class Hosts:
    """The names of this server.

    Parameters
    ----------
    names
        in lower case, without port.
    addresses
        whether any IP address is accepted: DNS rebinding needs a name.
    origins
        under which browsers reach the server through a proxy, as in the header Origin.
    """

    names: frozenset[str]
    addresses: bool
    origins: frozenset[str]

    @classmethod
    def of(cls, settings: Settings) -> Hosts:
        origins = frozenset(_origin(text) for text in settings.public_origins)
        public = {(urlsplit(origin).hostname or "").lower() for origin in origins}
        names = _LOOPBACK | public | {settings.host.lower()}
        beyond = not is_loopback(settings.host)
        if beyond:
            machine = socket.gethostname().lower()
            names |= {machine, f"{machine}.local"}
        return cls(frozenset(names), beyond, origins)

    def why_not_host(self, host: str) -> str | None:
        """What is wrong with the header Host; None if nothing is."""
        match = _HOST.fullmatch(host)
        name = match["name"].strip("[]").lower() if match else ""
        address = address_in(name)
        if match and (name in self.names or (address is not None and (self.addresses or address.is_loopback))):
            return None
        return (
            f"host {host!r} is not this server; expected {', '.join(sorted(self.names))} (muster serve --public-origin)"
        )

    def why_not_origin(self, headers: Mapping[str, str], scheme: str, *, changes: bool, by_cookie: bool) -> str | None:
        """Why a request from another site is refused; None if it may pass.

        Parameters
        ----------
        headers
            by names in lower case.
        scheme
            `http` or `https`: how this server was reached.
        changes
            whether the request changes something, or is a WebSocket, which browsers allow from other sites.
        by_cookie
            whether the user is known by a cookie, which browsers send by themselves.
        """
        origin = headers.get("origin")
        if origin is not None:
            host = headers.get("host", "").lower()
            public = any(own.endswith(f"://{host}") for own in self.origins)  # through the proxy, which has TLS
            own = self.origins if public else {f"{scheme}://{host}"} | self.origins
            return None if origin.lower() in own else f"it comes from {origin!r}; expected {', '.join(sorted(own))}"
        site = headers.get("sec-fetch-site")
        if site in ("cross-site", "same-site"):
            followed = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
            return None if followed and not changes else f"it comes from another site ({site}); expected this one"
        if site is None and changes and by_cookie:
            return "it does not say from which page it comes; expected Origin"
        return None


def _origin(text: str) -> str:
    """An origin as browsers send it: in lower case, without path and default port."""
    parts = urlsplit(text.lower())
    usual = {"http": 80, "https": 443}.get(parts.scheme)
    host = f"[{parts.hostname}]" if ":" in (parts.hostname or "") else parts.hostname
    return f"{parts.scheme}://{host}" + (f":{parts.port}" if parts.port not in (None, usual) else "")
