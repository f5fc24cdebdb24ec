"""The physics world as MuJoCo's own XML (MJCF), made from the mission: ground, walls, robots. Nothing is fetched.

Who touches whom is in bits: 0 the ground, 1 robots, from 2 on one for each set of walls, as robots of different kinds
are stopped by different walls.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from muster.motion.grid import Floats
from muster_physics.bodies import (
    CASTER_AHEAD_M,
    CASTER_LIFT_M,
    CASTER_RADIUS_M,
    TRACK_M,
    WAFFLE_HEIGHT_M,
    WAFFLE_KG,
    WHEEL_KG,
    WHEEL_RADIUS_M,
    WHEEL_WIDTH_M,
    BodyKind,
    RobotBody,
    quaternion,
)
from muster_physics.xml import add

Show = Callable[[ET.Element, ET.Element], None]
GROUND_BIT, ROBOTS_BIT, FIRST_WALLS_BIT, WALL_SETS = 1, 2, 2, 29
WALL_THICKNESS_M, WALL_ABOVE_M = 0.02, 3.0
"""Walls without a top end so far above all robots."""
SERVO_S = 0.01
"""In which a wheel's servo gets to its speed, were there no limit to its torque."""
TORQUE_SHARE = 1.2
"""The most torque of a wheel, as a share of the weight upon it times its radius."""
UNSEEN, STOPPING = 3, 4
"""Groups of geoms that MuJoCo does not draw: hulls of robots; walls that stop them, of which `buildings` are drawn."""
SHOW_WIDTH, SHOW_HEIGHT = 1920, 1440
"""The largest picture that may be rendered."""


@dataclass(frozen=True)
class PlacedRobot:
    """A robot of the model: its body, where it is (x, y, z of its frame), its heading in radians.

    `walls` is the number of the set of walls that stops it; None where it touches nothing but the ground.
    """

    body: RobotBody
    position: tuple[float, float, float]
    heading: float
    walls: int | None


def mjcf(
    robots: Sequence[PlacedRobot],
    walls: Sequence[Floats],
    show: Show,
    ground_m: float,
    step_s: float,
) -> str:
    """The model as text.

    Parameters
    ----------
    robots
        in order; the names of their parts end in their number.
    walls
        sets of upright faces (k, 6) as `faces_and_slabs` gives them.
    show
        puts into the model, of which it gets the root and the body of the world, what is only to be seen.
    ground_m
        height of the ground.
    step_s
        of the physics, in seconds.
    """
    root = ET.Element("mujoco", model="muster")
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    # The implicit integrators damp the wheels after the contacts are solved, so that the body outruns them by half.
    add(root, "option", timestep=step_s, integrator="Euler", cone="elliptic", impratio=10, iterations=20)
    add(root, "size", memory="64M")
    _show(root)
    world = ET.SubElement(root, "worldbody")
    add(world, "light", pos=(0, 0, 50), dir=(0.2, 0.3, -1), type="directional", diffuse=(0.35, 0.35, 0.35))
    add(
        world,
        "geom",
        name="ground",
        type="plane",
        pos=(0, 0, ground_m),
        size=(0, 0, 100),
        rgba=(0.78, 0.8, 0.82, 1),
        contype=GROUND_BIT,
        conaffinity=0,
    )
    top = max((robot.position[2] for robot in robots), default=ground_m) + WALL_ABOVE_M
    for number, faces in enumerate(walls):
        for face in faces:
            _wall(world, face, number, ground_m, top)
    show(root, world)
    actuators = ET.SubElement(root, "actuator")
    for number, robot in enumerate(robots):
        body = add(
            world, "body", name=f"robot{number}", pos=robot.position, quat=quaternion(robot.heading)
        )  # its frame: x ahead, y left, z up
        add(body, "freejoint", name=f"free{number}")
        _MAKERS[robot.body.kind](body, actuators, number, robot)
    return ET.tostring(root, encoding="unicode")


