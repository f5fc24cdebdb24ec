"""Drones that look at places in space: three coordinates, climb and descent, cameras; with pads, batteries too."""

from __future__ import annotations

from random import Random
from typing import Any

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_place, rounded
from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Number, Whole

_SENSORS = ("camera", "thermal")
_LOWEST_M = 10.0
_APART_M = 2.0
_SPEEDS_MPS = (4.0, 6.0, 8.0)
_SWAP_S = 60.0


@record
class Drones(Checked):
    """What missions of the family `drones` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many drones", default=4)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many places to look at", default=24)
    side_m: float = spec(Number(above=0), "side of the square", default=300.0)
    highest_m: float = spec(Number(minimum=_LOWEST_M), "heights are from 10 m to this", default=60.0)
    range_m: float = spec(Number(above=0), "how far a drone flies: its work capacity or battery", default=1200.0)
    pads: int = spec(Whole(maximum=1000), "pads where drones swap batteries; 0: they have none", default=0)


def drones_mission(given: Drones, seed: int) -> Mission:
    """The mission of a seed: drones start in a row in the south-west, and come back."""
    draw = Random(seed)
    energy: dict[str, Any] = {"battery": Battery(capacity=given.range_m, reserve=0.1)}
    limit = energy if given.pads else {"work_capacity": given.range_m}
    robots = tuple(
        Robot(
            id=f"uav_{k}",
            position=(_APART_M * k, 0.0, 0.0),
            kind="air",
            kinematics="quadcopter",
            speed_mps=draw.choice(_SPEEDS_MPS),
            acceleration_mps2=2.0,
            climb_mps=2.0,
            skills=("camera", "thermal") if k % 2 == 0 else ("camera",),
            **limit,
        )
        for k in range(given.robots)
    )
    return Mission(
        rules=Rules(objective="makespan", return_to_start=True, makespan_includes_return=True),
        robots=robots,
        tasks=tuple(
            Task(
                id=str(k),
                position=rounded(*random_place(draw, given.side_m), draw.uniform(_LOWEST_M, given.highest_m)),
                duration_s=draw.randint(5, 30),
                requires=(draw.choice(_SENSORS),),
            )
            for k in range(given.tasks)
        ),
        stations=tuple(
            Station(
                id=f"pad_{k}",
                position=(*rounded(*random_place(draw, given.side_m)), 0.0),
                services=("swap",),
                swap_s=_SWAP_S,
            )
            for k in range(given.pads)
        ),
    )


DRONES = Generator(
    name="drones",
    summary="drones with cameras look at places in space and come back; batteries and pads, if asked for",
    source="made for comparisons: missions in three dimensions with motion profiles",
    parameters=Drones,
    make=drones_mission,
)
