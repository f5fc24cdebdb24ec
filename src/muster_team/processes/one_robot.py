"""One robot of a team that runs on other machines: how long its process stays, and when it gives up."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from muster.mission.errors import NetworkError
from muster.mission.system.clock import Clock, SystemClock
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.robot_view import View, view_of
from muster_team.processes.node import Node, NodeStatus

_STEP_S = 0.05
_NAMES_SHOWN = 5
_HEARD_S = 3.0
"""The time within which a robot that understands this one should answer, seconds."""


@dataclass(frozen=True, kw_only=True)
class StayLimits:
    """How long a robot's process stays, seconds.

    Parameters
    ----------
    wait_s
        for robots of the team that are missing; then it agrees with those that are present.
    linger_s
        after agreement, so that all others learn of it.
    limit_s
        in all; then it gives up.
    """

    wait_s: float = 20.0
    linger_s: float = 5.0
    limit_s: float = 60.0


def take_part(
    node: Node,
    limits: StayLimits,
    on_status: Callable[[NodeStatus], None],
    clock: Clock | None = None,
) -> tuple[View, float]:
    """Take part until all robots that are present agree; return the robot's view, and the time to agreement in seconds.

    An agreement of the whole team holds even if robots leave or fall silent while this one lingers.

    `on_status` receives the robot's status about twenty times a second.

    Raises
    ------
    NetworkError
        if another process uses its id, the team has counted it out for good, no other robot is present, all others have
        another mission or version, or there is no agreement in time.
    """
    clock, negotiator = clock or SystemClock(), node.negotiator
    began_s = clock.now()
    agreed: tuple[View, float] | None = None
    by_all = False
    while True:
        node.step(_STEP_S)
        status, passed_s = node.status(), clock.now() - began_s
        on_status(status)
        _check_name(status, negotiator)
        _check_company(status, negotiator, passed_s, limits)
        whole = len(status.members) == len(negotiator.rules.robots)
        if status.settled and (whole or (passed_s >= limits.wait_s and not by_all)):
            if agreed is None or agreed[0].stage != negotiator.stage:
                agreed, by_all = (view_of(negotiator), passed_s), whole
        elif not by_all:
            agreed = None
        if agreed is not None and passed_s >= agreed[1] + limits.linger_s:
            return agreed
        if agreed is None and passed_s > limits.limit_s:
            raise NetworkError(f"{status.robot}: no agreement within {limits.limit_s:g} s; {_how_far(status)}")


def new_incarnation(before: int = 0) -> int:
    """A number above all earlier ones: from the machine's clock, or one more than the last that is remembered."""
    return max(before + 1, time.time_ns() // 1_000_000)


def _check_name(status: NodeStatus, negotiator: Negotiator) -> None:
    if status.superseded and status.rivals:
        raise NetworkError(
            f"{status.robot}: another process has started under this name; expected one for each robot, this one ends"
        )
    reasons = [n.reason for n in negotiator.notices if n.kind == "revoked" and n.robots == (status.robot,)]
    if reasons:
        raise NetworkError(
            f"{status.robot}: the team goes on without it, as {reasons[0]}; expected a new key of it in every roster"
        )


def _check_company(status: NodeStatus, negotiator: Negotiator, passed_s: float, limits: StayLimits) -> None:
    """Raise NetworkError with the reason if no other robot is understood."""
    if status.received or len(negotiator.rules.robots) == 1:
        return
    refused = status.refused
    if passed_s < min(_HEARD_S, limits.wait_s, limits.limit_s):
        return
    if refused["other_version"]:
        raise NetworkError(f"{status.robot}: the others speak another version; expected the same Muster everywhere")
    if refused["other_mission"]:
        raise NetworkError(
            f"{status.robot}: the others hold another auction; expected everywhere the same mission and terms, and "
            "the same roster"
        )
    if passed_s < min(limits.wait_s, limits.limit_s):
        return
    if refused["foreign"]:
        raise NetworkError(
            f"{status.robot}: {refused['foreign']} messages, none made with this key; expected the same key everywhere"
        )
    others = [robot for robot in negotiator.rules.robots if robot != status.robot]
    names = ", ".join(others[:_NAMES_SHOWN]) + (" ..." if len(others) > _NAMES_SHOWN else "")
    raise NetworkError(f"{status.robot}: nobody there for {passed_s:.0f} s; expected to hear one of {names}")


def _how_far(status: NodeStatus) -> str:
    silent = f", nothing heard of {', '.join(status.silent[:_NAMES_SHOWN])}" if status.silent else ""
    return f"in round {status.round} of epoch {status.epoch} with {len(status.members)} robots{silent}"
