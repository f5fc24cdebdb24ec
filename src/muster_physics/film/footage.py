"""Records a physics world for films: the poses of all bodies at each step, and the events.

Footage is a recorder that also receives the world. Pictures are drawn afterwards: then the length of the run is known,
and robots that communicate in real time need not wait for them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.grid import Floats
from muster.state import ExecutionEvent, event_of


class Footage:
    """A recorder (`execution.Recorder`) that also receives the world (`on_world`).

    Parameters
    ----------
    mission
        the mission that is carried out.
    """

    def __init__(self, mission: Mission) -> None:
        self.mission = mission
        self.events: list[ExecutionEvent] = []
        self.report: Mapping[str, Any] | None = None
        self._world: Any = None
        self._times: list[float] = []
        self._poses: list[Floats] = []

    def on_world(self, world: object) -> None:
        """Film this world.

        Raises
        ------
        ParameterError
            if it is not a physics world: in others there is nothing to see.
        RenderingError
            if nothing draws here.
        """
        from muster_physics import PhysicsWorld
        from muster_physics.rendering import Renderer

        if not isinstance(world, PhysicsWorld):
            raise ParameterError(f"film: {type(world).__name__}; expected the physics world, in which there are bodies")
        with Renderer(world, 16, 16):
            self._world = world
        self._keep(world.time_s)

    def on_step(self, now: float, positions: Floats, headings: Floats, velocities: Floats) -> None:
        """Record the poses of the bodies. The first step comes before `on_world`, and is recorded there."""
        if self._world is not None:
            self._keep(now)

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """Record an event."""
        self.events.append(event_of(now, kind, data))

    def on_telemetry(self, now: float, robot: str, telemetry: object) -> None:
        """Telemetry is not visible in a film."""

    def on_plan(self, now: float, plan: Plan) -> None:
        """Plans are not visible in a film."""

    def on_report(self, report: Mapping[str, Any]) -> None:
        """Record the end of the mission."""
        self.report = report

    @property
    def world(self) -> Any:
        """The `PhysicsWorld`.

        Raises
        ------
        ParameterError
            if there was none.
        """
        if self._world is None:
            raise ParameterError("film: no world was carried out in; expected one")
        return self._world

    @property
    def times_s(self) -> Floats:
        """The times of the recorded poses: (m,) seconds of the mission's clock, growing."""
        return np.array(self._times)

    @property
    def poses(self) -> Floats:
        """Poses of the bodies' frames, metres, and quaternions, w first: (m, n, 7); NaN for absent bodies."""
        count = max(map(len, self._poses))
        poses = np.full((len(self._poses), count, 7), np.nan)
        for moment, rows in zip(poses, self._poses, strict=True):
            moment[: len(rows)] = rows
        return poses

    def _keep(self, now: float) -> None:
        if self._times and now <= self._times[-1]:
            return
        simulated = self._world.simulated
        self._times.append(float(now))
        self._poses.append(
            np.column_stack([simulated.data.xpos[simulated.bodies], simulated.data.xquat[simulated.bodies]])
        )
