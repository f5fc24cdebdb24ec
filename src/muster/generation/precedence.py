"""Missions whose tasks wait for each other as works do: in a tree, in layers, in series and in parallel, on pieces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_ground
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Whole

_SIDE_M = 100.0
_SKILLS = ("lift", "weld", "scan")
_SPEEDS_MPS = (1.0, 1.5)
_TASKS_OF_PIECE = 5

Prerequisites = list[list[int]]
"""Of each task."""


def tree(tasks: int, draw: Random) -> Prerequisites:
    """Each task but the last is a prerequisite of one, and a task waits for two or three as a rule."""
    before: Prerequisites = [[] for _ in range(tasks)]
    for k in range(1, tasks):
        before[draw.randint(k // 3, k // 2) if k > 1 else 0].append(k)
    return before


def layers(tasks: int, draw: Random) -> Prerequisites:
    """Layers of as many tasks as there are layers; each task waits for one to three of the layer before."""
    width = max(1, round(tasks**0.5))
    before: Prerequisites = []
    for k in range(tasks):
        last = range(max(0, (k // width - 1) * width), k // width * width)
        before.append(draw.sample(last, min(len(last), draw.randint(1, 3))))
    return before


def chains(tasks: int, draw: Random) -> Prerequisites:
    """Halves in series or in parallel, whose halves are so in turn."""
    before: Prerequisites = [[] for _ in range(tasks)]

    def join(first: int, end: int) -> tuple[list[int], list[int]]:
        """Order the tasks of a range; returns those that wait for none of it, and those that none of it waits for."""
        if end - first == 1:
            return [first], [first]
        middle = draw.randint(first + 1, end - 1)
        (sources, joints), (others, sinks) = join(first, middle), join(middle, end)
        if draw.random() < 0.5:
            return sources + others, joints + sinks
        for task in others:
            before[task] += joints
        return sources, sinks

    join(0, tasks)
    return before


def pieces(tasks: int, draw: Random) -> Prerequisites:
    """Five tasks one after the other on each piece of work."""
    return [[k - 1] if k % _TASKS_OF_PIECE else [] for k in range(tasks)]


SHAPES: Mapping[str, Callable[[int, Random], Prerequisites]] = {
    "tree": tree,
    "layers": layers,
    "chains": chains,
    "pieces": pieces,
}


@record
class Precedence(Checked):
    """What missions of the family `precedence` share."""

    shape: str = spec(Choice(tuple(SHAPES)), "how tasks wait for each other", default="tree")
    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=5)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=40)


def precedence_mission(shape: str, tasks: int, robots: int, seed: int = 0) -> Mission:
    """Robots of two speeds with two of three skills; tasks of 10 to 60 s that need one.

    Robots of `chains` return; those of `pieces` have one skill, and the tasks on a piece one place.
    """
    draw = Random(f"{shape}-{tasks}-{robots}-{seed}")
    returns, on_pieces = shape == "chains", shape == "pieces"
    each = _TASKS_OF_PIECE if on_pieces else 1
    team = tuple(
        Robot(
            id=f"r{k}",
            position=random_ground(draw, _SIDE_M),
            speed_mps=draw.choice(_SPEEDS_MPS),
            skills=(_SKILLS[k % 3],) if on_pieces else (_SKILLS[k % 3], _SKILLS[(k + 1) % 3]),
        )
        for k in range(robots)
    )
    places = [random_ground(draw, _SIDE_M) for _ in range(0, tasks, each)]
    work = tuple(
        Task(
            id=f"t{k}",
            position=places[k // each],
            duration_s=draw.uniform(10, 60),
            requires=(draw.choice(_SKILLS),),
            prerequisites=tuple(f"t{j}" for j in before),
        )
        for k, before in enumerate(SHAPES[shape](tasks, draw))
    )
    rules = Rules(objective="makespan", return_to_start=returns, makespan_includes_return=returns)
    return Mission(name=f"waiting-{shape}-{tasks}-{robots}-{seed}", rules=rules, robots=team, tasks=work)


PRECEDENCE = Generator(
    name="precedence",
    summary="tasks that wait for each other in a tree, in layers, in series and in parallel, or on pieces of work",
    source="the missions of `muster bench peers-waiting`",
    parameters=Precedence,
    make=lambda given, seed: precedence_mission(given.shape, given.tasks, given.robots, seed),
)
