"""What a type checker must accept."""

from pathlib import Path

from matplotlib.axes import Axes

import muster
from muster.allocation.problem import Problem


def first_come(problem: Problem, most: int = 1) -> list[list[int]]:
    routes: list[list[int]] = [[] for _ in problem.robots]
    routes[0] = list(range(most))
    return routes


robot = muster.Robot(id="r", position=(0.0, 0.0), speed_mps=0.5)
task = muster.Task(id="t", position=(3.0, 4.0), action=muster.Action(name="ground-patrol", side_m=2.0))
mission: muster.Mission = muster.Mission(robots=(robot,), tasks=(task,))
plan: muster.Plan = muster.solve(mission, "genetic", time_limit=1.0, population_size=20)
verdict: muster.Verdict = muster.verify(mission, plan)
report: muster.Report = muster.simulate(mission, plan, world="kinematic", dt_s=0.05, record=Path("a.mcap"))
axes: Axes = muster.plot(mission, plan)
axes.set_title("routes")
chart: Axes = muster.gantt(mission, plan)
seconds: float = report.mission_time_s
