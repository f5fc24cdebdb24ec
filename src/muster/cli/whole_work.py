"""The time that a verb has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.cli.exit_codes import this_invocation

if TYPE_CHECKING:
    from muster.allocation.stop import Stop


def whole_work() -> Stop:
    """A stop for all the work of a verb, whose time began with the command: loading the program counts too."""
    from muster.allocation.stop import Stop

    return Stop(began_s=this_invocation().began_s)


def time_left_s(limit_s: float) -> float:
    """What is left of a time limit that counts from when the command began."""
    return max(0.0, limit_s - whole_work().elapsed_s)
