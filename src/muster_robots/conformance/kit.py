"""Tests a fleet against all clauses."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Literal

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster_robots.conformance.clauses import CLAUSES, Clause
from muster_robots.conformance.stand import Stand, told

Result = Literal["holds", "lacks", "not declared", "left out", "not tried"]
_Seen = tuple[Result, str]


@dataclass(frozen=True)
class Finding:
    """What became of one clause.

    Parameters
    ----------
    clause, words : str
        Its name, and what must hold.
    result : str
        `holds`; `lacks`; `not declared`: the fleet lacks the ability, and says so; `left out`: as asked; `not tried`.
    seen : str
        What was seen, what the fleet lacks, or why the clause was not tried.
    """

    clause: str
    words: str
    result: Result
    seen: str

    @property
    def is_well(self) -> bool:
        """Whether the fleet conforms in this."""
        return self.result not in ("lacks", "not tried")


def findings(stand: Stand, without: Collection[str] = ()) -> Iterator[Finding]:
    """Test a fleet clause by clause; what follows is not tried if it does not open.

    Parameters
    ----------
    stand : Stand
        The fleet, and how its robots fall silent.
    without : collection of str
        Names of clauses that are left out.

    Raises
    ------
    ParameterError
        If there is no clause of such a name.
    """
    for name in without:
        if name not in CLAUSES:
            raise ParameterError(f"clause: {name}; expected {', '.join(CLAUSES)}{did_you_mean(name, CLAUSES)}")
    opens = True
    for name, clause in CLAUSES.items():
        left_out: _Seen | None = ("left out", "") if name in without else None
        result, seen = left_out or _excuse(stand, clause, opens=opens) or _tried(stand, clause)
        opens = opens and (name, result) != ("opens", "lacks")
        yield Finding(name, clause.words, result, seen)


def _excuse(stand: Stand, clause: Clause, *, opens: bool) -> _Seen | None:
    """Why a clause is not tried; None if it is."""
    if clause.ability and not stand.is_declared(clause.ability):
        return "not declared", f"ability {clause.ability}"
    if not opens:
        return "not tried", "the fleet does not open"
    if clause.silences and (stand.silence is None or stand.wake is None):
        return "not tried", "expected how a robot falls silent and answers again (--silence, --wake)"
    if clause.several and len(stand.mission.robots) < 2:
        return "not tried", "expected a mission with two robots"
    if clause.has_leases and stand.lease_reach_m < stand.lease_room_m:
        room_m = math.ceil(stand.lease_room_m)
        return "not tried", f"expected {room_m} m free east of {stand.mission.robots[0].id} (--lease-reach {room_m})"
    return None


def _tried(stand: Stand, clause: Clause) -> _Seen:
    try:
        return "holds", clause.check(stand)
    except Exception as error:  # whatever the code of another package raises is a finding
        return "lacks", told(error)
