"""The heights at which drones fly that share the air, and what comes too close.

Drones of a plan may be given a least height above their starts, each its own: separated layers. What lies higher stays
there. The schedule is the judge's: climbing to a height takes no time in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from muster.execution.itinerary import Itinerary, heights_of_work, itineraries
from muster.execution.separation import meetings
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.texts.near_matches import did_you_mean
from muster.planning.export_formats import ExportOptions
from muster.verification import Verdict


def altitudes_of(mission: Mission, options: ExportOptions) -> dict[str, float]:
    """The least height above its start, metres, of each drone that the options give one; in mission order.

    A drone has the same height whatever the plan, as its number among the drones of the mission says.

    Raises
    ------
    ParameterError
        for a robot that is none of the mission, or none in the air, and for an option that fits no robot.
    """
    drones = [robot.id for robot in mission.robots if robot.kind == "air"]
    _require_robots(mission, drones, options)
    for name in options.altitudes:
        if name not in drones:
            hint = did_you_mean(name, drones)
            raise ParameterError(f"altitudes: {name}; expected robots of kind air: {', '.join(drones) or 'none'}{hint}")
    if options.altitude is None and not options.altitude_step:
        return {name: options.altitudes[name] for name in drones if name in options.altitudes}
    first = options.altitude_step if options.altitude is None else options.altitude
    layers = {name: first + k * options.altitude_step for k, name in enumerate(drones)}
    return {name: float(options.altitudes.get(name, height)) for name, height in layers.items()}


def _require_robots(mission: Mission, drones: Sequence[str], options: ExportOptions) -> None:
    """Refuse options for heights without drones, for steps without a second one, and for distances of one robot."""
    of_drones = {"altitude": options.altitude, "altitude_step": options.altitude_step or None}
    for name, value in of_drones.items():
        if value is not None and not drones:
            raise ParameterError(f"{name}: {value:g}; expected it with robots of kind air: the mission has none")
    if options.altitude_step and options.altitude is not None and len(drones) < 2:
        told = f"expected it, beside altitude, with several robots of kind air: the mission has {drones[0]} alone"
        raise ParameterError(f"altitude_step: {options.altitude_step:g}; {told}")
    if options.clearance and len(mission.robots) < 2:
        told = f"expected it with several robots: the mission has {mission.robots[0].id} alone"
        raise ParameterError(f"clearance: {options.clearance:g}; {told}")


def at_work(mission: Mission, whole: Sequence[Itinerary]) -> tuple[Itinerary, ...]:
    """The itineraries of a mission in the plane with each drone's work at the `height_m` of its action.

    In space they are as they are: heights of actions are in them.
    """
    if mission.dimensions == 3:
        return tuple(whole)
    heights = heights_of_work(mission)
    return tuple(itinerary.with_heights(heights) if itinerary.robot.kind == "air" else itinerary for itinerary in whole)


def raised(itinerary: Itinerary, altitudes: Mapping[str, float]) -> Itinerary:
    """The itinerary of a drone at its height; of other robots as it is."""
    height = altitudes.get(itinerary.robot.id)
    return itinerary if height is None else itinerary.at_least(height)


def raised_team(
    mission: Mission, verdict: Verdict, altitudes: Mapping[str, float], options: ExportOptions
) -> tuple[tuple[Itinerary, ...], tuple[str, ...]]:
    """The itineraries of all robots, drones at their heights, and what is to be said of that."""
    whole = at_work(mission, itineraries(mission, verdict))
    team = tuple(raised(itinerary, altitudes) for itinerary in whole)
    return team, tuple(height_notes(mission, whole, team, options)) if options.separates else ()


def height_notes(
    mission: Mission, whole: Sequence[Itinerary], team: Sequence[Itinerary], options: ExportOptions
) -> Iterator[str]:
    """Messages on drones whose tasks were raised, whose layers touch, and on robots that come too close in time.

    Parameters
    ----------
    whole, team
        the itineraries before and after drones were given their heights.
    """
    for before, after in zip(whole, team, strict=True):
        yield from _raised_tasks(before, after, anywhere=mission.dimensions == 3)
    if options.altitude_step or options.altitudes:
        yield from _shared_heights(team, options.clearance)
    yield from (f"warning: {meeting}" for meeting in meetings(team, options.clearance))


def _raised_tasks(before: Itinerary, after: Itinerary, *, anywhere: bool) -> Iterator[str]:
    """Tasks that are done higher than the mission says; `anywhere`: also those on the ground."""
    pairs = zip(before.under_way, after.under_way, strict=True)
    higher = [was for was, now in pairs if was.place[2] < now.place[2] and (anywhere or was.place[2])]
    tasks = [task for task in dict.fromkeys(was.task for was in higher) if task is not None]
    if tasks:
        told = f"{', '.join(tasks[:3])}{', ...' if len(tasks) > 3 else ''}"
        yield f"{before.robot.id}: does {told} at its height of flight, not lower as the mission says"


def _shared_heights(team: Sequence[Itinerary], clearance_m: float) -> Iterator[str]:
    """Pairs of drones between whose heights under way there is less than bodies and clearance need."""
    flying = [(i, *_heights(i)) for i in team if i.robot.kind == "air" and i.under_way]
    for (a, low, high), (b, other_low, other_high) in combinations(flying, 2):
        gap = max(low, other_low) - min(high, other_high)
        least = a.robot.radius_m + b.robot.radius_m + clearance_m
        if gap <= 0 or gap < least - 1e-9:
            spans = f"from {low:g} to {high:g} m, and from {other_low:g} to {other_high:g} m"
            yield f"warning: {a.robot.id} and {b.robot.id} do not fly in layers of their own: {spans}"


def _heights(itinerary: Itinerary) -> tuple[float, float]:
    heights = [passage.place[2] for passage in itinerary.under_way]
    return min(heights), max(heights)
