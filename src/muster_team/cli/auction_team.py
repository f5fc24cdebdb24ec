"""`muster auction` of a whole team on this machine."""

from __future__ import annotations

import sys
import time
from collections import Counter
from typing import Any

import click

from muster.mission.errors import MusterError
from muster.mission.texts.counting import counted
from muster.model.problem import Problem
from muster_team.cli.auction_result import Agreement, by_kind
from muster_team.cli.auction_table import auction_table
from muster_team.negotiators.methods import Method
from muster_team.negotiators.robot_view import View
from muster_team.network.keys import new_key
from muster_team.processes.process_reports import TeamSetup
from muster_team.processes.team import Team, timeouts_for

_LOOK_S = 0.05


def agree_here(
    problem: Problem, terms: Any, method: Method, transport: str, limit_s: float, *, quiet: bool, verbose: bool
) -> Agreement:
    """Start a process for each robot, and wait until all that have not crashed agree.

    Raises
    ------
    MusterError
        if they do not within the limit, or a robot cannot take part.
    """
    setup = TeamSetup(
        problem=problem,
        terms=terms,
        key=new_key(),
        method=method.name,
        transport=transport,
        timeouts=timeouts_for(len(problem.robots)),
    )
    until_s = time.monotonic() + limit_s
    told: set[str] = set()
    with Team(setup) as team, auction_table(problem, transport, wanted=not quiet) as show:
        views = None
        while views is None:
            team.poll(_LOOK_S)
            show(team)
            for robot in team.ended.keys() - told:
                told.add(robot)
                if not quiet:
                    sys.stderr.write(f"{robot}: {team.ended[robot]}; the others go on\n")  # above the table
            if time.monotonic() > until_s:
                raise MusterError(f"no agreement within {limit_s:g} s: {_why_not(team)}")
            views = team.agreement()
        assert team.began_s is not None
        took_s = time.monotonic() - team.began_s
    if not quiet:
        click.echo(_summary(team, views, took_s), err=True)
    return Agreement(views, took_s)


def _why_not(team: Team) -> str:
    if team.began_s is None:
        return "not all processes had started"
    unsettled = [
        robot for robot in team.living if robot not in team.progress or not team.progress[robot].status.settled
    ]
    if not unsettled:
        return "robots do not take the same ones for members"
    status = team.progress[unsettled[0]].status if unsettled[0] in team.progress else None
    where = "" if status is None else f", the first in round {status.round} of epoch {status.epoch}"
    return f"{counted(len(unsettled), 'robot')} not done: {', '.join(unsettled[:5])}{where}"


def _summary(team: Team, views: dict[str, View], took_s: float) -> str:
    sent, volume = Counter[str](), 0
    for robot in team.living:
        status = team.progress[robot].status
        sent.update(status.sent)
        volume += sum(status.sent_bytes.values())
    stage = next(iter(views.values())).stage
    return (
        f"{counted(len(views), 'robot')} agreed after {took_s:.2f} s, in round {stage.round} of epoch {stage.epoch}; "
        f"{sum(sent.values())} messages ({by_kind(sent)}), {volume / 1000:.0f} kB"
    )
