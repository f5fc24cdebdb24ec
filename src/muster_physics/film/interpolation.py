"""A run at any moment: interpolated poses of bodies, and the state of tasks and robots."""

from __future__ import annotations

import numpy as np

from muster.motion.grid import Floats
from muster.state import ExecutionEvent, MissionState
from muster.state.robots import OUT
from muster_physics.film.footage import Footage


class RunInterpolation:
    """Steps through a run, forwards only.

    Parameters
    ----------
    footage
        of the run.
    """

    def __init__(self, footage: Footage) -> None:
        self.times_s, self.poses = footage.times_s, footage.poses
        self.mission_state = MissionState(footage.mission, forgets=False)
        self.busy_with: dict[str, str] = {}
        """Tasks that are under way or done, and who does or did them."""
        self.out: set[str] = set()
        """Robots that take no part."""
        self.told: list[ExecutionEvent] = []
        self._ahead = list(footage.events)

    @property
    def end_s(self) -> float:
        return float(self.times_s[-1])

    def go_on(self, now: float) -> None:
        """Apply all events until a moment."""
        while self._ahead and self._ahead[0].time_s <= now + 1e-9:
            told = self._ahead.pop(0)
            self._take(told)
            self.told.append(told)

    def at(self, now: float) -> Floats:
        """Poses (n, 7) at a moment: positions interpolated linearly, orientations by the shortest rotation."""
        after = int(np.clip(np.searchsorted(self.times_s, now), 1, max(1, len(self.times_s) - 1)))
        if len(self.times_s) == 1:
            only: Floats = self.poses[0]
            return only
        begin, end = self.times_s[after - 1], self.times_s[after]
        share = float(np.clip((now - begin) / (end - begin), 0.0, 1.0))
        first, last = self.poses[after - 1], self.poses[after].copy()
        opposite = (first[:, 3:] * last[:, 3:]).sum(axis=1) < 0
        last[opposite, 3:] *= -1
        poses: Floats = (1 - share) * first + share * last
        poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
        return poses

    def _take(self, told: ExecutionEvent) -> None:
        task, robot = told.data.get("task"), told.data.get("robot")
        self.mission_state.apply(told)
        if told.kind in ("starts", "ends"):
            self.busy_with[str(task)] = str(robot)
        elif told.kind in OUT:
            self.out.add(str(robot))
        elif told.kind == "robot_returns":
            self.out.discard(str(robot))
