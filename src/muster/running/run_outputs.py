"""Files of simulated runs that only some worlds can fill, such as films: an entry point group, and its interface.

An output brings its options of `muster simulate`, checks them before anything is read, receives what happens in the
run, and writes its files afterwards.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from muster.execution.record import Recorder
from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.running.camera_search import OnLook
    from muster.simulation import SimulatedWorld

OnWorld = Callable[["SimulatedWorld"], None]
"""Receives the world when it is made."""
Say = Callable[[str], None]
"""Receives a line for people."""


class WorldRecorder(Recorder, Protocol):
    """A recorder that receives the world, too, such as the footage of films."""

    def on_world(self, world: object) -> None:
        """The run begins in this world."""
        ...


@dataclass(frozen=True, kw_only=True)
class BegunOutput:
    """An output of a run that is about to begin.

    Parameters
    ----------
    observers : sequence of Recorder
        Receive every event and state.
    on_world, on_look : callable, optional
        As in `ObservedRun`.
    write : callable
        Writes the files when the run has ended, and says so.
    """

    observers: Sequence[Recorder] = ()
    on_world: OnWorld | None = None
    on_look: OnLook | None = None
    write: Callable[[Say], None] = lambda say: None


class RunOutput(Protocol):
    """Files of runs, with the options of `muster simulate` that ask for them."""

    @property
    def options(self) -> Mapping[str, Callable[[Any], Any]]:
        """By the names of the verb's parameters what adds their options (`click.option`), in the order of the help."""
        ...

    @property
    def files(self) -> Sequence[str]:
        """The parameters that name files that are written."""
        ...

    @property
    def not_at_server(self) -> str:
        """Why a server does not write them, for the message that refuses the options beside `--server`."""
        ...

    def require_possible(self, world: str, given: Mapping[str, Any]) -> None:
        """Raise `MusterError`, before anything is read, if the options do not go together, or with the world."""
        ...

    def begin(self, mission: Mission, world: str, given: Mapping[str, Any]) -> BegunOutput | None:
        """Return what receives the run; None where no file is asked for. An option that is not given may be missing.

        Raises
        ------
        MusterError
            if there is nothing of it in the mission, or a file cannot be written.
        """
        ...


_MEMBERS = ("options", "files", "not_at_server", "require_possible", "begin")


def _checked(name: str, found: object) -> RunOutput:
    missing = [
        word for word in ("options", "files", "not_at_server", "require_possible", "begin") if not hasattr(found, word)
    ]
    if missing:
        raise ParameterError(f"no {missing[0]}; expected what muster.running.run_outputs.RunOutput describes")
    return found  # type: ignore[return-value]


RUN_OUTPUTS: Registry[RunOutput] = Registry("output of runs", "muster.run_outputs", _checked)
