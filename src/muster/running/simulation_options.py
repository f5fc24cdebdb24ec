"""How a mission is simulated: the keyword arguments that are passed on, for type checkers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from muster.execution import ExecutionEvent, Recorder, Standing
    from muster.planning.options import PlanningOptions
    from muster.running.camera_search import OnLook
    from muster.running.localisation import Localise
    from muster.simulation import Noise, SimulatedWorld, Wind


class WorldOptions(TypedDict, total=False):
    """How the world is, and how robots localise themselves; all as `Simulation` takes it."""

    world: str
    dt_s: float
    avoidance: str
    traffic: str
    law: str
    noise: Noise
    wind: Wind
    batteries: Mapping[str, float]
    drain: Mapping[str, float]
    rotor_level: bool
    pose: str | None
    localise: Localise | None
    ignore: str | Collection[str]
    on_look: OnLook | None
    on_world: Callable[[SimulatedWorld], None] | None


class RecordedWorldOptions(WorldOptions, total=False):
    """As `WorldOptions`; and the seed, options of planning anew, a fleet on duty, and the recorder of what happens."""

    seed: int
    planning: PlanningOptions | None
    standing: Standing | None
    recorder: Recorder | None


class SimulationOptions(WorldOptions, total=False):
    """Options of the world, of planning anew, of a fleet on duty, and of its clock: `speed`, `on_event` and `halt`."""

    planning: PlanningOptions | None
    standing: Standing | None
    speed: float | None
    on_event: Callable[[ExecutionEvent], None] | None
    halt: threading.Event | None
