"""Messages that no stranger can make or read."""

from __future__ import annotations

from pathlib import Path

from muster.allocation.problem import Problem
from muster.allocation.terms import Terms


def mission_digest(problem: Problem, terms: Terms) -> bytes:
    """What robots that take part must have in common: mission, objective, ignored rules, terms. 16 bytes."""
    raise NotImplementedError


def new_key() -> bytes:
    """A key that nobody has."""
    raise NotImplementedError


def write_key(path: Path, key: bytes) -> None:
    """Write a key to a new file that its owner alone can read."""
    raise NotImplementedError


def read_key(path: Path) -> bytes:
    """The key of a file."""
    raise NotImplementedError


class Seal:
    """Closes what one process of a robot sends, and opens what it receives."""

    def __init__(self, key: bytes, context: bytes, robot: str, incarnation: int) -> None:
        raise NotImplementedError

    def close(self, data: bytes) -> bytes:
        raise NotImplementedError

    def open(self, data: bytes) -> bytes | None:
        raise NotImplementedError
