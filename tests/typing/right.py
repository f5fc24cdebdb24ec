"""What a type checker must accept."""

from pathlib import Path

from matplotlib.axes import Axes

import muster
from muster.model.problem import Problem


def first_come(problem: Problem, most: int = 1) -> list[list[int]]:
    routes: list[list[int]] = [[] for _ in problem.robots]
    routes[0] = list(range(most))
    return routes


robot = muster.Robot(id="r", position=(0.0, 0.0), speed_mps=0.5)
task = muster.Task(id="t", position=(3.0, 4.0), action=muster.Action(name="ground-patrol", side_m=2.0))
mission: muster.Mission = muster.Mission(robots=(robot,), tasks=(task,))
plan: muster.Plan = muster.solve(mission, "genetic", time_limit=1.0, population_size=20)
other: muster.Plan = muster.solve(mission, first_come, parameters={"most": 2}, ignore=["capacity"])
quick: muster.Plan = muster.solve(mission, objective=lambda verdict: verdict.max_usage - verdict.average, candidates=3)
verdict: muster.Verdict = muster.verify(mission, plan)
report: muster.Report = muster.simulate(mission, plan, world="kinematic", dt_s=0.05, record=Path("a.mcap"))
axes: Axes = muster.plot(mission, plan)
axes.set_title("routes")
chart: Axes = muster.gantt(mission, plan)
muster.export(mission, plan, "qgc", Path("plans"), altitude=10.0)
why: str | None = muster.explain(mission, plan, "t").robot
seconds: float = report.mission_time_s
