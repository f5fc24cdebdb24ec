"""Refuses unknown keyword arguments, and names the nearest known one."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean


def require_known(given: Iterable[str], known: Collection[str], what: str = "") -> None:
    """Refuse the first name that is not known.

    Parameters
    ----------
    what
        the class or function that takes the names, for the message.

    Raises
    ------
    ParameterError
        with the nearest known name, or all of them.
    """
    for name in given:
        if name not in known:
            hint = did_you_mean(name, known) or f"; expected {', '.join(known) or 'none'}"
            raise ParameterError(f"{what}{': ' if what else ''}{name}: unknown{hint}")
