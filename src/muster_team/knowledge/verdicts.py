"""What becomes of a statement that arrives: it is taken, waits for something, or is refused."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.value_types import shown


@dataclass(frozen=True, slots=True)
class Taken:
    """The statement counts."""


@dataclass(frozen=True, slots=True)
class Waits:
    """The statement counts as soon as these tasks are known."""

    tasks: tuple[str, ...]

    @property
    def reason(self) -> str:
        return f"it waits for {', '.join(map(shown, self.tasks))}, which there is not"


@dataclass(frozen=True, slots=True)
class Refused:
    """The statement does not count, for this reason."""

    reason: str


Verdict = Taken | Waits | Refused
TAKEN = Taken()
