"""A registered fleet that is open for one run of this process: its robots are claimed before, and given back after."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager

from muster.mission.model import Mission
from muster.running.claim_locks import robots_claimed
from muster.running.fleet_registry import fleet_ready
from muster.running.fleet_type import Opened
from muster.running.robot_claims import claims_of_request
from muster.running.run_request import RunRequest


@contextmanager
def claimed_fleet(
    mission: Mission, request: RunRequest, halt: threading.Event, *, again: bool = False
) -> Iterator[Opened]:
    """Hold the claims of a request's fleet, and its robots, while the block runs.

    Parameters
    ----------
    again : bool
        Whether the mission is under way already; see `fleet_ready`.

    Raises
    ------
    MusterError
        if another run on this machine commands its robots; as `fleet_ready`.
    """
    with robots_claimed(claims_of_request(request)):
        fleet, at_end = fleet_ready(request.world, mission, request.settings, halt, again=again)
        with closing(fleet):
            yield fleet, at_end
