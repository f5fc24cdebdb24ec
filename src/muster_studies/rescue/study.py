"""The study: its tables, its legend, how its runs are made, and its pictures.

Pictures like Figures 7 and 8: reference and flown path on the map; the metrics as bars with standard deviations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.motion.grid import Floats
from muster_studies.descriptions import captioned, description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.failures import Failures
from muster_studies.rescue.flights import Flight, FlightResult, Planning, repetitions
from muster_studies.rescue.metrics import (
    METRICS,
    SHOWN_ROBOT,
    Figure7,
    Figure8,
    Metric,
    measured,
    noisy,
    printed_goal_error_m,
)
from muster_studies.rescue.scenario import Figure5, Figure6
from muster_studies.rescue.teams import mission_of
from muster_studies.rescue.tracking import Tracking, deviations, legs, track
from muster_studies.tracking_pictures import Measure, Tracked, plot_measures, plot_tracking

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _tracking(effort: Effort) -> Figure:
    calm, *disturbed = Figure7().jobs(effort)
    mission, flown = mission_of(calm.team), calm.perform()
    tasks = tuple(visit.task for visit in flown.visits[SHOWN_ROBOT])
    reference = legs(calm.team, SHOWN_ROBOT, tasks)
    flights = [_tracked("without noise", flown, reference)]
    flights += [_tracked("with noise", flight.perform(), reference) for flight in disturbed]
    goals = {task.id: (task.position[0], task.position[1]) for task in mission.tasks if task.id in tasks}
    title = f"{SHOWN_ROBOT}: reference and flown way (as Figure 7)"
    return plot_tracking(mission.map, np.concatenate(reference), flights, goals, title)


def _tracked(name: str, flown: FlightResult, reference: Sequence[Floats]) -> Tracked:
    places = track(flown, SHOWN_ROBOT)
    return Tracked(name=name, places=places, times=flown.times[: len(places)], aside=deviations(reference, places))


def _metrics(effort: Effort) -> Figure:
    found = measured(effort, {flight: flight.perform() for flight in noisy(effort)})
    measures = [_measure(metric, found) for metric in METRICS]
    return plot_measures(measures, f"Metrics, mean and spread; flights with noise: {repetitions(effort)} (as Figure 8)")


def _measure(metric: Metric, found: Mapping[str, Sequence[Tracking]]) -> Measure:
    values = {robot: [float(getattr(one, metric.name)) for one in each] for robot, each in found.items()}
    printed = printed_goal_error_m() if metric.name == "goal_error" else None
    return Measure.of(metric.label, values, printed)


FIGURES = captioned("rescue", {"7": _tracking, "8": _metrics})


_TABLES: tuple[Reproduction[Flight | Planning, Any], ...] = (Figure5(), Figure6(), Figure7(), Figure8(), Failures())

RESCUE = Repetition(
    **description("rescue"),
    reproductions=_TABLES,
    perform=one_by_one(lambda job: job.perform()),
    seeds=repetitions,
    extras=("map",),
    figures=FIGURES,
)
"""[market-paper]'s scenario, carried out without noise, with noise, and with robots that fail; Figures 7 and 8."""
