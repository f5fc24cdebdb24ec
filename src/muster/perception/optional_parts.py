"""The optional parts that perception needs."""

from __future__ import annotations

from importlib.util import find_spec

from muster.mission.errors import MissingExtraError


def require_physics(purpose: str, *modules: str) -> None:
    """Raise MissingExtraError, which names `purpose`, where one of these modules of the extra `physics` is missing."""
    if not all(find_spec(name) for name in modules):
        raise MissingExtraError("physics", purpose)
