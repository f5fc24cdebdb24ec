"""The physics world: the crowd chooses velocities, as in the kinematic world; forces move the robots.

In each step the core's crowd gets the robots' true poses and chooses a velocity for each, by way points, avoidance and
right of way. `control` turns velocities into torques and forces, MuJoCo turns these into motion.

The ground is flat. A ground robot's height in the mission is that of its way, as in the kinematic world. In a mission
in the plane drones fly at `FLIGHT_M`.

Batteries of bodies: how much they hold, and what is drawn from them beside the work of rotors and wheels.

A drone's holds what lets it hover for its flight time. A ground robot's is the TurtleBot3 Waffle's, 19.98 Wh for two
hours of operation [robotis2017]; what that draws in the mean it draws all the time, wheels beside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Tag
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import limits_of
from muster.motion.limits import Limits
from muster.motion.map_world import body_of
from muster.motion.noise import CALM, Wind
from muster.perception.laser import NO_DISCS, Scanner
from muster.simulation.lasers import laser_height_m
from muster.simulation.port import SimulatedPort
from muster.simulation.world_base import FLIGHT_M, Event, WorldBase
from muster_physics.bodies import ACCELERATION_MPS2, BodyKind, RobotBody, robot_body
from muster_physics.buildings import Heights
from muster_physics.control import Control
from muster_physics.controller import Commands
from muster_physics.model import WALL_SETS, PlacedRobot
from muster_physics.rays import Rays
from muster_physics.scenery import Scenery
from muster_physics.simulated_model import SimulatedModel
from muster_physics.wind import WindField

if TYPE_CHECKING:
    from muster_physics.rendered_cameras import RenderedCameras

WAFFLE_J = 19.98 * 3600.0
WAFFLE_OPERATION_S = 2 * 3600.0


@dataclass(frozen=True)
class PowerSupply:
    """A battery of a capacity in joules, from which a body draws `standing_w` all the time."""

    capacity_j: float
    standing_w: float

    def drained(self, energy_j: float, seconds: float) -> float:
        """The share of the capacity that this work, and being on for so long, have drained."""
        return (energy_j + self.standing_w * seconds) / self.capacity_j


def power_supply(body: RobotBody) -> PowerSupply:
    """The supply of a body; in proportion to its mass."""
    if body.kind is BodyKind.ROTORCRAFT:
        airframe = body.rotorcraft
        return PowerSupply(airframe.hover_w * airframe.flight_s, 0.0)
    capacity_j = WAFFLE_J * body.scale**3
    return PowerSupply(capacity_j, capacity_j / WAFFLE_OPERATION_S)


PHYSICS_S = 0.005
"""The longest step of physics."""
ROTORCRAFT_CLEARANCE_M = 0.03
"""The gap that the right of way leaves where rotorcraft fly: they follow velocities less exactly than others."""
WIND_CLEARANCE_M, GUST_CLEARANCE_S = 0.05, 0.01
"""The same in wind: the first, and the second times the speed of gusts."""
GUSTY_ARRIVAL_M = 0.1
"""The distance at which one that gusts keep off has arrived."""
STILL_MPS = 0.002
"""Slower is standing: a drone that hovers is never quite still."""


class PhysicsWorld(WorldBase):
    """Robots with masses, wheels and rotors; see `WorldBase`, and `bodies` for their sizes.

    Robots without a radius, and all with `avoidance="none"`, touch nothing but the ground. No robot accelerates harder
    than `ACCELERATION_MPS2`, whatever its mission allows. When a robot joins, the model is made anew, and all others go
    on as they were.

    Parameters
    ----------
    rotor_level
        whether all drones have motors and rotors that are simulated one by one; else hexacopters alone do. In wind, and
        with batteries, all do.
    wind
        the wind in which drones fly.

    Raises
    ------
    ParameterError
        as `WorldBase`; and if robots of more than 29 kinds are stopped by different walls.
    """

    _turned_rad = 0.01
    _clearance_m = 0.003

    def __init__(self, mission: Mission, *, rotor_level: bool = False, wind: Wind = CALM, **how: Any) -> None:
        self._rotor_level = rotor_level or wind.blows or bool(how.get("batteries"))
        if any(self._body(robot).kind is BodyKind.ROTORCRAFT for robot in mission.all_robots):
            windy_m = WIND_CLEARANCE_M + GUST_CLEARANCE_S * wind.gusts_mps
            self._clearance_m = windy_m if wind.blows else ROTORCRAFT_CLEARANCE_M
        self._collide = how.get("avoidance") != "none"
        self._wall_sets: list[Floats] = []
        self._tags = mission.tags
        self._simulated: SimulatedModel | None = None
        self._built_of: tuple[int, frozenset[str]] | None = None
        self._rays: Rays | None = None
        if wind.gusts_mps > 0:
            how.setdefault("arrival_m", GUSTY_ARRIVAL_M)
        super().__init__(mission, **how)
        self._wind = WindField(wind, self._seed)
        if (snapshot := how.get("snapshot")) is not None:
            self.simulated.resume(snapshot["bodies"])

    @property
    def _count(self) -> int:
        """Steps of physics in one of the world."""
        return max(1, math.ceil(self._dt_s / PHYSICS_S - 1e-9))

    def snapshot(self) -> dict[str, Any]:
        """See `WorldBase`."""
        return {**super().snapshot(), "bodies": self.simulated.snapshot()}

    @property
    def simulated(self) -> SimulatedModel:
        """MuJoCo's model and data of the robots that are in the world now."""
        self._update_model()
        assert self._simulated is not None
        return self._simulated

    def cameras(self, tags: Sequence[Tag], seed: int) -> RenderedCameras:
        """See `WithCameras`; pictures are rendered of the world, in which the mission's tags lie."""
        from muster_physics.rendered_cameras import RenderedCameras

        return RenderedCameras(self)

    def replica(self, heights: Heights) -> SimulatedModel:
        """Another model with the same robots, which can be put anywhere for pictures; see `buildings`."""
        simulated = self.simulated
        return SimulatedModel(
            simulated.robots, (), Scenery(self._map, self._tags, self.ground_m, heights), simulated.step_s
        )

    @property
    def frames(self) -> Floats:
        """See `SimulatedWorld`; the frame of a drone is at its centre of mass."""
        simulated = self.simulated
        found: Floats = simulated.data.xpos[simulated.bodies].copy()
        return found

    @property
    def axes(self) -> Floats:
        """See `SimulatedWorld`."""
        simulated = self.simulated
        found: Floats = simulated.data.xmat[simulated.bodies].reshape(-1, 3, 3)
        return found

    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """See `SimulatedWorld`. Rays meet walls and the visible shapes of bodies; the laser tilts with the robot."""
        number, frames, axes = self._number(robot), self.frames, self.axes
        place = frames[number] + laser_height_m(self._robots[number], height_m) * axes[number, :, 2]
        bearings = scanner.bearings
        beams = np.column_stack([np.cos(bearings), np.sin(bearings)]) @ axes[number, :, :2].T
        x, y = map(float, place[:2])
        heading = math.atan2(axes[number, 1, 0], axes[number, 0, 0])
        assert self._rays is not None
        met = self._rays.lengths(number, place, beams, scanner.reach_m)
        return np.minimum(met, scanner.ranges((x, y, heading), discs=cylinders))

    def _drained_by(self, robot: Robot, number: int, port: SimulatedPort) -> Callable[[], float]:
        """By energy: that of rotors and wheels, and what robots on the ground draw all the time."""
        supply, begin_s = power_supply(self._body(robot)), self.time_s
        return lambda: supply.drained(float(self.simulated.energy_j[number]), self.time_s - begin_s)

    def _limits(self, robot: Robot) -> Limits:
        limits = limits_of(robot)
        most = ACCELERATION_MPS2[self._body(robot).kind]
        return replace(limits, acceleration_mps2=min(limits.acceleration_mps2, most))

    def _go_on(self, until_s: float) -> list[Event]:
        while self.time_s + self._dt_s <= until_s + 1e-6 * self._dt_s:
            if events := self._carry_out():
                return events
        return []

    def _carry_out(self) -> list[Event]:
        """One step of the world."""
        self._update_model()
        if self._wind.wind.blows:
            heights = self.frames[:, 2] - self.ground_m
            self.simulated.rotors.wind[:] = self._wind.step(heights, self.velocities, self._dt_s)
        rows = np.array(self._crowd.command()).reshape(-1, 5)
        rates = rows[:, [0, 1, 2, 4]] * self._carried
        done = self._control.carry_out(Commands(rates, rows[:, 3]), self._count, self._force_shares(len(rows)))
        after, lags = done.poses, done.lags
        lags *= self._carried
        heights = self._crowd.positions()[:, 2] + self._dt_s * rows[:, 2]
        after[:, 2] = np.where(self._carried[:, 2] > 0, after[:, 2] - self._standing_m, heights)
        return self._crowd.carried_out(after, lags, done.counted, STILL_MPS)

    def _put(self, number: int, place: tuple[float, ...]) -> None:
        """See `WorldBase`; the body stands where it is put, upright."""
        super()._put(number, place)
        robot = self._robots[number]
        placed = self._placed(robot, np.array(place), float(self.headings[number]), 0)
        self.simulated.put(number, placed.position, float(self.headings[number]))
        self._control.put(number)

    def _force_shares(self, count: int) -> Floats | None:
        """Shares of commanded force that the motors of `count` robots give in this step; None: all of it."""
        if self._noise.motors == 0:
            return None
        random = np.random.default_rng(np.random.SeedSequence((self._seed, self._crowd.steps), spawn_key=(2,)))
        return np.maximum(0.0, random.normal(1.0, self._noise.motors, (count, 2)))

    def _update_model(self) -> None:
        """Make the model at first, and anew when a robot has joined or a door turned; all go on as they were."""
        before, built_of = self._simulated, (len(self._robots), self._doors_closed)
        if before is not None and built_of == self._built_of:
            return
        self._built_of = built_of
        self._wall_sets = []
        walls = [self._walls_of(robot) for robot in self._robots]
        robots = [
            self._placed(*one) for one in zip(self._robots, self._crowd.positions(), self.headings, walls, strict=True)
        ]
        scenery = Scenery(self._map, self._tags, self.ground_m)
        simulated = SimulatedModel(robots, self._wall_sets, scenery, self._dt_s / self._count)
        if before is not None:
            simulated.take_over(before)
        self._simulated = simulated
        self._rays = Rays(simulated, walls)
        self._control = Control(simulated, keeps_height=self._dimensions == 2)
        self._standing_m = np.array([robot.body.standing_m for robot in robots])
        in_space = [robot.kind == "air" and self._dimensions == 3 for robot in self._robots]
        # Of x, y, z and heading what physics moves: heights only of those that fly in space.
        self._carried = np.array([[1.0, 1.0, float(climbs), 1.0] for climbs in in_space]).reshape(-1, 4)

    def _placed(self, robot: Robot, place: Floats, heading: float, walls: int) -> PlacedRobot:
        body = self._body(robot)
        height = self.ground_m
        if robot.kind == "air":
            height = FLIGHT_M if self._dimensions == 2 else float(place[2]) + body.standing_m
        collides = self._collide and robot.radius_m > 0
        position = (float(place[0]), float(place[1]), height)
        return PlacedRobot(body, position, float(heading), walls if collides else None)

    def _body(self, robot: Robot) -> RobotBody:
        return robot_body(robot, rotor_level=self._rotor_level)

    def _walls_of(self, robot: Robot) -> int:
        """The number of the set of walls that stops a robot."""
        faces = self._faces_for(body_of(robot))[0]
        for number, known in enumerate(self._wall_sets):
            if np.array_equal(known, faces):
                return number
        if len(self._wall_sets) == WALL_SETS:
            raise ParameterError(f"robots: more than {WALL_SETS} sets of walls that stop them; expected fewer")
        self._wall_sets.append(faces)
        return len(self._wall_sets) - 1
