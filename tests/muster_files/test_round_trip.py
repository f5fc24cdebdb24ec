"""A mission exported for QGroundControl and imported again: the same places, holds, ends, fences, within 1 cm.

What robots do at a task comes back as way points: a search as its lanes, an observation as where it is looked from.
"""

import json
import tempfile
from pathlib import Path

import jsonschema
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.documented import PLAN

from muster.execution.itinerary import itineraries
from muster.mission.geodesy import enu_to_wgs84, wgs84_to_enu
from muster.mission.model import Action, Camera, Map, Mission, Origin, Robot, Rules, Task, Zone
from muster.mission.plan import Plan, Route
from muster.verification import verify
from muster_files.earth import Earth
from muster_files.qgc.reader import read_flight_plans
from muster_files.qgc.writer import PlanFiles

FLYING_M = 20.0
"""How high drones of a mission in the plane fly."""

longitudes = st.one_of(st.floats(-180, 180), st.floats(-0.03, 0.03).map(lambda d: (360 + d) % 360 - 180))
origins = st.builds(Origin, lat_deg=st.floats(-80, 80), lon_deg=longitudes, alt_m=st.floats(-50, 4000))
horizontal = st.tuples(*[st.floats(-3000, 3000)] * 2)
holds = st.none() | st.floats(0.1, 600).map(lambda seconds: round(seconds, 2))
actions = st.sampled_from(
    [
        Action(name="raster-search", side_m=30.0, height_m=12.0, spacing_m=9.0),
        Action(name="stationary-observation", width_m=8.0, heading_deg=200.0),
    ]
)
zones = st.builds(
    lambda x, y, size, kinds: Zone(polygon=((x, y), (x + size, y), (x, y + size)), forbidden_to=kinds),
    *[st.floats(-2000, 2000)] * 2,
    st.floats(5, 500),
    st.sampled_from([("ground",), ("air",), ("ground", "air")]),
)
areas = st.lists(zones, max_size=3, unique_by=lambda zone: zone.polygon).map(
    lambda found: Map(boundary=((-3500, -3500), (3500, -3500), (3500, 3500), (-3500, 3500)), zones=tuple(found))
)


@st.composite
def flights(draw):
    """A mission anywhere but about the poles, in the plane or in space, and a plan that does all of it."""
    spatial = draw(st.booleans())
    place = st.tuples(horizontal, st.floats(0, 500)).map(lambda p: (*p[0], p[1]) if spatial else p[0])
    on_ground = horizontal.map(lambda p: (*p, 0.0) if spatial else p)
    robots = [
        Robot(
            id=f"r_{k}",
            position=draw(on_ground),
            kind="ground" if k % 2 else "air",
            speed_mps=draw(st.sampled_from([0.5, 1.0, 7.3])),
            return_to_start=draw(st.booleans()),
            camera=Camera(fov_deg=60.0, tilt_deg=45.0),
        )
        for k in range(draw(st.integers(1, 3)))
    ]
    flies = [robots[k % len(robots)].kind == "air" for k in range(draw(st.integers(1, 6)))]
    tasks = [
        Task(id=str(k), position=draw(on_ground), action=draw(actions))
        if air and spatial and draw(st.booleans())
        else Task(id=str(k), position=draw(place), duration_s=draw(holds))
        for k, air in enumerate(flies)
    ]
    mission = Mission(
        origin_wgs84=draw(origins),
        rules=Rules(travel="euclidean"),
        map=draw(st.none() | areas),
        robots=tuple(robots),
        tasks=tuple(tasks),
    )
    routes = tuple(Route(r.id, tuple(t.id for t in tasks[k :: len(robots)])) for k, r in enumerate(robots))
    return mission, Plan(routes=routes)


@examples(60)
@given(flights())
def test_a_mission_exported_and_imported_is_the_same_within_a_centimetre(flight):
    mission, plan = flight
    verdict = verify(mission, plan)
    assume(verdict.valid)
    team = [i for i in itineraries(mission, verdict) if len(i.passages) > 1]
    if mission.dimensions == 2:
        team = [i.at_least(FLYING_M) if i.robot.kind == "air" else i for i in team]
    again = there_and_back(mission, team)
    for itinerary, robot in zip(team, again.robots, strict=True):
        same = itinerary.robot
        assert (robot.id, robot.kind, robot.speed_mps, robot.end_position) == (same.id, same.kind, same.speed_mps, None)
        assert bool(robot.return_to_start) == same.return_to_start
    done = [passage for itinerary in team for passage in itinerary.under_way]
    assert np.allclose([task.duration_s or 0.0 for task in again.tasks], [p.stays_s for p in done], atol=1e-3)
    here = [*(itinerary.start.place for itinerary in team), *(passage.place for passage in done)]
    assert np.abs(seen_from(mission, again, [*again.robots, *again.tasks]) - here).max() < 0.01
    assert_same_map(mission, again)


def there_and_back(mission, team):
    files = PlanFiles(mission, Earth.of(mission, "a test"), team, "px4")
    with tempfile.TemporaryDirectory() as folder:
        for itinerary in team:
            data = files.plan(itinerary)
            jsonschema.validate(data, PLAN)
            (Path(folder) / f"{itinerary.robot.id}.plan").write_text(json.dumps(data), encoding="utf-8")
        return read_flight_plans(folder).mission


def seen_from(mission, again, things):
    """Where things of one mission are in the map frame of another, metres."""
    return on_map(mission, again, [(*thing.position, 0.0)[:3] for thing in things])


def on_map(mission, again, points):
    first, second = ((m.origin_wgs84.lat_deg, m.origin_wgs84.lon_deg, m.origin_wgs84.alt_m) for m in (again, mission))
    found = wgs84_to_enu(enu_to_wgs84(points, first), second)
    if again.dimensions == 2:
        found[:, 2] = 0.0  # rovers alone come back in the plane
    return found


def assert_same_map(mission, again):
    """The boundary, and for each kind of robot that is there the zones it may not enter."""
    if mission.map is None:
        assert again.map is None
        return
    assert same_corners(mission, again, mission.map.boundary, again.map.boundary)
    for kind in {robot.kind for robot in again.robots}:
        expected, found = ([z for z in m.map.zones if kind in z.forbidden_to] for m in (mission, again))
        assert len(found) == len(expected)
        for zone in expected:
            assert any(same_corners(mission, again, zone.polygon, other.polygon) for other in found)


def same_corners(mission, again, expected, polygon):
    corners = on_map(mission, again, [(*corner, 0.0) for corner in polygon])[:, :2]
    apart = np.linalg.norm(corners[:, None] - np.array(expected)[None], axis=2)
    return len(corners) == len(expected) and apart.min(axis=0).max() < 0.01
