"""What a robot's process remembers when it starts again: how often it has started, and what the robot owns. JSON."""

from __future__ import annotations

import json
import os
from dataclasses import astuple, dataclass
from pathlib import Path

from muster.mission.errors import Finding, InputError
from muster.negotiation.messages import Claim

_SCHEMA = "muster-memory/1"


@dataclass(frozen=True, kw_only=True)
class Memory:
    """What is remembered of a robot; `auction` is the digest of the mission and terms, in hexadecimal digits."""

    auction: str
    robot: str
    incarnation: int = 0
    claims: tuple[Claim, ...] = ()

    def save(self, file: Path) -> None:
        """Write it, so that after a loss of power the file holds this or what it held before."""
        data = {"schema": _SCHEMA, "auction": self.auction, "robot": self.robot, "incarnation": self.incarnation}
        text = json.dumps(data | {"claims": [list(astuple(claim)) for claim in self.claims]})
        beside = file.with_name(file.name + ".new")
        with beside.open("w", encoding="utf-8") as out:
            out.write(text + "\n")
            out.flush()
            os.fsync(out.fileno())
        beside.replace(file)


def remembered(file: Path, auction: str, robot: str) -> Memory:
    """What a file holds; where there is none, nothing is remembered.

    Raises
    ------
    InputError
        if the file cannot be read, or is of another auction or robot.
    """
    nothing = Memory(auction=auction, robot=robot)
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        claims = tuple(_claim(*row) for row in data["claims"])
        found = Memory(
            auction=data["auction"], robot=data["robot"], incarnation=int(data["incarnation"]), claims=claims
        )
        known = data["schema"] == _SCHEMA
    except FileNotFoundError:
        return nothing
    except (UnicodeError, ValueError, KeyError, TypeError):
        raise _wrong(file, "", "other content", "what --memory has written") from None
    if not known:
        raise _wrong(file, "schema", str(data["schema"]), _SCHEMA)
    if found.robot != robot:
        raise _wrong(file, "robot", found.robot, f"{robot}, or a new file")
    if found.auction != auction:
        raise _wrong(file, "auction", "of another mission or other terms", "the same as before, or a new file")
    return found


def _claim(task: str, price: float, number: int, begun: bool) -> Claim:
    return Claim(str(task), float(price), int(number), bool(begun))


def _wrong(file: Path, field: str, value: str, expected: str) -> InputError:
    return InputError([Finding(str(file), None, field, value, expected)])
