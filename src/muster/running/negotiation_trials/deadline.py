"""How long agreement may take once it is quiet.

A robot that crashed at the last moment is missed after `suspect_s`, by those that it is far from, or was while links
were cut, after FAR times as long; half as long again is for those that heard of it last. Who was left out is back after
at most eight times `exclusion_s`. Then all rounds are held, with declarations before and agreement after. A word takes
as long as its way, and where it is lost until it is asked for again; it is said 1 / (1 - loss) times on average, and
twice that is allowed for each round and hop. Loss has no upper bound, so agreement has none either: that runs keep to
this was measured.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from muster.negotiation.members import FAR
from muster.negotiation.memory_network import TICK_S
from muster.negotiation.negotiator import Negotiator
from muster.running.negotiation_trials.faults import Links
from muster.running.negotiation_trials.scenario import Scene

OTHER_WORDS = 3
"""Declarations, agreement, and what is known for good: as long as a round each."""


def someone_is_left_out(nodes: Collection[Negotiator], now: float) -> bool:
    """Whether a robot that lives keeps another waiting in its eyes."""
    return any(a.members.is_excluded(b.robot, now) for a in nodes for b in nodes if a is not b)


def deadline_s(scene: Scene, group: Sequence[str], rounds: int, *, left_out: bool) -> float:
    """By when a group agrees that needs so many rounds, seconds after it is quiet."""
    timeouts, conditions = scene.timeouts, scene.conditions
    word_s = (timeouts.retry_s + TICK_S + conditions.delay_s + conditions.jitter_s) / (1 - conditions.loss)
    alone_s = 8 * timeouts.exclusion_s if left_out else 0.0
    hops = _hops(scene.links, group)
    far = hops > 1 or any(incident.kind in ("cut", "block") for incident in scene.incidents)
    missed_s = 1.5 * timeouts.suspect_s * (FAR if far else 1.0)
    return missed_s + alone_s + 2 * (rounds + OTHER_WORDS) * hops * word_s


def _hops(links: Links | None, group: Sequence[str]) -> int:
    """From how many robots to the next a word goes on at most."""
    if links is None:
        return 1
    return max(_farthest(robot, links, group) for robot in group)


def _farthest(robot: str, links: Links, group: Sequence[str]) -> int:
    hops = {robot: 0}
    way = [robot]
    for a in way:
        for b in group:
            if b not in hops and {(a, b), (b, a)} <= links:
                hops[b] = hops[a] + 1
                way.append(b)
    return max(1, hops[way[-1]])
