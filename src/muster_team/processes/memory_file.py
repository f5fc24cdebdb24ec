"""The JSON file from which a robot's process continues after a restart.

It is written before anything is sent and before work begins. So a restarted robot never contradicts in an epoch what it
has stated in it before, and never waives a task that it has begun. What
no robot can mean is left out when the file is read.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from muster.mission.errors import Finding, InputError
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.messages import Claim, Fact
from muster_team.negotiators.negotiator import Negotiator

_SCHEMA = "muster-memory/1"

E = TypeVar("E")


@dataclass(frozen=True, kw_only=True)
class Kept:
    """The contents of the file.

    Parameters
    ----------
    auction
        the digest of mission and terms, in hexadecimal digits.
    robot, incarnation
        the robot, and the number of its last start; 0: it has never started.
    memory
        what it knew; None: nothing yet.
    """

    auction: str
    robot: str
    incarnation: int = 0
    memory: Memory | None = None

    def save(self, file: Path) -> None:
        """Write the file so that after a loss of power it holds either the new or the old contents."""
        beside = file.with_name(file.name + ".new")
        with beside.open("w", encoding="utf-8") as out:
            json.dump({"schema": _SCHEMA} | asdict(self), out, default=_plain)
            out.write("\n")
            out.flush()
            os.fsync(out.fileno())
        beside.replace(file)


def kept_of(file: Path | None, digest: bytes, robot: str) -> Kept:
    """What a robot has stored in the auction of this digest; raises as `kept_in`. None: it has no file."""
    return Kept(auction=digest.hex(), robot=robot) if file is None else kept_in(file, digest.hex(), robot)


def kept_in(file: Path, auction: str, robot: str) -> Kept:
    """The contents of a file; empty if there is none.

    Raises
    ------
    InputError
        if the file cannot be read, or belongs to another auction or robot.
    """
    nothing = Kept(auction=auction, robot=robot)
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        schema, whose, which = data["schema"], data["robot"], data["auction"]
    except FileNotFoundError:
        return nothing
    except (UnicodeError, ValueError, RecursionError, AttributeError, KeyError, TypeError):
        raise _wrong(file, "", "other content", "what --memory has written") from None
    if schema != _SCHEMA:
        raise _wrong(file, "schema", str(schema), _SCHEMA)
    if whose != robot:
        raise _wrong(file, "robot", str(whose), f"{robot}, or a new file")
    if which != auction:
        raise _wrong(file, "auction", "of another mission or other terms", "the same as before, or a new file")
    return replace(nothing, incarnation=_count(data.get("incarnation")), memory=_memory(data.get("memory", {})))


def keeper(file: Path, kept: Kept, negotiator: Negotiator) -> Callable[[], None]:
    """A function that stores what the robot knows in a file if that has changed."""

    def keep() -> None:
        nonlocal kept
        now = replace(kept, incarnation=negotiator.incarnation, memory=negotiator.memory)
        if now != kept:
            kept = now
            kept.save(file)

    return keep


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.hex()
    assert isinstance(value, frozenset)
    return sorted(value)


def _memory(data: Any) -> Memory | None:
    """What a robot knew. Entries that cannot be read are left out; then it does not remember everything."""
    if data is None:
        return None
    given = data if isinstance(data, dict) else {}
    claims = _entries(given.get("claims"), _claim)
    facts, reserved = (_entries(given.get(key), _fact) for key in ("facts", "reserved"))
    refused = _entries(given.get("refused"), lambda task: task if isinstance(task, str) else None)
    whole = all(None not in entries for entries in (claims, facts, reserved, refused))
    return Memory(
        claims=tuple(claim for claim in claims if claim is not None),
        facts=tuple(fact for fact in facts if fact is not None),
        epoch=_count(given.get("epoch")),
        knows=whole and given.get("knows") is True,
        refused=frozenset(task for task in refused if task is not None),
        reserved=tuple(fact for fact in reserved if fact is not None),
    )


def _entries(data: Any, read: Callable[[Any], E | None]) -> list[E | None]:
    """The entries of a list; None for each that cannot be read, and for a list that is none."""
    return [read(entry) for entry in data] if isinstance(data, list) else [None]


def _claim(data: Any) -> Claim | None:
    try:
        return Claim(**data)
    except TypeError:
        return None


def _fact(data: Any) -> Fact | None:
    try:
        return Fact(**data | {key: bytes.fromhex(data[key]) for key in ("content", "proof") if key in data})
    except (TypeError, ValueError):
        return None


def _count(value: Any) -> int:
    return value if type(value) is int and value >= 0 else 0


def _wrong(file: Path, field: str, value: str, expected: str) -> InputError:
    return InputError([Finding(str(file), None, field, value, expected)])
