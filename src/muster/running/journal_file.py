"""Files of journals: what a run with real robots has told and ordered, line by line, each synced to disk.

The first line says whose journal it is: the mission, the fleet, the plan. Each other line is an entry as in the log of
a run of mission control: `time_s`, `kind`, `data`. `muster.mission.system.checked_lines` has the form of lines.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from hashlib import sha256
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, InputError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.mission.system.checked_lines import checked_line, text_of
from muster.mission.system.platforms import data_folder
from muster.mission.texts.counting import counted
from muster.mission.value_types import shown
from muster.mission.yaml_writer import plain
from muster.report.record.json_messages import json_bytes
from muster.state import MissionState
from muster.state.recovery import ORDER, WANTED, recovered_from
from muster.state.task_events import Ends

SCHEMA = "muster-journal/1"
_EXPECTED = f"a journal as Muster writes it ({SCHEMA})"


def journal_place(fleet: str, claims: Collection[str]) -> Path:
    """Return where the journal of runs with a fleet is kept: in the user's folder, a file for the same claims."""
    digest = sha256("\n".join(sorted(claims)).encode()).hexdigest()
    name = "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in fleet)
    return data_folder() / "journals" / f"{name}-{digest[:12]}.journal"


@dataclass(frozen=True)
class Header:
    """Whose journal a file is.

    Attributes
    ----------
    mission : str
        Name of the mission.
    parts : mapping
        By top-level key of the mission file the SHA-256 of its value.
    fleet, claims
        The fleet, and what its runs claim.
    plan : mapping
        The plan with which the run began, as plain data.
    began : str
        Date and time at which the run began, ISO 8601.
    record : str, optional
        The record of the run.
    """

    mission: str
    parts: Mapping[str, str]
    fleet: str
    claims: tuple[str, ...]
    plan: Mapping[str, Any]
    began: str
    record: str | None = None

    @property
    def name(self) -> str:
        """The mission, and when its run began, in words."""
        return f"mission {shown(self.mission)}, begun {self.began}"

    @classmethod
    def of(
        cls, mission: Mission, plan: Plan, fleet: str, claims: Collection[str], record: str | Path | None = None
    ) -> Header:
        """Return the header of a run that begins now."""
        return cls(
            mission=mission.name,
            parts=parts_of(mission),
            fleet=fleet,
            claims=tuple(sorted(claims)),
            plan=plan.as_dict(),
            began=datetime.now().astimezone().isoformat(timespec="seconds"),
            record=None if record is None else str(Path(record).absolute()),
        )


def parts_of(mission: Mission) -> dict[str, str]:
    """Return by top-level key of a mission the SHA-256 of its value."""
    return {key: sha256(json.dumps(value, default=str).encode()).hexdigest() for key, value in plain(mission).items()}


@dataclass(frozen=True)
class ReadJournal:
    """A journal that was read.

    Attributes
    ----------
    path : Path
        The file.
    header : Header
        Whose journal it is.
    entries : tuple of mappings
        The entries, in order.
    whole_bytes : int
        Size of what is whole; a line after it, if there is one, was cut short.
    """

    path: Path
    header: Header
    entries: tuple[Mapping[str, Any], ...]
    whole_bytes: int

    @property
    def plan(self) -> Plan:
        """The plan with which the run began."""
        return plan_from(self.header.plan, str(self.path))

    @property
    def ended(self) -> bool:
        """Whether the mission was over, and robots had got their last orders."""
        kinds = [entry["kind"] for entry in self.entries]
        return "final_states" in kinds and "mission_ended" in kinds[: _last(kinds, "final_states")]

    @property
    def progress(self) -> str:
        """How many tasks were done, in words."""
        return f"{counted(sum(entry['kind'] == Ends.kind for entry in self.entries), 'task')} done"

    @property
    def sent(self) -> set[str]:
        """The robots that were sent anywhere."""
        return {entry["data"]["robot"] for entry in self.entries if entry["kind"] == ORDER and entry["data"]["to"]}

    @property
    def at_end(self) -> str:
        """What robots were to do when all was done, if the run had come to that; empty: it had not."""
        return next((str(entry["data"]["at_end"]) for entry in self.entries if entry["kind"] == WANTED), "")

    @property
    def wanted(self) -> dict[str, str]:
        """What each robot was to do last, in words: by its last order, and what robots do when all is done."""
        last = {entry["data"]["robot"]: entry["data"] for entry in self.entries if entry["kind"] == ORDER}
        return {robot: self.at_end or _order_in_words(order) for robot, order in sorted(last.items())}

    def is_of(self, mission: Mission) -> bool:
        """Whether the run carried out this mission."""
        return self.header.parts == parts_of(mission)

    def state(self, mission: Mission) -> MissionState:
        """Return what was known of the mission after the last entry."""
        return recovered_from(mission, self.plan, self.entries)

    def require_of(self, mission: Mission, fleet: str, claims: Collection[str]) -> None:
        """Raise `InputError` unless this is a journal of the mission, with the same robots."""
        known, asked = self.header.parts, parts_of(mission)
        for key in (*known, *asked):
            if known.get(key) != asked.get(key):
                value = f"those of {self.header.name}"
                raise self._refusal(key, value, f"the {key} of {mission.source.file}, as when the run began")
        if self.header.fleet != fleet or set(self.header.claims) != set(claims):
            theirs = f"{self.header.fleet} ({', '.join(self.header.claims)})"
            raise self._refusal("fleet", theirs, f"{fleet} ({', '.join(sorted(claims))})")

    def require_under_way(self) -> None:
        """Raise `InputError` if the run has ended: nothing of it can be resumed."""
        if self.ended:
            value = f"that of {self.header.name}, has ended"
            raise self._refusal("run", value, "one that did not end (--recover brings robots home all the same)")

    def _refusal(self, field: str, value: str, expected: str) -> InputError:
        return InputError([Finding(str(self.path), None, field, value, expected)])


