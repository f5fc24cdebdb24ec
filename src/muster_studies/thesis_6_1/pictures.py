"""Pictures like Figures 6.4, 6.5 and 6.7, and what a camera saw."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from muster.report import save_figure
from muster.report.camera_view import with_sightings
from muster.report.canvas import frame_of_map, limits
from muster.report.found import plot_found
from muster.report.styles import FRAME
from muster_studies.effort import Effort
from muster_studies.thesis_6_1.clusters import SCATTERED, decoded, errors, k_means, near, seen_rarely
from muster_studies.thesis_6_1.flights import Flight, FlightResult, fly
from muster_studies.thesis_6_1.published import FLIGHTS, NOISE, truth

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARGIN = 0.06

FIGURES = {"6.4": "6.4", "6.5": "6.7"}
"""The published map, by table of tags."""


def draw(effort: Effort, folder: Path, numbers: tuple[str, ...]) -> list[Path]:
    """Maps without noise and with it and a camera's picture for each table of tags, two close-ups of the clusters."""
    made = []
    for number in (number for number in FIGURES if number in numbers):
        stem = f"{number}-like-figure-{FIGURES[number]}"
        calm, noisy = FLIGHTS[number](), FLIGHTS[number](noise=NOISE)
        made.append(_map(number, calm, "without noise", folder / f"{stem}.png"))
        made.append(_map(number, noisy, "1 degree, 3 cm", folder / f"{stem}-noise.png"))
        made.append(_picture(fly(calm), folder / f"{number}-camera.png"))
    if "clusters" in numbers:
        sample = near(seen_rarely(fly(SCATTERED).raw))
        for name, method in (("k-means", k_means), ("by tag", decoded)):
            points, table = errors(sample, method)
            path = folder / f"clusters-{name.replace(' ', '-')}-like-figure-6.5b.png"
            axes = plot_found(sample.raw, points, table, dict(sample.truth), f"Tag 1 seen rarely: {name}")
            save_figure(axes, path)
            made.append(path)
    return made


def _map(number: str, flight: Flight, noise: str, path: Path) -> Path:
    flown, there = fly(flight), dict(truth(number))
    title = f"Tags found in the physics world, {noise}"
    axes = plot_found(flown.raw, flown.points, flown.errors(there), there, title)
    _draw_ways(axes, flown)
    save_figure(axes, path)
    return path


def _draw_ways(axes: Axes, flown: FlightResult) -> None:
    """Where the drones flew, under all else."""
    for way in np.moveaxis(flown.ways, 1, 0):
        axes.plot(*way.T, color=FRAME, linewidth=0.6, zorder=1)
    places = np.concatenate([flown.raw.positions[:, :2], flown.ways.reshape(-1, 2)])
    frame_of_map(axes, *limits(places, _MARGIN, on_ground=False))


def _picture(flown: FlightResult, path: Path) -> Path:
    import cv2

    assert flown.best is not None
    assert flown.best.image is not None  # the physics world draws
    drawn = with_sightings(flown.best.image, flown.best.observation.sightings)
    cv2.imwrite(str(path), cv2.cvtColor(drawn, cv2.COLOR_RGB2BGR))
    return path
