"""An allocator and a task action with a key of its own, for Muster."""

import math
from dataclasses import dataclass

from muster.mission.value_types import Key, Whole
from muster.motion.actions import ActionKeys, Impossible, along, given


def nearest(problem, stop, reach_m=1000.0):
    """Give each task to the robot whose start is nearest, in the order of the tasks."""
    routes = [[] for _ in problem.robots]
    for j, task in enumerate(problem.tasks):
        able = [i for i in range(len(routes)) if problem.may(i, j)]
        distances = {i: math.dist(problem.robots[i].position, task.position) for i in able}
        near = [i for i in sorted(able, key=distances.__getitem__) if distances[i] <= reach_m]
        if near and not problem.prerequisites[j]:
            routes[near[0]].append(j)
    stop.improved(*problem.value(routes))
    return routes


@dataclass(frozen=True)
class Photograph:
    """Go around the task's position and stop at `shots` places, a metre away."""

    name: str = "photograph"
    keys: ActionKeys = ActionKeys(
        needed=("shots",), own={"shots": Key(Whole(minimum=1, maximum=36), "how many pictures to take")}
    )

    def plan(self, task, robot):
        if robot.camera is None:
            return Impossible("it has no camera")
        (shots,) = given(task, "shots")
        x, y, *z = task.position
        angles = [2 * math.pi * k / shots for k in range(shots)]
        points = [(x + math.cos(angle), y + math.sin(angle), *z) for angle in angles]
        return along(task, robot, points, headings=[angle + math.pi for angle in angles])