def _show(root: ET.Element) -> None:
    visual = ET.SubElement(root, "visual")
    add(visual, "global", offwidth=SHOW_WIDTH, offheight=SHOW_HEIGHT)
    add(visual, "quality", shadowsize=0, offsamples=0, numquads=1, numslices=16, numstacks=8)
    add(visual, "headlight", ambient=(0.45, 0.45, 0.45), diffuse=(0.15, 0.15, 0.15), specular=(0, 0, 0))
    add(visual, "map", znear=0.002, zfar=50)


def _wall(world: ET.Element, face: Floats, number: int, ground_m: float, top: float) -> None:
    """An upright face as a thin box; what is below the ground is left away."""
    x0, y0, x1, y1, low, high = map(float, face)
    low, high = max(low, ground_m), min(high, max(top, low + WALL_ABOVE_M))
    length = math.hypot(x1 - x0, y1 - y0)
    if length == 0 or high <= low:
        return
    add(
        world,
        "geom",
        type="box",
        pos=((x0 + x1) / 2, (y0 + y1) / 2, (low + high) / 2),
        size=(length / 2, WALL_THICKNESS_M / 2, (high - low) / 2),
        quat=quaternion(math.atan2(y1 - y0, x1 - x0)),
        group=STOPPING,
        contype=1 << (FIRST_WALLS_BIT + number),
        conaffinity=0,
    )


def _touches(robot: PlacedRobot, *, ground: bool) -> dict[str, int]:
    """The bits of a robot's hull."""
    bits = GROUND_BIT if ground else 0
    if robot.walls is None:
        return {"contype": 0, "conaffinity": bits}
    return {"contype": ROBOTS_BIT, "conaffinity": bits | ROBOTS_BIT | 1 << (FIRST_WALLS_BIT + robot.walls)}


def _wheeled(body: ET.Element, actuators: ET.Element, number: int, robot: PlacedRobot) -> None:
    """The frame lies on the ground, in the middle between the wheels."""
    scale, (length, width, height) = robot.body.scale, robot.body.size_m
    clear, radius = 0.3 * WHEEL_RADIUS_M * scale, WHEEL_RADIUS_M * scale
    chassis_kg = (WAFFLE_KG - 2 * WHEEL_KG) * scale**3
    add(body, "inertial", pos=(0, 0, height * 0.35), mass=chassis_kg, diaginertia=robot.body.inertia_kgm2)
    middle, tall = (0, 0, (height + clear) / 2), (height - clear) / 2
    hull = (length / 2, width / 2, tall)  # the wheels are within
    add(body, "geom", type="box", pos=middle, size=hull, group=UNSEEN, **_touches(robot, ground=False))
    between = (length / 2, (TRACK_M - 1.5 * WHEEL_WIDTH_M) / 2 * scale, tall)
    add(body, "geom", type="box", pos=middle, size=between, rgba=(0.2, 0.22, 0.25, 1), contype=0, conaffinity=0)
    nose = (length / 2, 0, height * 0.8)
    mark = (0.01 * scale, width / 6, 0.02 * scale)
    add(body, "geom", type="box", pos=nose, size=mark, rgba=(0.9, 0.6, 0.1, 1), contype=0, conaffinity=0)
    ahead, ball = CASTER_AHEAD_M * scale, CASTER_RADIUS_M * scale
    for place in (ahead, -ahead):
        _foot(body, (place, 0.0), ball, CASTER_LIFT_M * scale)
    spin = 0.5 * WHEEL_KG * scale**3 * radius**2
    for side, y in (("left", TRACK_M / 2 * scale), ("right", -TRACK_M / 2 * scale)):
        wheel = add(body, "body", pos=(0, y, radius))
        add(wheel, "joint", name=f"{side}{number}", type="hinge", axis=(0, 1, 0), armature=spin)
        add(wheel, "inertial", pos=(0, 0, 0), mass=WHEEL_KG * scale**3, diaginertia=(spin, 2 * spin, spin))
        add(  # an ellipsoid touches the ground at one point
            wheel,
            "geom",
            type="ellipsoid",
            size=(radius, WHEEL_WIDTH_M / 2 * scale, radius),
            rgba=(0.1, 0.1, 0.1, 1),
            contype=0,
            conaffinity=GROUND_BIT,
            friction=(1.0, 0.0, 0.0),
            priority=1,
        )
        add(
            actuators,
            "velocity",
            name=f"{side}{number}",
            joint=f"{side}{number}",
            kv=robot.body.mass_kg * radius**2 / (2 * SERVO_S),
            forcerange=_both_ways(TORQUE_SHARE * robot.body.mass_kg * 9.81 * radius / 2),
        )


