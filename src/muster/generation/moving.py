"""Random missions of robots with bodies and motion profiles: on the ground, in the air, both; with a map or without."""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random

from muster.generation.generator import Generator
from muster.mission.model import Action, Camera, Map, Mission, Robot, Rules, Task, Zone
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Flag

_SIDE_M = 60.0
_HEIGHT_M = 6.0  # at which drones fly
_CEILING_M = 12.0


@dataclass(frozen=True)
class Setting:
    """What robots there are, and whether a map with obstacles is in their way."""

    kinds: tuple[str, ...]
    over_map: bool

    @property
    def name(self) -> str:
        return f"{' and '.join(self.kinds)}, {'map' if self.over_map else 'no map'}"


SETTINGS = tuple(
    Setting(kinds, over_map) for over_map in (False, True) for kinds in (("ground",), ("air",), ("ground", "air"))
)


@record
class Moving(Checked):
    """What missions of the family `moving` share."""

    kinds: str = spec(Choice(("ground", "air", "both")), "what robots there are", default="both")
    obstacles: bool = spec(Flag(), "a map with 4 to 9 obstacles", default=False)


def moving_mission(setting: Setting, seed: int) -> Mission:
    """2 to 5 robots, 6 to 20 tasks: stays, patrols, searches, deliveries; some wait for another, some for a time."""
    draw = Random(f"{setting.name} {seed}")
    obstacles = _obstacles(draw) if setting.over_map else []
    robots = []
    for k in range(draw.randint(2, 5)):
        kind = setting.kinds[k % len(setting.kinds)]
        robots.append(_robot(draw, f"r{k}", kind, _place(draw, obstacles)))
    tasks = [_task(draw, k, _place(draw, obstacles), setting) for k in range(draw.randint(6, 20))]
    rules = Rules(objective="makespan", return_to_start=draw.random() < 0.5)
    return Mission(
        name=f"moving-{seed}",
        rules=rules,
        robots=tuple(robots),
        tasks=tuple(tasks),
        map=_map(obstacles) if setting.over_map else None,
    )


@dataclass(frozen=True)
class _Box:
    """An obstacle, metres."""

    x: float
    y: float
    width: float
    depth: float

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        right, top = self.x + self.width, self.y + self.depth
        return (self.x, self.y), (right, self.y), (right, top), (self.x, top)

    def apart_m(self, x: float, y: float) -> float:
        return max(self.x - x, x - self.x - self.width, self.y - y, y - self.y - self.depth)


def _obstacles(draw: Random) -> list[_Box]:
    boxes = []
    for _ in range(draw.randint(4, 9)):
        width, depth = sorted((draw.uniform(0.5, 3), draw.uniform(4, 18)), reverse=draw.random() < 0.5)
        boxes.append(_Box(draw.uniform(5, _SIDE_M - 5 - width), draw.uniform(5, _SIDE_M - 5 - depth), width, depth))
    return boxes


def _map(obstacles: list[_Box]) -> Map:
    boundary = _Box(-10, -10, _SIDE_M + 20, _SIDE_M + 20).corners
    return Map(
        boundary=boundary,
        zones=tuple(Zone(polygon=box.corners, floor_m=0.0, ceiling_m=_CEILING_M) for box in obstacles),
    )


def _place(draw: Random, obstacles: list[_Box]) -> tuple[float, float, float]:
    """Somewhere with room for any robot, and for what it does around it."""
    while True:
        x, y = draw.uniform(0, _SIDE_M), draw.uniform(0, _SIDE_M)
        if all(box.apart_m(x, y) > 3.5 for box in obstacles):
            return x, y, 0.0


def _robot(draw: Random, name: str, kind: str, place: tuple[float, float, float]) -> Robot:
    if kind == "air":
        return Robot(
            id=name,
            position=place,
            kind=kind,
            skills=(kind,),
            kinematics="quadcopter",
            radius_m=draw.uniform(0.2, 0.5),
            speed_mps=draw.uniform(1, 6),
            acceleration_mps2=draw.uniform(0.8, 3),
            climb_mps=draw.uniform(0.8, 3),
            camera=Camera(fov_deg=60, tilt_deg=60),
        )
    return Robot(
        id=name,
        position=place,
        skills=(kind,),
        kinematics=draw.choice(("differential-drive", "differential-drive", "holonomic")),
        radius_m=draw.uniform(0.15, 0.6),
        speed_mps=draw.uniform(0.25, 2),
        acceleration_mps2=draw.uniform(0.3, 2),
        yaw_rate_radps=draw.uniform(0.6, 3),
    )


def _task(draw: Random, k: int, place: tuple[float, float, float], setting: Setting) -> Task:
    kind = draw.choice(setting.kinds)
    what = draw.choice(("stay", "stay", "costs", "area", "bring"))
    action, duration, cost = None, None, 0.0
    if what == "stay":
        duration = draw.uniform(0, 40)
    elif what == "costs":
        cost = draw.uniform(0, 20)
    elif kind == "ground":
        action = _on_the_ground(draw, what, place)
    else:
        action = Action(name="raster-search", side_m=draw.uniform(4, 8), height_m=_HEIGHT_M, spacing_m=2.0)
    opens = draw.uniform(0, 120) if draw.random() < 0.2 else 0.0
    return Task(
        id=f"t{k}",
        position=(*place[:2], _HEIGHT_M) if kind == "air" and action is None else place,
        action=action,
        duration_s=duration,
        actuation_cost=cost,
        requires=(kind,),
        window_s=((opens, None),),
        prerequisites=(f"t{draw.randrange(k)}",) if k and draw.random() < 0.125 else (),
    )


def _on_the_ground(draw: Random, what: str, place: tuple[float, float, float]) -> Action:
    if what == "area":
        return Action(name="ground-patrol", side_m=draw.uniform(2, 4))
    angle = draw.uniform(-math.pi, math.pi)
    x, y = (round(middle + 2 * turn(angle), 9) for middle, turn in zip(place, (math.cos, math.sin), strict=False))
    return Action(name="delivery", pickup=(x, y, 0.0))


def _make(given: Moving, seed: int) -> Mission:
    kinds = ("ground", "air") if given.kinds == "both" else (given.kinds,)
    return moving_mission(Setting(kinds, given.obstacles), seed)


MOVING = Generator(
    name="moving",
    summary="2 to 5 robots with bodies and motion profiles, 6 to 20 tasks with actions; with obstacles or without",
    source="the missions of `muster study flown`",
    parameters=Moving,
    make=_make,
)
