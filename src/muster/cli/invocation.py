"""One call of the command: when it began, and what holds of it however it ends."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from muster.cli.exit_codes import Ending


@dataclass
class Invocation:
    """One call of the command.

    Attributes
    ----------
    began_s : float or None
        Time of `SystemClock` at which the call began; None where it began with the verb.
    endings : list of Ending
        What a verb has noted for the exit code, see `note_ending`.
    """

    began_s: float | None = None
    endings: list[Ending] = field(default_factory=list)


def this_invocation() -> Invocation:
    """Return the call that is under way; a new one where the verb was not called by `muster.cli.main.run`."""
    context = click.get_current_context(silent=True)
    return (context and context.find_object(Invocation)) or Invocation()
