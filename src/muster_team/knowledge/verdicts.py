"""What becomes of a statement that arrives: it is taken, waits for something, or is refused."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Taken:
    """The statement counts."""


@dataclass(frozen=True, slots=True)
class Waits:
    """The statement counts as soon as these tasks are known."""

    tasks: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Refused:
    """The statement does not count, for this reason."""

    reason: str


Verdict = Taken | Waits | Refused
TAKEN = Taken()
