"""`muster auction --robot NAME`: one robot of a team whose other robots run elsewhere. And orders that revoke keys."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import click

from muster.mission.errors import NetworkError, ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.model.problem import Problem
from muster_team.cli.auction_result import Agreement, by_kind
from muster_team.knowledge.messages import AUTHORITY
from muster_team.knowledge.signatures import NO_KEYS, Signatures
from muster_team.negotiators.methods import Method
from muster_team.negotiators.negotiator import Negotiator
from muster_team.network.keys import read_key
from muster_team.network.mission_digest import mission_digest
from muster_team.network.robot_keys import RobotKeys, order_line, public_key, read_roster, revocation
from muster_team.network.transport import Transport
from muster_team.processes.memory_file import kept_of
from muster_team.processes.node import NodeStatus
from muster_team.processes.node_factory import node_of
from muster_team.processes.one_robot import StayLimits, new_incarnation, take_part
from muster_team.processes.revocation_file import RevocationFile

_ANYWHERE = "0.0.0.0"  # noqa: S104 - the others are on other machines
_PORT = 7783
_AGAIN_S = 0.5


def agree_with_others(
    problem: Problem,
    terms: Any,
    method: Method,
    transport: str,
    options: dict[str, Any],
    *,
    quiet: bool,
    verbose: bool,
) -> Agreement:
    """Take part as one robot until all robots that take part agree.

    Raises
    ------
    ParameterError
        if the options do not name the robot, the key of the team, or the addresses of the others.
    NetworkError
        as `one_robot.take_part`; or if the network cannot be used so.
    InputError
        if the key or the memory cannot be read.
    """
    robot, file = options["robot"], options["memory"]
    if robot not in problem.robot_index:
        names = list(problem.robot_index)
        raise ParameterError(f"--robot: {robot}; expected one of {', '.join(names)}{did_you_mean(robot, names)}")
    if options["key_file"] is None:
        raise ParameterError("--key-file missing; expected with --robot (`muster auction --new-key FILE` makes one)")
    key, digest = read_key(options["key_file"]), mission_digest(problem, terms)
    kept = kept_of(file, digest, robot)
    kept = replace(kept, incarnation=new_incarnation(kept.incarnation))
    forgot = file is None  # for all it knows, it may have taken part before
    carrier = _transport(problem, transport, options)
    signatures = _signatures(options, problem, digest)
    how = {"forgot": forgot, "signatures": signatures}
    node = node_of(problem, terms, method, kept, file=file, key=key, transport=carrier, **how)

    def say(line: str) -> None:
        if not quiet:
            click.echo(line, err=True)

    if forgot and node.negotiator.once:
        say(f"{len(node.negotiator.once)} tasks are for at most one robot: without --memory they may find none")
    limits = StayLimits(wait_s=options["wait"], linger_s=options["linger"], limit_s=options["time_limit"])
    orders = None if options["revocations"] is None else RevocationFile(options["revocations"], node.negotiator)
    with node:
        watch = _Watch(node.negotiator, say, orders)
        view, took_s = take_part(node, limits, watch)
        watch.say_how_it_ended(node.status(), took_s)
    return Agreement({robot: view}, took_s)


def revocation_line(problem: Problem, terms: Any, options: dict[str, Any]) -> str:
    """The order that revokes the key of a robot in the auction with these terms, as a line of text.

    Raises
    ------
    ParameterError
        if there is no such robot, or the key is not that of the operator in the roster.
    InputError
        if the key or the roster cannot be read.
    """
    robot, own, roster = options["revoke"], options["robot_key"], options["roster"]
    names = list(problem.robot_index)
    if robot not in names:
        raise ParameterError(f"--revoke: {robot}; expected one of {', '.join(names)}{did_you_mean(robot, names)}")
    if own is None or roster is None:
        raise ParameterError("--robot-key and --roster: expected both with --revoke")
    key, public = read_key(own), read_roster(roster, names)
    if public.get(AUTHORITY) != public_key(key):
        raise ParameterError(f"--robot-key: {own}; expected the key whose public one {roster} gives {AUTHORITY}")
    return order_line(revocation(robot, key, mission_digest(problem, terms)))


def _signatures(options: dict[str, Any], problem: Problem, context: bytes) -> Signatures:
    """The robot's own key and the public keys of all, if it has them."""
    own, roster = options["robot_key"], options["roster"]
    if (own is None) != (roster is None):
        raise ParameterError("--robot-key and --roster: expected both, or neither")
    if own is None:
        return NO_KEYS
    key, public = read_key(own), read_roster(roster, list(problem.robot_index))
    if public[options["robot"]] != public_key(key):
        raise ParameterError(f"--robot-key: {own}; expected the key whose public one {roster} gives {options['robot']}")
    return RobotKeys(key, public, context)