def _sliding(body: ET.Element, _: ET.Element, number: int, robot: PlacedRobot) -> None:
    """The frame lies on the ground, in the middle."""
    length, _width, height = robot.body.size_m
    clear = 0.1 * WAFFLE_HEIGHT_M * robot.body.scale
    add(body, "inertial", pos=(0, 0, height / 2), mass=robot.body.mass_kg, diaginertia=robot.body.inertia_kgm2)
    add(
        body,
        "geom",
        type="cylinder",
        pos=(0, 0, (height + clear) / 2),
        size=(length / 2, (height - clear) / 2),
        rgba=(0.25, 0.35, 0.5, 1),
        **_touches(robot, ground=False),
    )
    for angle in (0.0, 2 * math.pi / 3, -2 * math.pi / 3):
        _foot(body, (0.4 * length * math.cos(angle), 0.4 * length * math.sin(angle)), clear / 2, 0.0)


def _foot(body: ET.Element, place: tuple[float, float], radius: float, lift: float) -> None:
    """A ball on which a robot stands and that slides without friction."""
    add(
        body,
        "geom",
        type="sphere",
        pos=(*place, radius + lift),
        size=(radius,),
        contype=0,
        conaffinity=GROUND_BIT,
        condim=1,
        priority=1,
    )


def _flying(body: ET.Element, _: ET.Element, number: int, robot: PlacedRobot) -> None:
    """The frame lies in its centre of mass."""
    span, _width, height = robot.body.size_m
    about_x, about_y, about_z = robot.body.inertia_kgm2
    solid = (about_x, about_y, min(about_z, about_x + about_y))  # what the compiler takes; see `SimulatedModel`
    add(body, "inertial", pos=(0, 0, 0), mass=robot.body.mass_kg, diaginertia=solid)
    add(  # the hull is not to be seen: arms and rotors are
        body, "geom", type="cylinder", size=(span / 2, height / 2), group=UNSEEN, **_touches(robot, ground=True)
    )
    box = (span / 6, span / 9, height / 2.5)
    add(body, "geom", type="box", size=box, rgba=(0.15, 0.15, 0.2, 1), contype=0, conaffinity=0)
    for x, y, radius in _rotors(robot.body):
        _add_rotor(body, (x, y), radius, height)


def _rotors(body: RobotBody) -> list[tuple[float, float, float]]:
    """Of each rotor that is drawn: its middle in the body frame and its radius, metres."""
    if body.kind is BodyKind.ROTORCRAFT:
        airframe = body.rotorcraft
        return [(x, y, airframe.rotor_radius_m) for x, y, _ in airframe.rotors]
    half = body.size_m[0] / 2
    angles = (math.pi / 4, 3 * math.pi / 4, -3 * math.pi / 4, -math.pi / 4)
    return [(0.68 * half * math.cos(angle), 0.68 * half * math.sin(angle), 0.3 * half) for angle in angles]


def _add_rotor(body: ET.Element, place: tuple[float, float], radius: float, height: float) -> None:
    """An arm and the disc of its rotor, red in front."""
    x, y = place
    seen = {"contype": 0, "conaffinity": 0}
    arm = (0, 0, 0, x, y, 0)
    add(body, "geom", type="capsule", fromto=arm, size=(height / 12,), rgba=(0.3, 0.3, 0.3, 1), **seen)
    color = (0.8, 0.2, 0.2, 0.6) if x > 1e-9 else (0.2, 0.2, 0.2, 0.6)
    disc = (radius, height / 40)
    add(body, "geom", type="cylinder", pos=(x, y, height / 4), size=disc, rgba=color, **seen)


_MAKERS = {
    BodyKind.WHEELS: _wheeled,
    BodyKind.SLIDER: _sliding,
    BodyKind.ROTORS: _flying,
    BodyKind.ROTORCRAFT: _flying,
}


def _both_ways(most: float) -> tuple[float, float]:
    return -most, most
