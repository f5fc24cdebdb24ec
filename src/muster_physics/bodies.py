"""The bodies that robots have in the physics world: sizes, masses, and what their motors can do.

A ground robot that faces its way is the Wafflebot of [tcf-thesis] (Table A.20: 281 x 306 x 141 mm, 1.8 kg); wheels
and track are those of the TurtleBot3 Waffle, which it is. The mass and span of drones without rotors are ours.
Each has its size at the inflated radius of Table A.2, 0.3 m and 0.7 m, and another in proportion to a mission's
`radius_m`, so that it fits into the disc or ball that others keep away from. Its density stays. Drones with rotors are
as large as they are, and smaller only where they would not fit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from muster.mission.model import Robot
from muster.motion.kinematics.hexacopter import Hexacopter
from muster.motion.kinematics.registry import kinematics_named
from muster_physics.airframes import FIREFLY, RB5, Airframe

WAFFLE_LENGTH_M, WAFFLE_WIDTH_M, WAFFLE_HEIGHT_M, WAFFLE_KG = 0.281, 0.306, 0.141, 1.8
WHEEL_RADIUS_M, WHEEL_WIDTH_M, WHEEL_KG, TRACK_M = 0.033, 0.018, 0.05, 0.287
SUNK_M = 0.00019
"""By how much less than its radius a wheel rolls, whatever its size: MuJoCo's soft contact lies within it. Measured on
a straight way; odometry counts with what is left, as that of a robot whose wheels were measured by driving."""
CASTER_RADIUS_M, CASTER_AHEAD_M, CASTER_LIFT_M = 0.01, 0.11, 0.0005
SLIDER_RADIUS_M = 0.15
DRONE_RADIUS_M, DRONE_HEIGHT_M, DRONE_KG = 0.31, 0.12, 1.2
GROUND_INFLATED_M, AIR_INFLATED_M = 0.3, 0.7
"""Table A.2: R_i of ground robots and of drones."""


class BodyKind(Enum):
    """How a body is driven."""

    WHEELS = "two wheels and two casters"
    SLIDER = "frictionless feet, pushed in the plane: a holonomic ground robot"
    ROTORS = "a thrust along its own axis, and torques"
    ROTORCRAFT = "motors and rotors, one by one"


FLYING = (BodyKind.ROTORS, BodyKind.ROTORCRAFT)
ACCELERATION_MPS2 = {BodyKind.WHEELS: 2.0, BodyKind.SLIDER: 3.0, BodyKind.ROTORS: 2.5, BodyKind.ROTORCRAFT: 2.5}
"""The most that robots are told to use: wheels slip and drones tilt by more than 30 degrees not far above."""


@dataclass(frozen=True)
class RobotBody:
    """The kind of a robot's body, and its size as a multiple of the nominal one; `airframe` is that of rotorcraft."""

    kind: BodyKind
    scale: float
    airframe: Airframe = FIREFLY

    @property
    def rotorcraft(self) -> Airframe:
        """The airframe in the size of this body."""
        return self.airframe.scaled(self.scale)

    @property
    def mass_kg(self) -> float:
        if self.kind is BodyKind.ROTORCRAFT:
            return self.rotorcraft.mass_kg
        return (DRONE_KG if self.kind is BodyKind.ROTORS else WAFFLE_KG) * self.scale**3

    @property
    def size_m(self) -> tuple[float, float, float]:
        """Length, width, height of the box around it."""
        if self.kind is BodyKind.WHEELS:
            nominal = (WAFFLE_LENGTH_M, WAFFLE_WIDTH_M, WAFFLE_HEIGHT_M)
        elif self.kind is BodyKind.SLIDER:
            nominal = (2 * SLIDER_RADIUS_M, 2 * SLIDER_RADIUS_M, WAFFLE_HEIGHT_M)
        elif self.kind is BodyKind.ROTORCRAFT:
            nominal = (2 * self.airframe.radius_m, 2 * self.airframe.radius_m, DRONE_HEIGHT_M)
        else:
            nominal = (2 * DRONE_RADIUS_M, 2 * DRONE_RADIUS_M, DRONE_HEIGHT_M)
        length, width, height = (self.scale * side for side in nominal)
        return length, width, height

    @property
    def inertia_kgm2(self) -> tuple[float, float, float]:
        """About its axes: a wheeled robot's are a box's, rotorcraft's as published, the others' a cylinder's."""
        if self.kind is BodyKind.ROTORCRAFT:
            return self.rotorcraft.inertia_kgm2
        length, width, height = self.size_m
        if self.kind is BodyKind.WHEELS:
            squares = (width**2 + height**2, length**2 + height**2, length**2 + width**2)
            about_x, about_y, about_z = (self.mass_kg / 12 * square for square in squares)
            return about_x, about_y, about_z
        level = self.mass_kg / 12 * (3 * (length / 2) ** 2 + height**2)
        return level, level, self.mass_kg / 2 * (length / 2) ** 2

    @property
    def standing_m(self) -> float:
        """The height of the body's frame over the place where a mission has the robot."""
        return 0.6 * self.size_m[2] if self.kind in FLYING else 0.0


def robot_body(robot: Robot, *, rotor_level: bool = False) -> RobotBody:
    """The body of a robot; one without a radius has the nominal size, and touches nothing but the ground.

    A hexacopter is a Firefly with its rotors; other drones have rotors, those of the RB5, with `rotor_level` alone.
    """
    if robot.kind == "air" and (rotor_level or robot.kinematics == Hexacopter.name):
        airframe = FIREFLY if robot.kinematics == Hexacopter.name else RB5
        around = math.hypot(airframe.radius_m, DRONE_HEIGHT_M / 2)
        scale = min(1.0, robot.radius_m / around) if robot.radius_m > 0 else 1.0
        return RobotBody(BodyKind.ROTORCRAFT, scale, airframe)
    if robot.kind == "air":
        build, nominal = BodyKind.ROTORS, AIR_INFLATED_M
    else:
        faces_its_way = kinematics_named(robot.kinematics).faces_its_way
        build, nominal = (BodyKind.WHEELS if faces_its_way else BodyKind.SLIDER), GROUND_INFLATED_M
    return RobotBody(build, robot.radius_m / nominal if robot.radius_m > 0 else 1.0)


def quaternion(heading: float) -> tuple[float, float, float, float]:
    """The quaternion of a turn about the upright axis, w first."""
    return math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)
