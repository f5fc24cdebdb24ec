"""One robot's process in a team on this machine: its node, and its connection to the starter."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any

from muster.model.problem import Problem
from muster_team.negotiators.methods import method_named
from muster_team.negotiators.robot_view import view_of
from muster_team.network.mission_digest import mission_digest
from muster_team.network.transport import Transport
from muster_team.processes.memory_file import kept_of
from muster_team.processes.node import Node
from muster_team.processes.node_factory import node_of
from muster_team.processes.process_reports import GO, SHOW, Progress, Ready, TeamSetup

HERE = "127.0.0.1"
CLOSING_S = 1.0
"""The time within which a process ends after its starter has ended, seconds."""
_REPORT_EVERY_S = 0.1
_STEP_S = 0.05
_ZENOH_ENTRANCES = 3
"""The number of robots whose address the others know; they learn of the rest from these."""


class StarterCommands:
    """Commands of the starter. A thread listens to them, and ends the process soon after the starter has ended.

    Attributes
    ----------
    go, show, leave
        the robot may begin; it is to send its view; it is to end.
    messages
        everything else that was sent to it.
    """

    def __init__(self, pipe: Connection) -> None:
        self.go, self.show, self.leave = threading.Event(), threading.Event(), threading.Event()
        self.messages: SimpleQueue[Any] = SimpleQueue()
        self._pipe = pipe
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        events = {GO: self.go, SHOW: self.show}
        try:
            while True:
                message = self._pipe.recv()
                if isinstance(message, str):
                    events[message].set()
                else:
                    self.messages.put(message)
        except (EOFError, OSError):
            self.leave.set()
            self.go.set()  # whoever waits for it goes, and leaves
            time.sleep(CLOSING_S)
            os._exit(0)


@dataclass(frozen=True)
class ProcessContext:
    """One process of one robot.

    Parameters
    ----------
    robot, start_number
        the robot, and the number of this start.
    setup, problem
        the team's setup; the problem is the setup's, made ready.
    ports
        the port of each robot on this machine.
    pipe
        to the starter.
    """

    robot: str
    start_number: int
    setup: TeamSetup
    problem: Problem
    ports: Mapping[str, int]
    pipe: Connection

    @property
    def comes_late(self) -> bool:
        """Whether the team begins without waiting for this process."""
        return self.start_number > 1 or self.robot in self.setup.late

    def node(self) -> Node:
        """The robot's node, not started."""
        setup = self.setup
        file = None if setup.memory is None else setup.memory / f"{self.robot}.json"
        kept = kept_of(file, mission_digest(self.problem, setup.terms), self.robot)
        return node_of(
            self.problem,
            setup.terms,
            method_named(setup.method),
            replace(kept, incarnation=self.start_number),
            file=file,
            key=setup.key,
            transport=self._transport(),
            timeouts=setup.timeouts,
            absent=setup.late,
        )

    def _transport(self) -> Transport:
        here = self.ports[self.robot]
        if self.setup.transport == "udp":
            from muster_team.network.udp import UdpTransport

            others = {robot: (HERE, port) for robot, port in self.ports.items() if robot != self.robot}
            return UdpTransport((HERE, here), others)
        from muster_team.network.zenoh_transport import ZenohTransport

        entrances = [f"tcp/{HERE}:{p}" for other, p in list(self.ports.items())[:_ZENOH_ENTRANCES] if p != here]
        name = self.problem.mission.name or "mission"
        return ZenohTransport(name, self.robot, connect=entrances, listen=(f"tcp/{HERE}:{here}",))


def run_auction(context: ProcessContext) -> None:
    """Take part until the starter has ended."""
    commands, reporter = StarterCommands(context.pipe), ProgressReporter(context.pipe)
    with context.node() as node:
        context.pipe.send(Ready())
        commands.go.wait()
        while not commands.leave.is_set():
            node.step(_STEP_S)
            reporter.report(node, commands)


@dataclass
class ProgressReporter:
    """Reports the robot's progress to the starter, regularly or when asked."""

    pipe: Connection
    _reported_s: float = 0.0

    def report(self, node: Node, commands: StarterCommands) -> None:
        now_s, asked = time.monotonic(), commands.show.is_set()
        if asked or now_s >= self._reported_s + _REPORT_EVERY_S:
            commands.show.clear()
            self._reported_s = now_s
            negotiator = node.negotiator
            self.pipe.send(Progress(node.status(), negotiator.stage, view_of(negotiator) if asked else None))
