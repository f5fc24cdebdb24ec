"""The auction without a centre: part of `muster bench`.

Twenty robots and fifty tasks at random places; each robot is a process of this machine. Measured from when all are
ready until the last of them is known to agree; and from when three are killed in the middle, until all others are.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from random import Random

from muster.allocation.auctions.auction import Parameters
from muster.generation.uniform import uniform_mission
from muster.mission.errors import MusterError
from muster.model.problem import Problem
from muster_studies.benches.measurement import Measurement
from muster_team.network.keys import new_key
from muster_team.network.transport import TRANSPORTS
from muster_team.processes.process_reports import TeamSetup
from muster_team.processes.team import Team, timeouts_for

ROBOTS, TASKS, GUARD_S = 20, 50, 120.0
VICTIMS, KILLED_IN_ROUND = ("r_0", "r_7", "r_13"), 10


def scene(seed: int) -> Problem:
    """Robots and tasks at random places of a square."""
    return Problem.compile(uniform_mission(Random(seed), robots=ROBOTS, tasks=TASKS)).ready()


def held(problem: Problem, transport: str, victims: Sequence[str] = ()) -> tuple[float, Counter[str], int]:
    """Seconds to agreement, messages by kind, and the total of bytes sent.

    With `victims` the seconds are from when these are killed, in the middle of the auction.

    Raises
    ------
    MusterError
        if there is no agreement within GUARD_S.
    """
    setup = TeamSetup(
        problem=problem, terms=Parameters(), key=new_key(), transport=transport, timeouts=timeouts_for(ROBOTS)
    )
    until_s = time.monotonic() + GUARD_S
    with Team(setup) as team:
        killed_s = None
        while team.agreement() is None:
            team.poll(0.02)
            if killed_s is None and any(news.status.round >= KILLED_IN_ROUND for news in team.progress.values()):
                killed_s = time.monotonic()
                for robot in victims:
                    team.kill(robot)
            if time.monotonic() > until_s:
                raise MusterError(f"no agreement over {transport} within {GUARD_S:g} s")
        began_s = killed_s if victims else team.began_s
        assert began_s is not None
        seconds = time.monotonic() - began_s
        sent, volume = Counter[str](), 0
        for news in team.progress.values():
            sent.update(news.status.sent)
            volume += sum(news.status.sent_bytes.values())
        return seconds, sent, volume


def auction(runs: int) -> list[Measurement]:
    """Over UDP and over Zenoh, on the loopback interface."""
    found = []
    for transport in TRANSPORTS:
        outcomes = [held(scene(seed), transport) for seed in range(runs)]
        share = ROBOTS * TASKS * runs
        messages = sum(sum(sent.values()) for _, sent, _ in outcomes) / share
        repairs = sum(sent["repairs"] for _, sent, _ in outcomes) / share
        volume = sum(volume for *_, volume in outcomes) / share
        cost = f"{messages:.2f} messages ({repairs:.2f} repairs), {volume:.0f} bytes given to {transport}"
        name = f"auction of {ROBOTS} processes, {TASKS} tasks, over {transport}"
        found.append(
            Measurement.over_runs(
                name, "s", [seconds for seconds, *_ in outcomes], "< 10", f"per task and robot {cost}"
            )
        )
        name = f"the same from when {len(VICTIMS)} were killed in round {KILLED_IN_ROUND}, over {transport}"
        found.append(
            Measurement.over_runs(
                name, "s", [held(scene(seed), transport, VICTIMS)[0] for seed in range(runs)], "< 10", ""
            )
        )
    return found
