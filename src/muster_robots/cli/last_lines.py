"""The last lines of the verbs for real robots: where each robot is, and which are armed or move."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import click

from muster.cli.exit_codes import Ending, note_ending
from muster.mission.errors import MusterError

if TYPE_CHECKING:
    from muster.execution.final_state import FinalState


def show_final_states(states: Sequence[FinalState], *, asks: bool) -> None:
    """Print a line for each robot; it concerns safety, so `--quiet` does not silence it.

    Where the mission did not end as planned (`asks`), a line before them says what to do with robots that still move.
    """
    if asks and (moving := [state.robot for state in states if state.moving]):
        todo = "land or stop them by their own controls or a ground station, and disarm them, or give --recover"
        click.echo(f"still flying, driving or armed: {', '.join(moving)}; {todo}", err=True)
    for state in states:
        click.echo(str(state), err=True)


class LastLines:
    """Context manager that prints where robots are if an exception ends it: a refusal, an error, Ctrl-C, a signal.

    Before robots were commanded, only those are printed that fly, drive or are armed all the same; afterwards all. The
    exit code of the command is 4 if any does.

    Attributes
    ----------
    begun : bool
        Whether robots were commanded.
    """

    def __init__(self, final_states: Callable[[], Sequence[FinalState]], *, begun: bool = False) -> None:
        self._final_states, self.begun = final_states, begun

    def __enter__(self) -> LastLines:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> None:
        if kind is not None:
            self.tell()

    def tell(self) -> None:
        """Print where robots are, and note for the exit code whether any moves."""
        try:
            states = self._final_states()
        except MusterError as unknown:
            click.echo(f"warning: where robots are is not known: {unknown}", err=True)
            return
        moving = [state for state in states if state.moving]
        show_final_states(states if self.begun else moving, asks=True)
        if moving:
            note_ending(Ending.STILL_MOVING)
