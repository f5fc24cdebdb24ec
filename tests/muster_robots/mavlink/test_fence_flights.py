"""Flights of drones whose autopilots have fences of polygons and circles, from the plan to the landing."""

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission
from tests.muster_robots.mavlink.fault_flights import FAR, fly

from muster.mission.model import Task
from muster.motion.port import Waypoint
from muster_robots.mavlink import Kind
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.own_limits import OwnLimits
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated.geofence import HOLDS, LANDS, RETURNS, Area, Geofence

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
ALL = {task.id for task in FAR}
HOME = "returned, landed, not armed"
BESIDE = Area(False, ((50.0, -20.0), (90.0, -20.0), (90.0, 9.0), (50.0, 9.0)))
"""An exclusion in which t_0 and t_1 are, for a drone whose home is the origin of the map."""


def sets_out(flight):
    return min(event.time_s for event in flight.events if event.kind == "sets_out")


@pytest.mark.long(keep=4)
@KINDS
@pytest.mark.parametrize("offboard", [False, True], ids=["missions", "offboard"])
@pytest.mark.parametrize(
    "areas",
    [
        (BESIDE,),
        (Area(False, ((60.0, 3.0),), 6.0),),
        (Area(True, ((-20.0, -20.0), (90.0, 20.0), (90.0, 90.0), (-20.0, 90.0))),),
        (Area(True, ((0.0, 0.0),), 300.0), BESIDE, Area(False, ((200.0, 200.0),), 9.0)),
    ],
    ids=["exclusion", "exclusion circle", "inclusion", "several"],
)
def test_tasks_outside_are_done_by_others_and_refused_before_take_off(areas, offboard, kind):
    fence = Geofence(areas, return_point=True)
    flight = fly(Faults(), kind=kind, fences={"r_0": fence}, offboard=offboard)
    assert flight.done == ALL
    assert flight.fleet.faults == []
    assert {"t_0", "t_1"} <= flight.refused_by("r_0")
    refused = [event for event in flight.events if event.kind == "task_refused"]
    assert all(event.time_s <= sets_out(flight) for event in refused)
    assert all("of the autopilot's fence" in event.data["reason"] for event in refused)
    assert flight.refused_by("r_1") == set()
    assert {state.state for state in flight.states.values()} == {HOME}


ROUND = {
    "concave": (Area(True, ((-10.0, -10.0), (80.0, -10.0), (80.0, 20.0), (20.0, 20.0), (20.0, 80.0), (-10.0, 80.0))),),
    "wall": (Area(False, ((10.0, 20.0), (60.0, 20.0), (60.0, 24.0), (10.0, 24.0))),),
    "circle": (Area(False, ((35.0, 35.0),), 20.0), Area(True, ((30.0, 30.0),), 200.0)),
}
"""Fences that the straight leg between `EAST` and `NORTH` crosses."""
EAST, NORTH = Task(id="east", position=(70.0, 0.0, 10.0)), Task(id="north", position=(0.0, 70.0, 10.0))
DIVIDED = (
    Area(True, ((-20.0, -20.0), (100.0, -20.0), (100.0, 100.0), (-20.0, 100.0))),
    Area(False, ((-30.0, 30.0), (110.0, 30.0), (110.0, 34.0), (-30.0, 34.0))),
)
"""A fence without a path to what lies north of its wall."""


@pytest.mark.long(keep=4)
@KINDS
@pytest.mark.parametrize("offboard", [False, True], ids=["missions", "offboard"])
@pytest.mark.parametrize("areas", ROUND.values(), ids=ROUND)
def test_a_leg_that_would_cross_the_fence_is_flown_round_it(areas, offboard, kind):
    """Each place is allowed; the straight way between the two is not. A breach would be a fault."""
    flight = fly(Faults(), tasks=(EAST, NORTH), kind=kind, count=1, fences={"r_0": Geofence(areas)}, offboard=offboard)
    assert flight.fleet.faults == []
    assert flight.wrongs == []
    assert flight.done == {"east", "north"}
    assert flight.states["r_0"].state == HOME


def test_a_detour_and_a_return_over_the_fence_are_told_before_take_off(caplog):
    across = Area(False, ((30.0, -5.0), (34.0, -5.0), (34.0, 5.0), (30.0, 5.0)))
    fly(Faults(), tasks=(EAST,), count=1, fences={"r_0": Geofence((across,))})
    there, back = (record.getMessage() for record in caplog.records if "fence" in record.getMessage())
    assert there == "r_0: the way to task east is flown round its autopilot's fence, longer than planned"
    assert back.startswith("r_0: its return home after its last task: straight from (70.00, 0.00) to (0.00, 0.00)")


