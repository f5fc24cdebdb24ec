"""A request of a run in this process: with the files and functions that receive what happens."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, TypeVar

from muster.mission.errors import ParameterError
from muster.mission.records import record
from muster.mission.value_types import Fault, shown
from muster.mission.yaml_writer import YAML_SUFFIXES
from muster.running.run_request import OPEN_FLEET, RunRequest

if TYPE_CHECKING:
    import threading

    from muster.execution import ExecutionEvent, Recorder, Standing
    from muster.mission.system.clock import Clock
    from muster.running.camera_search import OnLook
    from muster.running.journal import Journal
    from muster.running.run_outputs import BegunOutput, OnWorld, WorldRecorder
    from muster.simulation import SimulatedWorld
    from muster.simulation.cameras import Look

P = ParamSpec("P")
Q = TypeVar("Q")
R = TypeVar("R")
A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")


def files_of_map(file: Path) -> tuple[Path, Path, Path]:
    """Return the files of a map that is saved: itself, its image, and in space the mission with what is in the air."""
    return file, file.with_suffix(".pgm"), file.with_suffix(".mission.yaml")


@record
class ObservedRun(RunRequest):
    """How a plan is carried out, and who receives what happens.

    Attributes
    ----------
    standing : Standing, optional
        A fleet that stays on duty, instead of `stay`, `until_s` and `orders`.
    record : str or Path, optional
        A file (.mcap) for the record of the run; needs the extra `record`.
    film : str, Path or WorldRecorder, optional
        A file (.mp4, .gif) for a film of the run, in the physics world; or a `Footage` of the mission, of which films
        and stills can be made afterwards.
    save_map : str or Path, optional
        A file (.yaml) for the map that robots without one have built, in the form of ROS, its image (.pgm) beside it.
    observers : sequence of Recorder
        Receive every event and state, such as `muster.report.live.FoxgloveServer`.
    on_event : callable, optional
        Is called with each event, as it happens.
    on_look : callable, optional
        Is called with each look of a camera; cameras are used where the mission has tags.
    on_world : callable, optional
        Is called with the simulated world when it is made, to read the states of bodies.
    halt : threading.Event, optional
        When it is set, the run ends; robots stay where they are.
    wall : Clock, optional
        The wall clock, by which the clock of real robots goes; by default the machine's.
    journal : Journal, optional
        What happens and what is ordered, synced to disk before robots get orders (`muster.running.journal`). A run
        whose journal holds one that was interrupted goes on with that.
    """

    standing: Standing | None = None
    record: str | Path | None = None
    film: str | Path | WorldRecorder | None = None
    save_map: str | Path | None = None
    observers: Sequence[Recorder] = ()
    on_event: Callable[[ExecutionEvent], None] | None = None
    on_look: OnLook | None = None
    on_world: OnWorld | None = None
    halt: threading.Event | None = None
    wall: Clock | None = None
    journal: Journal | None = None

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        """See `RunRequest`."""
        yield from super().cross_check(values)
        if values["save_map"] is not None and not values["unknown"]:
            yield Fault(("save_map",), shown(str(values["save_map"])), "it together with unknown")
        elif values["save_map"] is not None and Path(values["save_map"]).suffix not in YAML_SUFFIXES:
            yield Fault(("save_map",), shown(str(values["save_map"])), f"a file ({' or '.join(YAML_SUFFIXES)})")

    def require_place_of_map(self) -> None:
        """Raise `ParameterError` if the folder of the map that is to be saved does not exist."""
        if self.save_map is not None and not (folder := Path(self.save_map).parent).is_dir():
            raise ParameterError(f"save_map: {self.save_map}; expected a file in a folder that exists, not in {folder}")

    @property
    def duty(self) -> Standing | None:
        """See `RunRequest`."""
        own = super().duty
        if own is not None and self.standing is not None:
            raise ParameterError("standing: given with stay or orders; expected one of them")
        return own if self.standing is None else self.standing

    def observed_by(self, outputs: Sequence[BegunOutput]) -> ObservedRun:
        """Return the same run, which outputs observe, too."""
        worlds = [one for one in (self.on_world, *(output.on_world for output in outputs)) if one is not None]
        looks = [one for one in (self.on_look, *(output.on_look for output in outputs)) if one is not None]

        def on_world(world: SimulatedWorld) -> None:
            for receive in worlds:
                receive(world)

        def on_look(look: Look) -> None:
            for receive in looks:
                receive(look)

        return replace(
            self,
            observers=(*self.observers, *(observer for output in outputs for observer in output.observers)),
            on_world=on_world if worlds else None,
            on_look=on_look if looks else None,
        )


class KeywordsOf(Generic[P, Q]):
    """Gives functions of a request its fields as keyword arguments, for users and type checkers alike.

    Parameters
    ----------
    make : type
        The class of the request.
    """

    def __init__(self, make: Callable[P, Q]) -> None:
        self._make = make

    def in_world(self, function: Callable[[A, B, Q], R]) -> Callable[Concatenate[A, B, P], R]:
        """Return a function of a mission and a plan, with the fields of the request as keywords."""
        return self._with_keywords(function)

    def with_fleet(self, function: Callable[[A, B, C, Q], R]) -> Callable[Concatenate[A, B, C, P], R]:
        """Return a function of a mission, a plan and a fleet or its name, with the other fields as keywords."""
        return self._with_keywords(function)

    def _with_keywords(self, function: Callable[..., Any]) -> Callable[..., Any]:
        signature = inspect.signature(function)
        *leading, _ = signature.parameters.values()
        names = [parameter.name for parameter in leading]

        @wraps(function)
        def with_keywords(*given: Any, **how: Any) -> Any:
            named = dict(zip(names, given, strict=False)) | {name: how.pop(name) for name in names if name in how}
            if "fleet" in named:
                how["world"] = named["fleet"] if isinstance(named["fleet"], str) else OPEN_FLEET
            return function(**named, request=self._make(**how))  # type: ignore[call-arg]

        keywords = list(inspect.signature(self._make).parameters.values())
        with_keywords.__signature__ = signature.replace(parameters=[*leading, *keywords])  # type: ignore[attr-defined]
        return with_keywords


keywords_of_run = KeywordsOf(ObservedRun)
