"""The options of outputs that packages bring for simulated runs; see `muster.running.run_outputs`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, cast

from muster.cli.options.common import Verb, grouped
from muster.mission.model import Mission
from muster.running.run_outputs import RUN_OUTPUTS, BegunOutput, RunOutput


@dataclass(frozen=True)
class AskedOutputs:
    """What is given for each output, by its parameters."""

    given: tuple[tuple[RunOutput, Mapping[str, Any]], ...]

    @property
    def files(self) -> Iterator[Path | None]:
        """The files that are written."""
        return (given[name] for output, given in self.given for name in output.files)

    def require_possible(self, world: str) -> None:
        """See `RunOutput`."""
        for output, given in self.given:
            output.require_possible(world, given)

    def begin(self, mission: Mission, world: str) -> list[BegunOutput]:
        """Return what receives the run."""
        begun = [output.begin(mission, world, given) for output, given in self.given]
        return [one for one in begun if one is not None]


def run_output_options(verb: Verb) -> Verb:
    """Add the options of all outputs; the verb gets what is given as `outputs`."""
    outputs = tuple(RUN_OUTPUTS.usable().values())

    @wraps(verb)
    def with_outputs(**given: Any) -> Any:
        asked = tuple((output, {name: given.pop(name) for name in output.options}) for output in outputs)
        return verb(outputs=AskedOutputs(asked), **given)

    options = [option for output in outputs for option in output.options.values()]
    return cast("Verb", grouped(*options)(with_outputs))


def not_at_server() -> dict[str, str]:
    """By parameter why a server does not write what an output asks for."""
    return {name: output.not_at_server for output in RUN_OUTPUTS.usable().values() for name in output.options}
