"""A mission on Earth with drones, a rover, a fence and zones; a plan of it, and what the writers are given."""

from pathlib import Path

from muster import load
from muster.execution.reports.itinerary import itineraries
from muster.mission.plan import Plan, Route
from muster.verification import verify

LAT, LON, ALT = 35.53, -124.06, 12.0
"""No number of it could stand for another: 124 is no latitude, and 35 east would be in Asia."""

BAY = f"""\
schema: muster/1
name: bay
origin_wgs84: {{lat_deg: {LAT}, lon_deg: {LON}, alt_m: {ALT}}}
rules: {{travel: euclidean}}
map:
  boundary: [[-100, -100], [300, -100], [300, 300], [-100, 300]]
  zones:
    - {{polygon: [[-60, -60], [-60, -20], [-20, -20], [-20, -60]]}}
    - {{polygon: [[60, 20], [90, 20], [90, 60], [60, 60]], ceiling_m: 4}}
    - {{polygon: [[200, 0], [220, 0], [220, 20]], forbidden_to: [ground]}}
robots:
  - {{id: d1, position: [0, 0, 0], kind: air, speed_mps: 5, radius_m: 0.3, return_to_start: true,
     camera: {{fov_deg: 60, tilt_deg: 45}}}}
  - {{id: d2, position: [3, 0, 0], kind: air, speed_mps: 4, radius_m: 0.3, end_position: [10, -30, 2]}}
  - {{id: d3, position: [6, 0, 0], kind: air, speed_mps: 4, radius_m: 0.3}}
  - {{id: rover, position: [10, 5, 0], speed_mps: 1, radius_m: 0.3}}
  - {{id: idle, position: [20, 5, 0], speed_mps: 1, radius_m: 0.3}}
tasks:
  - {{id: a, position: [100, 40, 20], duration_s: 10}}
  - {{id: b, position: [40, 90, 15], action: {{name: raster-search, side_m: 20, height_m: 10, spacing_m: 8}}}}
  - {{id: c, position: [150, 150, 0], action: {{name: stationary-observation, width_m: 10, heading_deg: 30}}}}
  - {{id: e, position: [-40, 60, 9]}}
  - {{id: g, position: [20, 30, 0], prerequisites: [a]}}
  - {{id: left, position: [30, 30, 0]}}
"""

ROUTES = {"d1": ("b", "c"), "d2": ("a",), "d3": ("e",), "rover": ("g",), "idle": ()}


def bay(folder: Path, text: str = BAY):
    """The mission, and what the judge says of its plan."""
    (folder / "bay.yaml").write_text(text, encoding="utf-8")
    mission = load(folder / "bay.yaml")
    verdict = verify(mission, bay_plan())
    assert {violation.kind for violation in verdict.violations} <= {"unassigned"}
    return mission, verdict, itineraries(mission, verdict)


def bay_plan() -> Plan:
    return Plan(mission="bay", routes=tuple(Route(robot, tasks) for robot, tasks in ROUTES.items()))
