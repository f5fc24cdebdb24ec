"""Tasks that several robots begin at the same moment: what each robot states of them, and what follows from that.

A robot that is at such a task states (`ready`) from when it could begin, how long its part takes, and with whom it owns
the task. When the statements of all are known, each computes the same begin. A robot that leaves again states that
(`left`); one that has begun states that (`joined`), and one that has done its part too (`part`). A task is done when
all of its team have done their parts, and all robots of tasks that are tied to it have at least begun.

Statements belong to an attempt. Only the highest attempt that is known counts: a robot that learned of the begin too
late, or comes back, states a higher one, and whoever has begun the lower one breaks it off.

Times are those of the mission, which robots share where tasks have time windows.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from muster.mission.value_types import shown
from muster_team.knowledge.messages import Fact

Members = tuple[tuple[str, str], ...]
"""Those that begin at the same moment: each robot with its task, in order."""


@dataclass(frozen=True)
class Presence:
    """The content of `ready`: the attempt, the earliest begin, how long the part takes, and with whom."""

    attempt: int
    from_s: float
    lasts_s: float
    members: Members

    @property
    def content(self) -> bytes:
        return _bytes([self.attempt, self.from_s, self.lasts_s, self.members])


@dataclass(frozen=True)
class Start:
    """What follows from the statements of all that begin together.

    Parameters
    ----------
    attempt, members
        as they state.
    from_s
        when all of them could begin.
    lasts_s
        of each task how long it takes: as long as for its slowest robot.
    """

    attempt: int
    from_s: float
    lasts_s: Mapping[str, float]
    members: Members

    def team(self, task: str) -> tuple[str, ...]:
        """The robots of one of the tasks."""
        return team_in(self.members, task)

    @property
    def content(self) -> bytes:
        """The content of `joined` and `part`, the same for all: the attempt, its begin, and those that begin."""
        return _bytes([self.attempt, self.from_s, self.members])


def team_in(members: Members, task: str) -> tuple[str, ...]:
    return tuple(robot for robot, theirs in members if theirs == task)


@lru_cache(maxsize=4096)
def presence_of(content: bytes) -> Presence:
    """What a `ready` states."""
    attempt, from_s, lasts_s, members = json.loads(content)
    return Presence(attempt, from_s, lasts_s, tuple((robot, task) for robot, task in members))


@lru_cache(maxsize=4096)
def members_of(content: bytes) -> Members:
    """Those that begin, of a `joined` or `part`."""
    _, _, members = json.loads(content)
    return tuple((robot, task) for robot, task in members)


def presence_fault(kind: str, content: bytes, robots: Collection[str]) -> Iterator[str]:
    """What is wrong in the content of a `ready`, `left`, `joined` or `part`; nothing if these robots may state it."""
    try:
        stated = json.loads(content)
        attempt, *rest = stated
        times, members = (rest[:-1], [(robot, task) for robot, task in rest[-1]]) if kind != "left" else (rest, [])
    except (ValueError, TypeError, RecursionError, IndexError):
        yield f"{kind} with {_as_text(content)}"
        return
    wants = {"ready": 2, "left": 0}.get(kind, 1)
    names = [name for pair in members for name in pair]
    numbers = all(type(value) in (int, float) and math.isfinite(value) for value in times)
    if type(attempt) is not int or attempt < 0 or len(times) != wants or not numbers or not all(map(_is_text, names)):
        yield f"{kind} with {_as_text(content)}"
    elif kind != "left" and not (members and all(robot in robots for robot, _ in members)):
        yield f"{kind} of robots that there are not: {_as_text(content)}"


def _as_text(content: bytes) -> str:
    return shown(content.decode("utf-8", "replace"))


def _is_text(value: object) -> bool:
    return type(value) is str


def parts_of_deeds(facts: Sequence[Fact]) -> dict[tuple[str, bytes], tuple[Fact, ...]]:
    """For each task done by several robots, and each time that it was, the parts: of all of its team, in order."""
    parts: dict[tuple[str, bytes], dict[str, Fact]] = {}
    there: dict[bytes, set[tuple[str, str]]] = {}
    for fact in facts:
        if fact.kind in ("joined", "part"):
            there.setdefault(fact.content, set()).add((fact.robot, fact.task))
        if fact.kind == "part":
            parts.setdefault((fact.task, fact.content), {}).setdefault(fact.robot, fact)
    return {
        (task, content): tuple(stated.values())
        for (task, content), stated in parts.items()
        if stated.keys() >= set(team_in(members_of(content), task)) and there[content] >= set(members_of(content))
    }


def left_content(attempt: int) -> bytes:
    """The content of `left`: the attempt in which the robot was ready."""
    return _bytes([attempt])


def presences(facts: Iterable[Fact], unit: Collection[str]) -> dict[tuple[str, int], tuple[str, Presence]]:
    """For each robot and attempt what it stated for one of the tasks that begin together, with that task."""
    stated = (fact for fact in facts if fact.kind == "ready" and fact.task in unit)
    found = ((fact.robot, fact.task, presence_of(fact.content)) for fact in stated)
    return {(robot, presence.attempt): (task, presence) for robot, task, presence in found}


def attempt_of(facts: Iterable[Fact], unit: Collection[str]) -> int:
    """The attempt that counts for the tasks that begin together.

    An attempt is over when a robot has left it, and when one that has lost its memory has stated two things in it.
    Each attempt follows from a statement in the one before it: a number above that of all statements is none.
    """
    mine = [fact for fact in facts if fact.task in unit and fact.kind in ("ready", "left")]
    most = len(mine)
    ready = {(fact.robot, fact.content) for fact in mine if fact.kind == "ready"}
    stated = Counter((robot, presence_of(content).attempt) for robot, content in ready)
    over = [json.loads(fact.content)[0] for fact in mine if fact.kind == "left"]
    over += [attempt for (_, attempt), times in stated.items() if times > 1]
    said = [*(attempt for _, attempt in stated), *(attempt + 1 for attempt in over)]
    return max((attempt for attempt in said if attempt <= most), default=0)


def absent(facts: Collection[Fact], unit: Sequence[str], attempt: int, members: Members) -> Members:
    """Of those that begin together the ones that have not stated so, in this attempt and with these."""
    stated = presences(facts, unit)

    def is_ready(robot: str, task: str) -> bool:
        said = stated.get((robot, attempt))
        return said is not None and said[0] == task and said[1].members == members

    return tuple((robot, task) for robot, task in members if not is_ready(robot, task))


def start_of(facts: Collection[Fact], unit: Sequence[str], attempt: int, members: Members) -> Start:
    """The begin that follows when nobody is absent."""
    stated = presences(facts, unit)
    said = [(task, stated[robot, attempt][1]) for robot, task in members]
    lasts_s: dict[str, float] = {}
    for task, presence in said:
        lasts_s[task] = max(lasts_s.get(task, 0.0), presence.lasts_s)
    return Start(attempt, max(presence.from_s for _, presence in said), lasts_s, members)


def _bytes(content: Sequence[Any]) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode()
