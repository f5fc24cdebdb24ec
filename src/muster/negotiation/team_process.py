"""A robot's process in a team on this machine: its place in the network, and its ears for the one that started it."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any

from muster.allocation.problem import Problem
from muster.negotiation.joining import node_of
from muster.negotiation.memory_file import kept_of
from muster.negotiation.methods import method_named
from muster.negotiation.mission_digest import mission_digest
from muster.negotiation.node import Node
from muster.negotiation.process_reports import GO, SHOW, News, Order, Ready
from muster.negotiation.robot_view import view_of
from muster.negotiation.transport import Transport

HERE = "127.0.0.1"
CLOSING_S = 1.0
"""Within so long a process ends whose starter has ended."""
_NEWS_EVERY_S = 0.1
_STEP_S = 0.05
_ZENOH_ENTRANCES = 3
"""Robots whose address the others know; they hear of the rest from these."""


class Orders:
    """What the starter wants; a thread listens to it, and ends the process soon after the starter has ended.

    Attributes
    ----------
    go, show, leave
        the robot may begin; it is to tell what it knows; it is to end.
    words
        all else that was said to it.
    """

    def __init__(self, pipe: Connection) -> None:
        self.go, self.show, self.leave = threading.Event(), threading.Event(), threading.Event()
        self.words: SimpleQueue[Any] = SimpleQueue()
        self._pipe = pipe
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        events = {GO: self.go, SHOW: self.show}
        try:
            while True:
                word = self._pipe.recv()
                if isinstance(word, str):
                    events[word].set()
                else:
                    self.words.put(word)
        except (EOFError, OSError):
            self.leave.set()
            self.go.set()  # whoever waits for it goes, and leaves
            time.sleep(CLOSING_S)
            os._exit(0)


@dataclass(frozen=True)
class Seat:
    """One process of one robot.

    Parameters
    ----------
    robot, life
        which robot, and how often it has started with this.
    order, problem
        what about; the problem is the order's, made ready.
    ports
        of this machine, by robot.
    pipe
        to the one that started it.
    """

    robot: str
    life: int
    order: Order
    problem: Problem
    ports: Mapping[str, int]
    pipe: Connection

    @property
    def comes_late(self) -> bool:
        """Whether the team does not wait for it before it begins."""
        return self.life > 1 or self.robot in self.order.late

    def node(self) -> Node:
        """The robot's part in the auction, not begun."""
        order = self.order
        file = None if order.memory is None else order.memory / f"{self.robot}.json"
        kept = kept_of(file, mission_digest(self.problem, order.terms), self.robot)
        return node_of(
            self.problem,
            order.terms,
            method_named(order.method),
            replace(kept, incarnation=self.life),
            file=file,
            key=order.key,
            transport=self._transport(),
            patience=order.patience,
            absent=order.late,
        )

    def _transport(self) -> Transport:
        here = self.ports[self.robot]
        if self.order.transport == "udp":
            from muster.negotiation.udp import UdpTransport

            others = {robot: (HERE, port) for robot, port in self.ports.items() if robot != self.robot}
            return UdpTransport((HERE, here), others)
        from muster.negotiation.zenoh_transport import ZenohTransport

        entrances = [f"tcp/{HERE}:{p}" for other, p in list(self.ports.items())[:_ZENOH_ENTRANCES] if p != here]
        name = self.problem.mission.name or "mission"
        return ZenohTransport(name, self.robot, connect=entrances, listen=(f"tcp/{HERE}:{here}",))


def hold_auction(seat: Seat) -> None:
    """Take part until the starter has heard enough."""
    orders, teller = Orders(seat.pipe), Teller(seat.pipe)
    with seat.node() as node:
        seat.pipe.send(Ready())
        orders.go.wait()
        while not orders.leave.is_set():
            node.step(_STEP_S)
            teller.tell(node, orders)


@dataclass
class Teller:
    """Tells the starter how far the robot is, now and then or when it asks."""

    pipe: Connection
    _told_s: float = 0.0

    def tell(self, node: Node, orders: Orders) -> None:
        now_s, asked = time.monotonic(), orders.show.is_set()
        if asked or now_s >= self._told_s + _NEWS_EVERY_S:
            orders.show.clear()
            self._told_s = now_s
            negotiator = node.negotiator
            self.pipe.send(News(node.status(), negotiator.stage, view_of(negotiator) if asked else None))
