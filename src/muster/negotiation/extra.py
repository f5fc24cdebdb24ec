"""The optional parts that a network asks for."""

from __future__ import annotations

from muster.mission.errors import MissingExtraError


def require_net() -> None:
    """Raise MissingExtraError where the extra `net` is not installed."""
    try:
        import cryptography
        import msgpack
        import zenoh  # noqa: F401
    except ImportError:
        raise MissingExtraError("net", "an auction over a network") from None
