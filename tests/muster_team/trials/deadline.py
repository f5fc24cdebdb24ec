"""The deadline of agreement after the last incident of a trial.

A robot that crashed at the last moment is suspected after `suspect_s`; by distant robots, or after links were cut,
after FAR times as long. So are robots that only the one that crashed had connected. Half as long again is allowed for
robots that heard from it last. A robot that was excluded is back after at most eight times `exclusion_s`. Then all
rounds follow, with declarations before and agreement after them. A message takes its delay, and a lost
one the time until it is requested again; on average it is sent 1 / (1 - loss) times, and twice that is allowed for each
round and hop. Loss has no upper bound, so agreement has none either: that trials keep this deadline is an observation.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tests.muster_team.trials.faults import Links
from tests.muster_team.trials.scenario import Scenario

from muster_team.membership.members import FAR
from muster_team.negotiators.negotiator import Negotiator
from muster_team.network.memory_network import TICK_S

OTHER_WORDS = 3
"""Declarations, agreement and permanent facts: each takes as long as a round."""


def someone_is_left_out(nodes: Collection[Negotiator], now: float) -> bool:
    """Whether a running robot regards another running robot as muted."""
    return any(a.members.is_excluded(b.robot, now) for a in nodes for b in nodes if a is not b)


def deadline_s(scenario: Scenario, group: Sequence[str], rounds: int, *, left_out: bool) -> float:
    """The deadline for a group that needs this number of rounds, seconds after the last incident."""
    timeouts, conditions = scenario.timeouts, scenario.conditions
    word_s = (timeouts.retry_s + TICK_S + conditions.delay_s + conditions.jitter_s) / (1 - conditions.loss)
    alone_s = 8 * timeouts.exclusion_s if left_out else 0.0
    hops = _hops(scenario.links, group, group)
    robots = [robot.id for robot in scenario.mission.robots]
    far = _hops(scenario.links, group, robots) > 1 or any(
        incident.kind in ("cut", "block") for incident in scenario.incidents
    )
    missed_s = 1.5 * timeouts.suspect_s * (FAR if far else 1.0)
    return missed_s + alone_s + 2 * (rounds + OTHER_WORDS) * hops * word_s


def _hops(links: Links | None, group: Sequence[str], others: Sequence[str]) -> int:
    """The greatest number of hops that a message takes from a group to others, or through them."""
    if links is None:
        return 1
    return max(_farthest(robot, links, others) for robot in group)


def _farthest(robot: str, links: Links, others: Sequence[str]) -> int:
    hops = {robot: 0}
    way = [robot]
    for a in way:
        for b in others:
            if b not in hops and {(a, b), (b, a)} <= links:
                hops[b] = hops[a] + 1
                way.append(b)
    return max(1, hops[way[-1]])
