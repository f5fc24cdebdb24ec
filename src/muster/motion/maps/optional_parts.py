"""The check that the extra `map` is installed: Pillow, SciPy and Shapely."""

from __future__ import annotations

from importlib.util import find_spec

from muster.mission.errors import MissingExtraError


def require_map_extra(purpose: str = "a map") -> None:
    """Raise MissingExtraError where Pillow, SciPy or Shapely is not installed."""
    if not all(find_spec(name) for name in ("PIL", "scipy", "shapely")):
        raise MissingExtraError("map", purpose)
