"""A compiled MuJoCo model with its state: poses and velocities of robots, and their actuators."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Floats
from muster_physics.airframes import MOST_ROTORS
from muster_physics.bodies import BodyKind
from muster_physics.library import mujoco
from muster_physics.model import PlacedRobot, mjcf
from muster_physics.rotors import RotorState
from muster_physics.scenery import Scenery

Indices = npt.NDArray[np.intp]


@dataclass(frozen=True)
class Motion:
    """Poses and velocities of some robots at one moment, in the map frame.

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

    @property
    def poses(self) -> Floats:
        """Frames, and headings in radians: (n, 4)."""
        poses = np.empty((len(self.frames), 4))
        poses[:, :3] = self.frames
        poses[:, 3] = np.arctan2(self.axes[:, 1, 0], self.axes[:, 0, 0])
        return poses


class Group:
    """Some robots of a model, by their numbers."""

    def __init__(self, simulated: SimulatedModel, who: Indices) -> None:
        self.who = who
        self.bodies = simulated.bodies[who]
        self.robots = tuple(simulated.robots[k].body for k in who)
        self.data = simulated.data
        self._places = simulated.places[who][:, :3]
        self._freedoms = simulated.freedoms[who]

    def motion(self) -> Motion:
        """The motion at this moment."""
        axes = self.data.xmat[self.bodies].reshape(-1, 3, 3)
        speeds = self.data.qvel[self._freedoms]
        return Motion(self.data.qpos[self._places], axes, speeds[:, :3], (axes @ speeds[:, 3:, None])[:, :, 0])


class SimulatedModel:
    """MuJoCo's model and data of some robots.

    Parameters
    ----------
    robots, walls, step_s
        as `mjcf` takes them.
    scenery
        visible objects, and the height of the ground.
    """

    def __init__(
        self,
        robots: Sequence[PlacedRobot],
        walls: Sequence[Floats],
        scenery: Scenery,
        step_s: float,
    ) -> None:
        self.robots = tuple(robots)
        self.step_s = step_s
        text = mjcf(robots, walls, scenery.add, scenery.ground_m, step_s)
        self.model: Any = mujoco.MjModel.from_xml_string(text, scenery.files)
        self.data: Any = mujoco.MjData(self.model)
        model, numbers = self.model, range(len(self.robots))
        self.bodies: Indices = np.array([model.body(f"robot{k}").id for k in numbers], dtype=np.intp)
        places = np.array([model.joint(f"free{k}").qposadr[0] for k in numbers], dtype=np.intp)
        freedoms = np.array([model.joint(f"free{k}").dofadr[0] for k in numbers], dtype=np.intp)
        self.places: Indices = places[:, None] + np.arange(7)
        self.freedoms: Indices = freedoms[:, None] + np.arange(6)
        self._wheels = [_wheels(model, k) for k in numbers]
        bodies = [robot.body for robot in self.robots]
        self.rotors = RotorState.hovering(
            [one.rotorcraft if one.kind is BodyKind.ROTORCRAFT else None for one in bodies]
        )
        self.energy_j: Floats = np.zeros(len(self.robots))
        """Work that motors have done so far, by robot, joules."""
        self._set_published_inertias()
        mujoco.mj_step1(self.model, self.data)

    def go_on(self) -> None:
        """One step of physics under `data.ctrl` and `data.xfrc_applied`; places and axes are of its end."""
        mujoco.mj_step2(self.model, self.data)
        mujoco.mj_step1(self.model, self.data)

    def take_over(self, before: SimulatedModel) -> None:
        """Take over the state of the robots of an earlier model, which are the first of this one."""
        self.resume(before.snapshot())
        self.energy_j[: len(before.robots)] = before.energy_j
        self.data.time = before.data.time

    def snapshot(self) -> list[dict[str, list[float]]]:
        """Return how each robot stands and moves, its wheels and rotors too; what motors have done is not in it."""
        data, rotors = self.data, self.rotors
        return [
            {
                "pose": data.qpos[self.places[k]].tolist(),
                "rates": data.qvel[self.freedoms[k]].tolist(),
                "wheels": [float(value) for p, f in self._wheels[k] for value in (data.qpos[p], data.qvel[f])],
                "rotors": [*rotors.speeds[k].tolist(), *rotors.disturbances[k].tolist(), *rotors.wind[k].tolist()],
            }
            for k in range(len(self.robots))
        ]

    def resume(self, snapshot: Sequence[Mapping[str, Sequence[float]]]) -> None:
        """Let the first robots stand and move as those of a snapshot did."""
        for k, row in enumerate(snapshot):
            self.data.qpos[self.places[k]], self.data.qvel[self.freedoms[k]] = row["pose"], row["rates"]
            for number, (place, freedom) in enumerate(self._wheels[k]):
                self.data.qpos[place], self.data.qvel[freedom] = row["wheels"][2 * number : 2 * number + 2]
            self.rotors.speeds[k], self.rotors.disturbances[k], self.rotors.wind[k] = np.split(
                np.asarray(row["rotors"]), [MOST_ROTORS, MOST_ROTORS + 6]
            )
        mujoco.mj_step1(self.model, self.data)

    def put(self, robot: int, position: tuple[float, float, float], heading: float) -> None:
        """Let a robot stand still at a place, metres, with a heading, radians."""
        self.data.qpos[self.places[robot]] = [*position, math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)]
        self.data.qvel[self.freedoms[robot]] = 0.0
        for _, freedom in self._wheels[robot]:
            self.data.qvel[freedom] = 0.0
        mujoco.mj_step1(self.model, self.data)

    def _set_published_inertias(self) -> None:
        """Set the inertia of rotorcraft. The compiler refuses that of [furrer2016]: about z it is above x plus y."""
        for number, robot in zip(self.bodies, self.robots, strict=True):
            if robot.body.kind is BodyKind.ROTORCRAFT:
                self.model.body_inertia[number] = robot.body.inertia_kgm2
        mujoco.mj_setConst(self.model, self.data)

    def group(self, kind: BodyKind) -> Group:
        """The robots with this kind of body."""
        return Group(self, np.array([k for k, one in enumerate(self.robots) if one.body.kind is kind], dtype=np.intp))

    def motors(self, who: Indices) -> Indices:
        """Indices (k, 2) in `data.ctrl` of the left and right motors of robots on wheels."""
        motors = [[self.model.actuator(f"{side}{k}").id for side in ("left", "right")] for k in who]
        return np.array(motors, dtype=np.intp).reshape(-1, 2)

    def wheels(self, who: Indices) -> Indices:
        """Indices (k, 2) in `data.qpos` of the left and right wheel angles of robots on wheels."""
        places = [[place for place, _ in self._wheels[k]] for k in who]
        return np.array(places, dtype=np.intp).reshape(-1, 2)

    def wheel_speeds(self, who: Indices) -> Indices:
        """The same in `data.qvel` of the speeds at which they turn."""
        freedoms = [[freedom for _, freedom in self._wheels[k]] for k in who]
        return np.array(freedoms, dtype=np.intp).reshape(-1, 2)


def _wheels(model: Any, robot: int) -> list[tuple[int, int]]:
    """Indices of the angle and of the speed of each wheel of a robot."""
    joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"{side}{robot}") for side in ("left", "right")]
    return [(model.jnt_qposadr[joint], model.jnt_dofadr[joint]) for joint in joints if joint >= 0]
