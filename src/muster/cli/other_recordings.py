"""What installed packages add to `muster replay`: recordings of other systems, such as ROS.

An implementation is a module, or an object with the same functions, in the entry point group `muster.recordings`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

from muster.cli.options import Verb
from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry

if TYPE_CHECKING:
    from muster.report.record import Recording


class OtherRecordings(Protocol):
    """Recordings of another system. `given` holds the values of the options of `muster replay` by their names."""

    def add_options(self, verb: Verb) -> Verb:
        """Add options to the verb."""
        ...

    def outputs(self, given: Mapping[str, Any]) -> Sequence[Path | None]:
        """Return the files that the options write."""
        ...

    def inputs(self, given: Mapping[str, Any]) -> Sequence[Path | None]:
        """Return the files that the options read."""
        ...

    def require_consistent(self, record: Path, given: Mapping[str, Any]) -> None:
        """Raise `ParameterError` if options exclude each other; it is called before anything is written."""
        ...

    def is_recording(self, file: Path) -> bool:
        """Return whether a file is a recording of the other system, and no record of Muster."""
        ...

    def show(self, file: Path, plot: Path | None, form: str, *, quiet: bool) -> int:
        """Print and draw a recording of the other system; return the exit code."""
        ...

    def answer(self, recording: Recording, given: Mapping[str, Any], *, quiet: bool) -> Mapping[str, Any]:
        """Write and compare what the options ask for; return the keys that this adds to the answer in JSON."""
        ...

    def print_answer(self, answer: Mapping[str, Any]) -> None:
        """Print what `answer` has returned as tables."""
        ...


def _checked(_: str, found: object) -> OtherRecordings:
    missing = [name for name in vars(OtherRecordings) if not name.startswith("_") and not hasattr(found, name)]
    if missing:
        raise ParameterError(f"it has no {missing[0]}; expected a module with the functions of OtherRecordings")
    return cast("OtherRecordings", found)


OTHER_RECORDINGS: Registry[OtherRecordings] = Registry("recordings", "muster.recordings", _checked)
