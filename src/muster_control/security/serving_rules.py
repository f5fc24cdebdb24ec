"""Which settings are safe to serve with."""

from __future__ import annotations

from urllib.parse import urlsplit

from muster.mission.errors import ParameterError
from muster_control.security.origins import is_loopback
from muster_control.settings import Settings


def require_safe(settings: Settings) -> None:
    """Refuse to serve a network without authentication, or without TLS unless that was asked for.

    Raises
    ------
    ParameterError
        naming the option that is missing.
    """
    if (settings.certificate is None) != (settings.key is None):
        raise ParameterError("--tls-cert and --tls-key: one of them given; expected both")
    if settings.tokens is None:
        _require_alone(settings)
    else:
        _require_proven_proxy(settings)
    encrypted = settings.certificate is not None
    if not is_loopback(settings.host) and not encrypted and not settings.insecure_http:
        raise ParameterError(
            f"--host {settings.host} reaches beyond this machine without TLS; "
            "expected --tls-cert and --tls-key, or --insecure-http where the network is trusted"
        )
    for origin in settings.public_origins:
        parts = urlsplit(origin)
        if parts.scheme not in ("http", "https") or not parts.hostname or parts.path.strip("/"):
            raise ParameterError(f"--public-origin: {origin!r}; expected such as https://control.example.org")


def _require_proven_proxy(settings: Settings) -> None:
    """Require that a proxy that names users is known by its address and by a secret."""
    if settings.user_header is None:
        if settings.proxy_secret is not None:
            raise ParameterError(f"--proxy-secret {settings.proxy_secret} given without --user-header; expected both")
        return
    for option, value, why in (
        ("--trusted-proxy ADDRESS", settings.trusted_proxies, "from which it comes"),
        ("--proxy-secret FILE", settings.proxy_secret, "as any process of that machine could send the header"),
    ):
        if not value:
            raise ParameterError(f"--user-header {settings.user_header} given without {option}, {why}; expected both")


def _require_alone(settings: Settings) -> None:
    """Without tokens everybody may command: only this machine may reach the server."""
    if not is_loopback(settings.host):
        raise ParameterError(
            f"--host {settings.host} reaches beyond this machine; "
            "expected --tokens FILE (muster serve --new-token NAME makes one)"
        )
    for name, given in (
        ("--user-header", settings.user_header),
        ("--trusted-proxy", settings.trusted_proxies),
        ("--proxy-secret", settings.proxy_secret),
        ("--public-origin", settings.public_origins),
    ):
        if given:
            raise ParameterError(f"{name} given without --tokens FILE, which says who may command; expected both")
