"""The check that the extra `net` is installed."""

from __future__ import annotations

from importlib.util import find_spec

from muster.mission.errors import MissingExtraError


def require_net(*modules: str) -> None:
    """Raise MissingExtraError where one of these modules of the extra `net` is not installed."""
    if not all(find_spec(name) for name in modules):
        raise MissingExtraError("net", "an auction over a network")
