"""A compiled model with its state: where robots are and how they move, and what drives them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from muster.motion.grid import Floats
from muster.simulation.physics.bodies import Build
from muster.simulation.physics.model import Standing, mjcf


@dataclass(frozen=True)
class Motion:
    """How some robots are and move at one moment, in the map frame.

    Parameters
    ----------
    frames, axes
        of the bodies: (n, 3) metres, and their axes as the columns of (n, 3, 3).
    velocities, rates
        of the frames: (n, 3) m/s, and of turning (n, 3) rad/s.
    """

    frames: Floats
    axes: Floats
    velocities: Floats
    rates: Floats

    def of(self, who: npt.NDArray[np.intp]) -> Motion:
        return Motion(self.frames[who], self.axes[who], self.velocities[who], self.rates[who])

    @property
    def headings(self) -> Floats:
        """Radians (n,): where they look."""
        return np.asarray(np.arctan2(self.axes[:, 1, 0], self.axes[:, 0, 0]))


class Stage:
    """MuJoCo's model and data of some robots.

    Parameters
    ----------
    robots, walls, ground_m, step_s
        as `mjcf` takes them.
    """

    def __init__(self, robots: Sequence[Standing], walls: Sequence[Floats], ground_m: float, step_s: float) -> None:
        self.robots = tuple(robots)
        self.model: Any = mujoco.MjModel.from_xml_string(mjcf(robots, walls, ground_m, step_s))
        self.data: Any = mujoco.MjData(self.model)
        model, numbers = self.model, range(len(self.robots))
        self.bodies = np.array([model.body(f"robot{k}").id for k in numbers], dtype=np.intp)
        places = np.array([model.joint(f"free{k}").qposadr[0] for k in numbers], dtype=np.intp)
        freedoms = np.array([model.joint(f"free{k}").dofadr[0] for k in numbers], dtype=np.intp)
        self._places = places[:, None] + np.arange(7)
        self._freedoms = freedoms[:, None] + np.arange(6)
        self._wheels = [_wheels(model, k) for k in numbers]
        self.motors = np.array(
            [[model.actuator(f"{side}{k}").id for side in ("left", "right")] for k in numbers if self._wheels[k]],
            dtype=np.intp,
        ).reshape(-1, 2)

    def motion(self) -> Motion:
        """As it is now."""
        places, speeds = self.data.qpos[self._places], self.data.qvel[self._freedoms]
        axes = _axes(places[:, 3:])
        return Motion(places[:, :3], axes, speeds[:, :3], np.einsum("nij,nj->ni", axes, speeds[:, 3:]))

    def go_on(self) -> None:
        """One step of physics under `data.ctrl` and `data.xfrc_applied`."""
        mujoco.mj_step(self.model, self.data)

    def take_over(self, before: Stage) -> None:
        """Robots that stood on a stage before, which are the first of this one, go on as they were."""
        for k in range(len(before.robots)):
            self.data.qpos[self._places[k]] = before.data.qpos[before._places[k]]
            self.data.qvel[self._freedoms[k]] = before.data.qvel[before._freedoms[k]]
            for (place, freedom), (old_place, old_freedom) in zip(self._wheels[k], before._wheels[k], strict=True):
                self.data.qpos[place] = before.data.qpos[old_place]
                self.data.qvel[freedom] = before.data.qvel[old_freedom]
        self.data.time = before.data.time

    def having(self, *builds: Build) -> npt.NDArray[np.intp]:
        """The numbers of the robots that are so built."""
        return np.array([k for k, robot in enumerate(self.robots) if robot.body.build in builds], dtype=np.intp)


def _wheels(model: Any, robot: int) -> list[tuple[int, int]]:
    """Where the angles and the speeds of its wheels are."""
    joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"{side}{robot}") for side in ("left", "right")]
    return [(model.jnt_qposadr[joint], model.jnt_dofadr[joint]) for joint in joints if joint >= 0]


def _axes(quaternions: Floats) -> Floats:
    """Turning matrices (n, 3, 3) of unit quaternions (n, 4), w first."""
    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
