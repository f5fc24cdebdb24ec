"""The study: its tables, its legend, how its runs are made, and its pictures.

Pictures like Figures 7 and 8: rangeBot's path and its laser's findings on the map, and the metrics as bars.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.plan import Plan, Route
from muster.running.worlds import WORLDS
from muster_studies.descriptions import captioned, description
from muster_studies.effort import Effort
from muster_studies.market_5.arena import BEACONS, SURVIVORS
from muster_studies.market_5.searches import LANDMARKED, PLACES, Search, SearchResult, performed, searches
from muster_studies.market_5.targets import Figure7, Targets
from muster_studies.market_5.tracks import SHOWN, Figure8, Goals, Localisation, measured, team
from muster_studies.market_rescue.scenario import market_case
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rescue.flights import repetitions
from muster_studies.rescue.metrics import SHOWN_ROBOT, Metric, printed_goal_error_m
from muster_studies.rescue.teams import ARENA, mission_of, verdict_of
from muster_studies.rescue.tracking import deviations, legs, track
from muster_studies.tracking_pictures import Measure, Tracked, plot_measures, plot_tracking
from muster_studies.world_pictures import world_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WORLD = WORLDS.shipped[-1]
"""That of the pictures: the paper simulates with physics."""


def _tracking(effort: Effort) -> Figure:
    first: Search = searches(effort, [_WORLD])[0]
    found = performed(first)
    tasks = tuple(visit.task for visit in found.flown[LANDMARKED].visits[SHOWN_ROBOT])
    reference = legs(ARENA, SHOWN_ROBOT, tasks)
    flights = []
    for place in PLACES:
        way, times = track(found.flown[place], SHOWN_ROBOT), found.flown[place].times
        aside = deviations(reference, way)
        flights.append(Tracked(name=place, places=way, times=times[: len(way)], aside=aside))
    points = {
        "its last scan": found.hits[SHOWN_ROBOT],
        "landmark": np.array(BEACONS),
        "survivor": np.array(list(SURVIVORS.values())),
        "found": np.array([point.position for point in found.points([SHOWN_ROBOT])]).reshape(-1, 2),
    }
    title = f"{SHOWN_ROBOT}: its way, and what it finds (as Figure 7)"
    return plot_tracking(mission_of(ARENA).map, np.concatenate(reference), flights, {}, title, points)


def _metrics(effort: Effort) -> Figure:
    found = [performed(job) for job in searches(effort, [_WORLD])]
    measures = [_measure(found, metric, place, team(effort)) for place in PLACES for metric in SHOWN]
    title = f"Metrics, mean and spread; searches: {repetitions(effort)} (as Figure 8)"
    return plot_measures(measures, title, columns=len(SHOWN))


def _measure(found: Sequence[SearchResult], metric: Metric, place: str, robots: Sequence[str]) -> Measure:
    values = {robot: measured(found, metric, robot, place) for robot in robots}
    printed = printed_goal_error_m() if (metric.name, place) == ("goal_error", LANDMARKED) else None
    return Measure.of(f"{metric.label}\n{place}", values, printed)


def _world(effort: Effort) -> Figure:
    """The arena in the physics world, with the robots at their starts."""
    found = verdict_of(ARENA, market_case(effort).iterations or 0)
    plan = Plan(routes=tuple(Route(route.robot, route.tasks) for route in found.routes))
    return world_figure(mission_of(ARENA), plan, "The arena in the physics world")


FIGURES = captioned("market-5", {"4": _world, "7": _tracking, "8": _metrics})


_TABLES: tuple[Reproduction[Search, SearchResult], ...] = (Figure7(), Figure8(), Goals(), Targets(), Localisation())

MARKET_5 = Repetition(
    **description("market-5"),
    reproductions=_TABLES,
    perform=one_by_one(performed),
    seeds=repetitions,
    extras=("map", "physics"),
    figures=FIGURES,
)
"""Three robots track their ways and search with lasers: Figures 7 and 8, targets, localisation."""
