"""Tasks with time windows and prerequisites: missions end early only with a good schedule."""

from __future__ import annotations

from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_ground
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Number, Whole

_SIDE_M = 100.0


@record
class Windows(Checked):
    """What missions of the family `windows` share."""

    robots: int | None = spec(
        Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots; without it from 3 to 10", default=None
    )
    tasks: int | None = spec(
        Whole(minimum=1, maximum=MOST_TASKS), "how many tasks; without it from 9 to 60", default=None
    )
    ordered: float = spec(
        Number(minimum=0, maximum=1),
        "share of pairs of tasks of which the first is a prerequisite of the second",
        default=0.1,
    )


def windows_mission(seed: int, robots: int | None = None, tasks: int | None = None, ordered: float = 0.1) -> Mission:
    """Tasks with work of 20 to 40 s and one time window each, a share of the pairs ordered.

    Parameters
    ----------
    robots, tasks
        how many; None: drawn from 3 to 10, and from 9 to 60.
    """
    draw = Random(seed)
    drawn = draw.randint(3, 10)
    team = tuple(
        Robot(id=f"r{k}", position=random_ground(draw, _SIDE_M)) for k in range(drawn if robots is None else robots)
    )
    drawn = draw.randint(9, 60)
    work = []
    for k in range(drawn if tasks is None else tasks):
        opens = draw.uniform(0, 400)
        before = tuple(f"t{j}" for j in range(k) if draw.random() < ordered)
        window = ((opens, opens + draw.uniform(30, 1600)),)
        place, work_s = random_ground(draw, _SIDE_M), draw.uniform(20, 40)
        work.append(Task(id=f"t{k}", position=place, duration_s=work_s, window_s=window, prerequisites=before))
    return Mission(name=f"windows-{seed}", rules=Rules(objective="makespan"), robots=team, tasks=tuple(work))


WINDOWS = Generator(
    name="windows",
    summary="tasks with one time window each, some of which wait for others; the makespan counts",
    source="the table `ordered` of `muster bench peers-timed`",
    parameters=Windows,
    make=lambda given, seed: windows_mission(seed, given.robots, given.tasks, given.ordered),
)
