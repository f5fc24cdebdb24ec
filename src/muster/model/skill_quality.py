"""How well robots can do what tasks require: the qualities of skills, which bids can count."""

from __future__ import annotations

import numpy as np

from muster.mission.model import Robot, Task
from muster.model.problem import Floats, Problem


def skill_quality(problem: Problem) -> Floats:
    """(m, n) the lowest quality of a robot's skills among those that a task requires; 1 where it requires none."""
    rows = [[_lowest(robot, task) for task in problem.tasks] for robot in problem.robots]
    return np.array(rows, dtype=np.float64).reshape(len(problem.robots), len(problem.tasks))


def _lowest(robot: Robot, task: Task) -> float:
    stated = robot.skill_quality or {}
    # 0 is the quality of a skill that the robot lacks, where the rule is ignored.
    return min((stated.get(skill, 1.0) if skill in robot.skills else 0.0 for skill in task.requires), default=1.0)
