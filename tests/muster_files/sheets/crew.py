"""A mission with stations, goods, teams, windows and lags; a plan of it, and when all happens."""

from muster import load, verify
from muster.mission.plan import Plan, Reason, Route, RouteStop, Unassigned

CREW = """\
schema: muster/1
name: crew
starts_at: 2027-03-01T23:59:00+01:00
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
rules: {timing: constant}
stations:
  - {id: pad, position: [60, 0], services: [charge], charge_per_s: 2}
robots:
  - {id: r, type: truck, position: [0, 0], load_capacity: 3, battery: {capacity: 100, reserve: 0.1}}
  - {id: s, position: [60, 50], battery: {capacity: 100}}
  - {id: t, position: [0, 100]}
  - {id: u, position: [30, 100], kind: air, return_to_start: true}
  - {id: idle, position: [0, 120]}
tasks:
  - {id: pier, position: [40, 0], load: 2}
  - {id: buoy, position: [90, 0], delivers: pier, duration_s: 5}
  - {id: beam, position: [10, 100], duration_s: 10, robots_needed: 2}
  - {id: scan, position: [10, 110], duration_s: 5, window_s: [60, 90], due_s: 62, deadline_s: 900}
  - {id: check, position: [10, 120], prerequisites: [{task: scan, after_s: 10}]}
  - {id: left, position: [5, 5], requires: [crane]}
"""
# s charges first, from 50 to 75 s; r, there after 60 s, adds 60 m in 30 s, and is at the buoy after 135 s.
# t is at the beam after 10 s, u after 20 s; t at the scan after 40 s, whose window opens after 60 s.
# u checks after 75 s.

ROUTES = {"r": ("pier", "pad", "buoy"), "s": ("pad",), "t": ("beam", "scan"), "u": ("beam", "check"), "idle": ()}
STOPS = {
    "r": [("pier", 40, 40), ("pad", 60, 75, 105), ("buoy", 135, 140)],
    "s": [("pad", 50, 50, 75)],
}


def crew_plan() -> Plan:
    """The plan, which says why a task is left out."""
    why = tuple(Reason(robot, "skill", "needs crane") for robot in ROUTES)
    return Plan(
        mission="crew",
        allocator="by hand",
        routes=tuple(Route(robot, names, stops=_stops(robot)) for robot, names in ROUTES.items()),
        unassigned=(Unassigned("left", why),),
    )


def _stops(robot: str) -> tuple[RouteStop, ...]:
    return tuple(
        RouteStop(name, times[0], times[-2], times[-1], is_station=name == "pad")
        for name, *times in STOPS.get(robot, ())
    )


def crew(folder, text: str = CREW):
    """The mission, what the judge says of its plan, and the plan."""
    (folder / "crew.yaml").write_text(text, encoding="utf-8")
    mission = load(folder / "crew.yaml")
    verdict = verify(mission, crew_plan())
    assert verdict.valid, verdict.violations
    return mission, verdict, crew_plan()
