"""The interface of readers of other programs' missions, and their registry."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from muster.mission.errors import MissionError
from muster.mission.import_ledger import Ledger, summary_lines
from muster.mission.model import Mission
from muster.mission.system.plugins import Registry, instance_expected, require_words

FLAGS = ("robots", "suitability", "salesmen", "depot", "columns", "origin")
"""The parameters of `load_noted` that go with some kinds of files."""


@dataclass(frozen=True)
class Noted:
    """A mission, and what its reader has chosen or not read, one line each.

    The ledger has the fate of every element of the files; it is empty for missions of Muster's own form, of which every
    key is read or refused.
    """

    mission: Mission
    notes: tuple[str, ...] = ()
    ledger: Ledger = Ledger()

    @property
    def said(self) -> tuple[str, ...]:
        """All there is to say of how the mission was read: the notes, and what of the ledger no note says."""
        return *self.notes, *summary_lines(self.ledger)


@dataclass(frozen=True, kw_only=True)
class MissionReader:
    """A reader of the missions of another program.

    Parameters
    ----------
    takes : callable
        Returns whether a path is such a mission. The path may name a folder, or no file.
    read : callable
        Reads the mission of a path. It gets the values of `flags` as keywords; None for those not given. Raises
        `MissionError` for a file that it cannot read.
    flags : collection of str
        Which of `FLAGS` go with such a mission.
    needed : str
        That of `flags` without which such a mission cannot be read; empty if all may be missing.
    suffixes : tuple of str
        Suffixes that such files alone have, with the dot.
    refusal : callable, optional
        Returns the error for a file of a kind that nothing reads, if this reader knows what to say of it.
    """

    takes: Callable[[Path], bool]
    read: Callable[..., Noted]
    flags: Collection[str] = ()
    needed: str = ""
    suffixes: tuple[str, ...] = ()
    refusal: Callable[[Path], MissionError | None] = lambda _: None

    def __post_init__(self) -> None:
        require_words("flags", self.flags, FLAGS)


MISSION_READERS: Registry[MissionReader] = Registry(
    "mission reader", "muster.mission_readers", instance_expected(MissionReader)
)


def reader_of(path: Path) -> MissionReader | None:
    """Return the reader that takes a path; None if no reader does."""
    return next((reader for reader in MISSION_READERS.usable().values() if reader.takes(path)), None)


def refusal_of(path: Path) -> MissionError | None:
    """Return what a reader says of a file of a kind that nothing reads; None if no reader says anything."""
    errors = (reader.refusal(path) for reader in MISSION_READERS.usable().values())
    return next((error for error in errors if error is not None), None)


def converted_suffixes() -> tuple[str, ...]:
    """Return the suffixes of missions of other programs."""
    return tuple(suffix for reader in MISSION_READERS.usable().values() for suffix in reader.suffixes)
