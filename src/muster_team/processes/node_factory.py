"""Puts a robot's node together: its negotiator, codec, seal, transport and memory file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from muster.model.problem import Problem
from muster_team.negotiators.methods import Method
from muster_team.network.codec import Codec
from muster_team.network.encryption import Seal
from muster_team.network.transport import Transport
from muster_team.processes.memory_file import Kept, keeper
from muster_team.processes.node import Node


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
    """The node of a robot, not started.

    Parameters
    ----------
    kept
        the robot, the auction, the incarnation, and what the robot remembers.
    file
        where the robot stores its memory; None: nowhere.
    key
        the team's key.
    how
        further arguments of `participation.negotiator_of`.
    """
    negotiator = method.negotiator(
        problem, params, kept.robot, incarnation=kept.incarnation, remembered=kept.memory, **how
    )
    codec = Codec([robot.id for robot in problem.robots], [task.id for task in problem.tasks])
    context = bytes.fromhex(kept.auction) + negotiator.signatures.team
    node = Node(negotiator, transport, codec, Seal(key, context, kept.robot, kept.incarnation))
    if file is not None:
        node.keep = keeper(file, kept, negotiator)
    return node