@KINDS
def test_a_planned_leg_without_a_path_round_the_fence_is_refused_before_take_off(kind):
    tasks = EAST, NORTH
    flight = fly(Faults(), tasks=tasks, kind=kind, count=1, fences={"r_0": Geofence(DIVIDED)})
    assert flight.fleet.faults == []
    assert set(flight.lost) == {"north"}
    assert "straight from" in flight.lost["north"]
    assert "outside exclusion polygon 2 of the autopilot's fence" in flight.lost["north"]
    assert flight.done == {"east"}
    assert all(event.time_s <= sets_out(flight) for event in flight.events if event.kind == "task_refused")
    assert flight.states["r_0"].state == HOME


def test_a_leg_of_a_later_plan_costs_its_task_when_it_is_ordered():
    """r_1 fails, r_0 is planned for what is left: an order that leaves the fence is not sent."""
    tasks = Task(id="here", position=(60.0, 0.0, 10.0)), Task(id="there", position=(60.0, 60.0, 10.0))
    flight = fly({"r_1": Faults(refuse_arm=True)}, tasks=tasks, fences={"r_0": Geofence(DIVIDED)})
    assert set(flight.lost) | flight.done == {"here", "there"}
    assert flight.wrongs == []
    (fault,) = [fault for fault in flight.fleet.faults if fault.robot == "r_0"]
    assert fault.kind is Kind.OUTSIDE_FENCE
    assert "outside exclusion polygon 2" in str(fault)
    assert flight.states["r_0"].state == HOME


@pytest.mark.long(keep=2)
@KINDS
@pytest.mark.parametrize("action", [HOLDS, RETURNS, LANDS], ids=["hold", "return", "land"])
def test_a_fence_that_another_station_sends_in_flight_acts_and_is_told(action, kind):
    """It was not there when it was read: the autopilot reacts to the breach, and its drone is left to that."""
    fence = Geofence((Area(True, ((0.0, 0.0),), 30.0),), action=action, begins_s=4.0)
    flight = fly(Faults(), kind=kind, fences={"r_0": fence}, absent_s=5.0)
    said = " ".join(str(fault) for fault in flight.fleet.faults if fault.robot == "r_0")
    assert "fence" in said
    assert flight.wrongs == []
    assert flight.done == ALL  # by the other drone


@pytest.mark.long
@KINDS
def test_a_fence_is_read_over_a_link_that_loses_packets(kind):
    fence = Geofence((Area(True, ((0.0, 0.0),), 300.0), BESIDE))
    flight = fly({"r_0": Faults(loss=0.3), "r_1": Faults(loss=0.3)}, kind=kind, fences={"r_0": fence})
    assert {"t_0", "t_1"} <= flight.refused_by("r_0")
    assert flight.done == ALL


@KINDS
def test_a_fence_that_is_switched_off_refuses_nothing(kind):
    fence = Geofence((BESIDE,), is_on=False)
    flight = fly(Faults(), kind=kind, count=1, fences={"r_0": fence}, offboard=True)
    assert flight.done == ALL
    assert flight.refused_by("r_0") == set()


def test_px4_refuses_missions_outside_its_polygons_with_its_fence_off_too():
    flight = fly(Faults(), kind=PX4, fences={"r_0": Geofence((BESIDE,), is_on=False)})
    assert {"t_0", "t_1"} <= flight.refused_by("r_0")
    assert flight.fleet.faults == []
    assert flight.done == ALL


def test_a_drone_that_is_heard_late_is_asked_for_its_fence_before_its_first_order():
    """It was silent while the others were asked, as where an interrupted mission goes on."""
    there = mission(1, FAR)
    sky = Sky(there, PX4, {}, {"r_0": Geofence((BESIDE,))})
    fleet = sky.fleet(there)
    try:
        session = fleet.sessions["r_0"]
        session.drone.limits = OwnLimits()
        fleet.ports["r_0"].send([Waypoint((60.0, 0.0, 10.0))])
        while session.busy:
            fleet.advance(fleet.time_s + 0.1)
        assert "exclusion polygon 1" in fleet.ports["r_0"].telemetry().refused
        fleet.ports["r_0"].send([Waypoint((60.0, 40.0, 10.0))])
        fleet.advance(fleet.time_s + 5.0)
        assert sky.drones["r_0"].armed
    finally:
        fleet.close()
        sky.close()
