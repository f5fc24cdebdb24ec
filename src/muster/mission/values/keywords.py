"""Refuses unknown names and keyword arguments, and names the nearest known one."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean


def require_one_of(what: str, word: str, known: Collection[str], joined_by: str = ", ") -> None:
    """Raise `ParameterError` unless a word is one of those that are known.

    Parameters
    ----------
    what : str
        What the word is the name of, for the message: `law`.
    word : str
        The word that a caller gives.
    known : Collection[str]
        The words that are accepted, in the order in which the message lists them.
    joined_by : str
        What stands between the words of this list.

    Raises
    ------
    ParameterError
        With all known words, and the nearest of them.
    """
    if word not in known:
        raise ParameterError(f"{what}: {word}; expected {joined_by.join(known)}{did_you_mean(str(word), known)}")


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
