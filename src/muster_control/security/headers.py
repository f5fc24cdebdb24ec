"""Security headers of responses (OWASP secure headers; CSP level 3).

NiceGUI's page needs `unsafe-inline` and `unsafe-eval`, as Vue compiles its templates in the browser. Other origins are
forbidden. Responses of the API that a browser shows (a record's page, a picture) run in a sandbox without the session.
"""

from __future__ import annotations

_PAGE = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "media-src 'self' data: blob:",
        "connect-src 'self'",
        "worker-src 'self' blob:",
        "frame-src 'self'",
        "frame-ancestors 'self'",
        "object-src 'none'",
        "base-uri 'self'",
        "form-action 'self'",
    )
)
_ANSWER = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline'",
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        "frame-ancestors 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "sandbox allow-scripts allow-downloads",
    )
)
_ALWAYS = (
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"SAMEORIGIN"),
    (b"referrer-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"permissions-policy", b"camera=(), geolocation=(), microphone=(), payment=(), usb=()"),
)
STATIC = ("/_nicegui/", "/assets/", "/tiles/")  # files that are the same for everybody


def is_static(path: str) -> bool:
    """Whether the path is a static file, of which one page needs many."""
    return path.startswith(STATIC)


def is_page(path: str) -> bool:
    """Whether the path is a page, which is built for each visitor and kept for a while."""
    return not is_static(path) and not path.startswith(("/api/", "/_nicegui", "/healthz", "/metrics", "/login"))


def security_headers(path: str, *, tls: bool) -> list[tuple[bytes, bytes]]:
    """The security headers of a response for this path."""
    answer = path.startswith("/api/")
    headers = [*_ALWAYS, (b"content-security-policy", (_ANSWER if answer else _PAGE).encode())]
    if tls:
        headers.append((b"strict-transport-security", b"max-age=31536000"))
    return headers


def with_security(headers: list[tuple[bytes, bytes]], path: str, *, tls: bool) -> list[tuple[bytes, bytes]]:
    """A response's headers with the security headers, which replace its own except `Cache-Control`."""
    ours = security_headers(path, tls=tls)
    names = {name for name, _ in ours} | {b"server"}
    kept = [(name, value) for name, value in headers if name.lower() not in names]
    if not is_static(path) and not any(name.lower() == b"cache-control" for name, _ in kept):
        kept.append((b"cache-control", b"no-store"))
    return kept + ours
