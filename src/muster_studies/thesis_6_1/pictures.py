"""Figures 6.4, 6.5 and 6.7, and what a camera saw."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.plan import Plan, Route
from muster.report.figures.canvas import frame_of_map, limits, new_figure
from muster.report.figures.styles import FRAME, TEXT
from muster.report.found import plot_found
from muster_physics.camera_view import with_sightings
from muster_studies.effort import Effort
from muster_studies.figures import Draw
from muster_studies.runs import mission_named
from muster_studies.thesis_6_1.clusters import SCATTERED, decoded, errors, k_means, near, seen_rarely
from muster_studies.thesis_6_1.flights import Flight, FlightResult, fly
from muster_studies.thesis_6_1.published import FLIGHTS, NOISE, truth
from muster_studies.world_pictures import world_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARGIN = 0.06


def _maps(table: str, effort: Effort) -> Figure:
    """The tags that were found without noise and with it, side by side."""
    figure = new_figure(13.0, 6.6)
    flights = {"without noise": FLIGHTS[table](), "1 degree, 3 cm": FLIGHTS[table](noise=NOISE)}
    for ax, (noise, flight) in zip(figure.subplots(1, 2), flights.items(), strict=True):
        _draw_map(ax, table, flight, noise)
    return figure


def _draw_map(ax: Axes, table: str, flight: Flight, noise: str) -> None:
    flown, there = fly(flight), dict(truth(table))
    plot_found(flown.raw, flown.points, flown.errors(there), there, f"Tags found in the physics world, {noise}", ax)
    _draw_ways(ax, flown)


def _draw_ways(axes: Axes, flown: FlightResult) -> None:
    """Where the drones flew, under all else."""
    for way in np.moveaxis(flown.ways, 1, 0):
        axes.plot(*way.T, color=FRAME, linewidth=0.6, zorder=1)
    places = np.concatenate([flown.raw.positions[:, :2], flown.ways.reshape(-1, 2)])
    frame_of_map(axes, *limits(places, _MARGIN, on_ground=False))


def _clusters(effort: Effort) -> Figure:
    """The sightings around a tag that was seen rarely, put together by k-means and by tag, side by side."""
    figure, sample = new_figure(13.0, 6.6), near(seen_rarely(fly(SCATTERED).raw))
    methods = {"k-means": k_means, "by tag": decoded}
    for ax, (name, method) in zip(figure.subplots(1, 2), methods.items(), strict=True):
        points, table = errors(sample, method)
        plot_found(sample.raw, points, table, dict(sample.truth), f"Tag 1 seen rarely: {name}", ax)
    return figure


def _world(table: str, at_s: float, effort: Effort) -> Figure:
    """The physics world of a table of tags, with the drones under way."""
    flight = FLIGHTS[table]()
    mission = mission_named(flight.mission)
    plan = Plan(routes=tuple(Route(*route) for route in flight.routes), ignored=flight.ignored)
    return world_figure(mission, plan, f"{mission.name} in the physics world", flight.ignored, at_s)


def _camera(effort: Effort) -> Figure:
    """The picture with the most tags, and what was detected in it."""
    best = fly(FLIGHTS["6.4"]()).best
    assert best is not None
    assert best.image is not None  # the physics world draws
    figure = new_figure(6.4, 5.2)
    ax = figure.subplots()
    ax.imshow(with_sightings(best.image, best.observation.sightings))
    ax.set_axis_off()
    ax.set_title("A camera's picture in the physics world, and the tags detected", fontsize=10, color=TEXT)
    return figure


DRAWINGS: Mapping[str, Draw] = {
    "4.11": _camera,
    "6.1": partial(_world, "6.4", 0.5),
    "6.4": partial(_maps, "6.4"),
    "6.5": _clusters,
    "6.6": partial(_world, "6.5", 20.0),
    "6.7": partial(_maps, "6.5"),
}
"""By number of a figure."""