class _Watch:
    """Prints which robots take part."""

    def __init__(self, negotiator: Negotiator, say: Callable[[str], None], orders: RevocationFile | None) -> None:
        self._negotiator, self._say, self._orders = negotiator, say, orders
        self._there: set[str] = set()
        self._settled, self._told = False, 0
        self._incarnation = negotiator.incarnation

    def __call__(self, status: NodeStatus) -> None:
        for wrong in [] if self._orders is None else self._orders.look():
            self._say(wrong)
        members = self._negotiator.members
        if self._negotiator.incarnation != self._incarnation:
            self._incarnation = self._negotiator.incarnation
            self._say(f"{status.robot} has started later before: its clock was set back; taking part as a new start")
        heard = {robot for robot in status.members if members.incarnation(robot) >= 0}
        for robot in self._negotiator.rules.robots:
            if robot in heard and robot not in self._there:
                self._say(f"{robot} is there")
            elif robot in self._there and robot not in heard:
                self._say(f"{robot} is silent; going on without it")
        self._there = heard
        for notice in self._negotiator.notices[self._told :]:
            if notice.kind == "refused":
                self._say(f"refused from {notice.robots[0]}: {notice.reason}")
            elif notice.kind == "revoked":
                self._say(f"going on without {notice.robots[0]} for good, as {notice.reason}")
        self._told = len(self._negotiator.notices)
        if status.settled != self._settled and status.settled:
            who = (
                f"all {len(status.members)} agree" if len(status.members) > 1 else "alone, with nothing left to bid for"
            )
            self._say(f"{who}, in round {status.round} of epoch {status.epoch}")
        self._settled = status.settled

    def say_how_it_ended(self, status: NodeStatus, took_s: float) -> None:
        volume = sum(status.sent_bytes.values()) / 1000
        refused = "".join(
            f", {count} {why.replace('_', ' ')} refused" for why, count in status.refused.items() if why != "own"
        )
        without = f" without {', '.join(status.silent)}" if status.silent else ""
        sent = f"sent {by_kind(status.sent)}, {volume:.1f} kB"
        self._say(f"agreed{without} after {took_s:.2f} s; {sent}; received {status.received}{refused}")


def _transport(problem: Problem, transport: str, options: dict[str, Any]) -> Transport:
    connect, listen, multicast = options["connect"], options["listen"], options["multicast"]
    if transport == "zenoh":
        if multicast is not None:
            raise ParameterError("--multicast given; expected it with --transport udp (Zenoh scouts by itself)")
        return _zenoh(problem.mission.name or "mission", options["robot"], connect, listen, options["wait"])
    if (connect is None) == (multicast is None):
        raise ParameterError("--connect or --multicast: expected one of them with --robot")
    from muster_team.network.udp import UdpTransport

    if multicast is not None:
        if listen is not None:
            raise ParameterError("--listen given; expected it without --multicast, which tells the port")
        return UdpTransport.multicast(_address("--multicast", multicast), robot=options["robot"])
    bind = (_ANYWHERE, _PORT) if listen is None else _address("--listen", listen)
    return UdpTransport(bind, _peers(connect, problem, options["robot"]))


def _zenoh(mission: str, robot: str, connect: str | None, listen: str | None, wait_s: float) -> Transport:
    """A Zenoh session; a robot that only connects waits for another robot."""
    from muster_team.network.zenoh_transport import ZenohTransport

    for option, text in (("--connect", connect), ("--listen", listen)):
        for endpoint in _listed(text):
            if "/" not in endpoint:
                raise ParameterError(f"{option}: {endpoint}; expected an endpoint of Zenoh, such as tcp/HOST:PORT")
    until_s = time.monotonic() + wait_s
    while True:
        try:
            return ZenohTransport(mission, robot, connect=_listed(connect), listen=_listed(listen))
        except NetworkError:
            if listen is not None or time.monotonic() > until_s:
                raise
            time.sleep(_AGAIN_S)


def _peers(text: str, problem: Problem, robot: str) -> dict[str, tuple[str, int]]:
    """The addresses of the others by robot; by address where the list names no robots, which takes more messages."""
    peers = {}
    for item in _listed(text):
        name, equals, address = item.rpartition("=")
        if equals and name not in problem.robot_index:
            raise ParameterError(f"--connect: robot {name} is not in the mission; expected ROBOT=HOST:PORT")
        if name != robot:
            peers[name or address] = _address("--connect", address)
    return peers


def _listed(text: str | None) -> list[str]:
    return [item.strip() for item in (text or "").split(",") if item.strip()]


def _address(option: str, text: str) -> tuple[str, int]:
    host, colon, port = text.rpartition(":")
    if not colon or not host or not port.isdigit() or int(port) > 65535:
        raise ParameterError(f"{option}: {text}; expected HOST:PORT")
    return host.strip("[]"), int(port)
