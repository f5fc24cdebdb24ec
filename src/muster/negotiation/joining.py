"""What a robot's process needs to take part, put together: its negotiator, its codec and seal, its memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from muster.allocation.problem import Problem
from muster.negotiation.codec import Codec
from muster.negotiation.encryption import Seal
from muster.negotiation.memory_file import Kept, keeper
from muster.negotiation.methods import Method
from muster.negotiation.node import Node
from muster.negotiation.transport import Transport


def node_of(
    problem: Problem,
    params: Any,
    method: Method,
    kept: Kept,
    *,
    file: Path | None,
    key: bytes,
    transport: Transport,
    **how: Any,
) -> Node:
    """A robot's part, not begun.

    Parameters
    ----------
    kept
        which robot, in which auction, with which incarnation, and what it remembers.
    file
        where it keeps what it knows; None: nowhere.
    key
        of the team.
    how
        as `taking_part.negotiator_of` takes the rest.
    """
    negotiator = method.negotiator(
        problem, params, kept.robot, incarnation=kept.incarnation, remembered=kept.memory, **how
    )
    codec = Codec([robot.id for robot in problem.robots], [task.id for task in problem.tasks])
    node = Node(negotiator, transport, codec, Seal(key, bytes.fromhex(kept.auction), kept.robot, kept.incarnation))
    if file is not None:
        node.keep = keeper(file, kept, negotiator)
    return node
