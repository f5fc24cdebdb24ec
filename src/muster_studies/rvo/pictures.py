"""Pictures like Figures A.4 to A.9 and A.15 to A.17: paths, least distance and velocities, all methods side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from muster.report import save_figure
from muster.report.trajectories import MethodRun, plot_trajectories
from muster_studies.rvo.runs import METHODS, Job
from muster_studies.rvo.scenarios import Scenario, scenarios, tables

FIGURES = {"A.17": "A.4 to A.9", "A.22": "A.15 to A.17"}


def draw(folder: Path, numbers: Sequence[str]) -> list[Path]:
    """One file for each scenario of these tables; the files made."""
    made = []
    for table in (number for number in FIGURES if number in numbers):
        for scenario in scenarios(table):
            path = folder / f"{table}-{scenario.name.replace(' ', '-')}.png"
            save_figure(plot_trajectories([_ways(scenario, method) for method in METHODS], _title(scenario)), path)
            made.append(path)
    return made


def _title(scenario: Scenario) -> str:
    return f"Table {scenario.table}, scenario {scenario.name} (as Figures {FIGURES[scenario.table]})"


def _ways(scenario: Scenario, method: str) -> MethodRun:
    job = Job(scenario, method, 0 if method == "ORCA" else None)
    found, parameters = job.perform(), tables()["A.18"]
    return MethodRun(
        method=method,
        robots=tuple(scenario.robots),
        goals=job.crowd.goals,
        positions=found.positions,
        velocities=found.velocities,
        least_distances_m=found.least_distances_m,
        dt=found.dt,
        touch_m=2 * parameters["radius_m"],
        inflated_m=2 * parameters["inflated_radius_m"],
    )
