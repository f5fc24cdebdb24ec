"""Imports of optional parts of the installation."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from muster.mission.errors import MissingExtraError


@contextmanager
def needs_extra(extra: str, purpose: str, how: str = "") -> Iterator[None]:
    """Turn an import that fails within the context into a `MissingExtraError`.

    Parameters
    ----------
    extra : str
        The extra that has what is imported.
    purpose : str
        What needs it.
    how : str
        What to install, where that is not the extra.
    """
    try:
        yield
    except ImportError:
        raise MissingExtraError(extra, purpose, how) from None