def _order_in_words(order: Mapping[str, Any]) -> str:
    if order["to"] is None:
        return "stay"
    tasks = f" for {', '.join(order['for'])}" if order["for"] else ""
    return f"go to ({', '.join(f'{c:.2f}' for c in order['to'])}){tasks}"


def _last(kinds: list[str], kind: str) -> int:
    return len(kinds) - 1 - kinds[::-1].index(kind)


def read_journal(path: str | Path) -> ReadJournal:
    """Read a journal, up to a last line that a crash has cut short.

    After a power cut the end that was not synced may have holes, which hold zeros: it is read up to the first one.

    Raises
    ------
    InputError
        if the file cannot be read, is no journal, or a line before the last is damaged otherwise.
    """
    file = Path(path)
    try:
        data = file.read_bytes()
    except OSError as error:
        raise InputError([Finding(str(file), None, "", error.strerror or str(error), _EXPECTED)]) from None
    lines = data.split(b"\n")[:-1]
    texts = [text_of(line) for line in lines]
    whole = next((k for k, text in enumerate(texts) if text is None), len(texts))
    if any(text is not None for text in texts[whole:]) and b"\0" not in lines[whole]:
        raise InputError([Finding(str(file), whole + 1, "", "a damaged line", _EXPECTED)])
    try:
        first, *rest = [json.loads(text) for text in texts[:whole] if text is not None]
        header = Header(**{**_header(first), "claims": tuple(first["claims"])})
        entries = tuple({**e, "time_s": float(e["time_s"]), "kind": str(e["kind"])} for e in rest)
    except (ValueError, TypeError, KeyError):
        raise InputError([Finding(str(file), None, "", "another file, or an empty one", _EXPECTED)]) from None
    return ReadJournal(file, header, entries, sum(len(line) + 1 for line in lines[:whole]))


def _header(first: Mapping[str, Any]) -> dict[str, Any]:
    if first["schema"] != SCHEMA:
        raise ValueError(first["schema"])
    return {key: value for key, value in first.items() if key != "schema"}


class JournalFile:
    """A journal that is written.

    Parameters
    ----------
    path : Path
        The file.
    header : Header, optional
        Of a run that begins: the file is made anew. Without one the run goes on: lines are appended.
    whole_bytes : int
        Size of what is whole of a journal that goes on.

    Raises
    ------
    InputError
        if the file cannot be written.
    """

    def __init__(self, path: Path, header: Header | None, whole_bytes: int = 0) -> None:
        self.path, self._dirty = path, False
        try:
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            if header is not None:
                _write_first_line(path, header)
            how = os.O_WRONLY | os.O_APPEND | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
            self._file = os.open(path, how)
            if header is None:
                os.ftruncate(self._file, whole_bytes)
        except OSError as error:
            raise InputError([Finding(str(path), None, "", error.strerror or str(error), "a file to write")]) from None

    def append(self, line: Mapping[str, Any]) -> None:
        """Append a line; raise `OSError` if it cannot be written."""
        data = checked_line(json_bytes(line))
        while data:
            data = data[os.write(self._file, data) :]
        self._dirty = True

    def sync(self) -> None:
        """Return when the disk has all that was appended; raise `OSError` if it has not."""
        if self._dirty:
            os.fsync(self._file)
            self._dirty = False

    def close(self) -> None:
        """Close the file."""
        os.close(self._file)

    def remove(self) -> None:
        """Remove the file: it cannot be written any more, and what it says is not true for long."""
        with suppress(OSError):
            self.path.unlink()


class SparedFile:
    """A journal that is removed where it cannot be written, as on a full disk: robots do not wait for it.

    Parameters
    ----------
    file : JournalFile
        The journal.
    give_up : callable
        Receives why it could not be written, once.
    """

    def __init__(self, file: JournalFile, give_up: Callable[[str], object]) -> None:
        self._file: JournalFile | None = file
        self._give_up = give_up

    def append(self, line: Mapping[str, Any]) -> None:
        """Append a line."""
        self._attempt(lambda file: file.append(line))

    def sync(self) -> None:
        """Return when the disk has all that was appended, or the journal is removed."""
        self._attempt(lambda file: file.sync())

    def close(self) -> None:
        """Sync and close the file."""
        self.sync()
        if self._file is not None:
            self._file.close()
            self._file = None

    def _attempt(self, act: Callable[[JournalFile], None]) -> None:
        if self._file is None:
            return
        try:
            act(self._file)
        except (OSError, ValueError) as error:
            self._file.remove()
            self._file.close()
            self._file = None
            self._give_up(getattr(error, "strerror", None) or str(error))


def _write_first_line(path: Path, header: Header) -> None:
    """Write and sync a file that has the header alone; the file before is there until this one is whole."""
    new = path.with_name(path.name + ".new")
    with os.fdopen(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
        file.write(checked_line(json_bytes({"schema": SCHEMA, **vars(header)})))
        file.flush()
        os.fsync(file.fileno())
    new.replace(path)
    _sync_folder(path.parent)


def _sync_folder(folder: Path) -> None:
    """Sync a folder, where the system can, so that a new file outlives a power cut."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
