"""Fleets of simulated autopilots: missions flown, every fault in its documented state, nothing sent unasked."""

from dataclasses import replace

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, Sky, flown, mission

import muster
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Map, Mission, Robot, Task, Zone
from muster.mission.plan import Plan, Route
from muster.motion.port import Waypoint
from muster.running.live import carry_out_live
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import Kind, MavlinkFleet
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.dialect import Codec
from muster_robots.mavlink.simulated.faults import Faults

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)


@pytest.mark.long(keep=1)
@KINDS
@pytest.mark.parametrize("offboard", [False, True])
def test_a_mission_is_flown(kind, offboard):
    report, fleet, sky, _ = flown(mission(2), kind, offboard=offboard)
    assert len(report.tasks_done) == 4
    assert fleet.faults == []
    for drone in sky.drones.values():
        assert drone.armed
        assert drone.flight.flies  # nothing lands by itself
    assert all(0 < row.usage_flown < 60 for row in report.robots)


@pytest.mark.long(keep=1)
@KINDS
def test_lost_packets_do_no_harm(kind):
    lossy = {f"r_{k}": Faults(loss=0.2, repeat_reached=True) for k in range(2)}
    report, fleet, _, _ = flown(mission(2), kind, lossy, link_lost_s=8)
    assert len(report.tasks_done) == 4
    assert fleet.faults == []


@pytest.mark.long(keep=1)
@KINDS
def test_nothing_is_sent_without_leave_to_arm(kind):
    there = mission(2)
    sky = Sky(there, kind)
    fleet = sky.fleet(there, arm=False)
    fleet.advance(fleet.time_s + 20)
    for port in fleet.ports.values():
        with pytest.raises(ParameterError, match="leave to arm"):
            port.send([Waypoint((5.0, 5.0, 5.0))])
        port.cancel()
    fleet.stop()
    fleet.end("return")
    fleet.end("land")
    fleet.close()
    sky.close()
    for robot, data in sky.bytes_in.items():
        heard = list(Codec().parse(data))
        assert sum(len(message.get_msgbuf()) for message in heard) == len(data) > 0
        names = {(m.get_type(), getattr(m, "command", None)) for m in heard}
        assert names == {("HEARTBEAT", None), ("COMMAND_LONG", 511)}, robot  # SET_MESSAGE_INTERVAL
        assert not sky.drones[robot].armed


def test_what_lies_outside_the_fence_is_never_uploaded():
    pytest.importorskip("shapely")
    fenced = Map(
        boundary=((-10.0, -10.0), (60.0, -10.0), (60.0, 60.0), (-10.0, 60.0)),
        zones=(Zone(polygon=((20.0, -5.0), (30.0, -5.0), (30.0, 30.0), (20.0, 30.0))),),
    )
    there = mission(1, (Task(id="t_0", position=(40.0, 0.0, 10.0)),), map=fenced)
    for place, why in (((40.0, 0.0, 10.0), "zone"), ((80.0, 40.0, 10.0), "boundary")):
        sky = Sky(there)
        fleet = sky.fleet(there)
        fleet.ports["r_0"].send([Waypoint(place)])
        assert fleet.advance(fleet.time_s + 5) == []
        assert why in fleet.ports["r_0"].telemetry().refused
        assert fleet.faults[0].kind is Kind.OUTSIDE_FENCE
        assert why in fleet.faults[0].detail
        assert "MISSION_COUNT" not in {message.get_type() for message in sky.drones["r_0"].heard}
        fleet.close()
        sky.close()
    report, fleet, _, _ = flown(there)  # around the zone
    assert report.tasks_done == ("t_0",)
    assert fleet.faults == []


def test_a_mission_in_the_plane_is_flown_at_a_height():
    robots = (Robot(id="r_0", position=(0.0, 0.0), kind="air", speed_mps=5.0),)
    there = muster.Mission(robots=robots, tasks=(Task(id="t", position=(20.0, 0.0)),), origin_wgs84=ORIGIN)
    report, _, sky, _ = flown(there, height_m=12.0)
    assert report.tasks_done == ("t",)
    assert sky.drones["r_0"].flight.place == pytest.approx((0.0, 20.0, -12.0), abs=0.05)


def test_without_an_origin_way_points_are_said_one_by_one():
    there = mission(1, origin_wgs84=None)
    with pytest.raises(ParameterError, match="no origin_wgs84; expected one"):
        MavlinkFleet(there, {"r_0": "udpout:127.0.0.1:9"})
    report, _, _, _ = flown(there, offboard=True)
    assert len(report.tasks_done) == 2


def test_without_a_compass_the_local_frame_begins_forward():
    """The drone looks north-west at power-up: 10 m east of its start is 7.07 m behind it, and as far to its right."""
    robot = Robot(id="r_0", position=(2.0, 3.0, 0.0), kind="air", speed_mps=5.0, heading_deg=135.0)
    there = Mission(robots=(robot,), tasks=(Task(id="t", position=(12.0, 3.0, 10.0)),))
    report, fleet, sky, _ = flown(there, offboard=True, local_frame="forward")
    assert report.tasks_done == ("t",)
    assert sky.drones["r_0"].flight.place == pytest.approx((-7.071, 7.071, -10.0), abs=0.2)
    assert fleet.ports["r_0"].telemetry().position == pytest.approx((12.0, 3.0, 10.0), abs=0.3)
    with pytest.raises(ParameterError, match="origin_wgs84; expected none with the local frame forward"):
        MavlinkFleet(mission(1), {"r_0": "udpout:127.0.0.1:9"}, FlightSettings(offboard=True, local_frame="forward"))


def test_what_does_not_answer_or_is_unknown_or_elsewhere_is_said_in_a_line():
    there = mission(1)
    sky = Sky(there)
    sky.drones["r_0"].faults = Faults(loss=1.0)
    with pytest.raises(NetworkError, match="r_0: no heartbeat within 5 s; expected"):
        sky.fleet(there)
    sky.close()
    sky = Sky(there, autopilot_field=0)
    with pytest.raises(ParameterError, match="r_0: autopilot MAV_AUTOPILOT_GENERIC; expected PX4 or ArduPilot"):
        sky.fleet(there)
    sky.close()
    sky = Sky(there)
    sky.drones["r_0"].flight.place = (500.0, 0.0, 0.0)
    with pytest.raises(ParameterError, match=r"r_0: stands 500.0 m from its start"):
        sky.fleet(there)
    sky.close()


@pytest.mark.parametrize("endpoint", ["", "udp:host", "udp:127.0.0.1:99999", "tcp:1.2.3.4", "serial:"])
def test_endpoints_that_are_none(endpoint):
    with pytest.raises(ParameterError, match="expected udp:HOST:PORT"):
        MavlinkFleet(mission(1), {"r_0": endpoint})


@pytest.mark.long(keep=8)
@KINDS
@pytest.mark.parametrize("offboard", [False, True])
@pytest.mark.parametrize("after_s", [0.1, 1.5, 3.0, 4.5, 6.0, 7.5])
def test_whenever_it_is_stopped_it_hovers_or_stands_disarmed(kind, offboard, after_s):
    """With a drone that takes two seconds to arm: before, while, between arming and the start, while it climbs."""
    there = mission(1, (Task(id="t", position=(60.0, 0.0, 10.0)),))
    sky = Sky(there, kind, {"r_0": Faults(slow_arm_s=2.0)})
    fleet = sky.fleet(there, offboard=offboard)
    drone = sky.drones["r_0"]
    fleet.ports["r_0"].send([Waypoint((60.0, 0.0, 10.0))])
    fleet.advance(fleet.time_s + after_s)
    fleet.stop()
    fleet.close()
    place = drone.flight.place
    for _ in range(1000):  # nobody speaks to it any more
        sky.wait(0.02)
    sky.close()
    assert fleet.faults == []
    assert drone.flight.place == pytest.approx(place, abs=1e-6)
    assert (drone.armed, drone.mode) == (True, kind.hold) if drone.flight.flies else not drone.armed


@pytest.mark.long
def test_a_drone_with_too_little_in_its_battery_for_its_way_is_planned_for_again():
    there = mission(2, (Task(id="near", position=(20.0, 0.0, 10.0)), Task(id="far", position=(150.0, 6.0, 10.0))))
    there = replace(there, robots=tuple(replace(robot, work_capacity=400.0) for robot in there.robots))
    plan = Plan(allocator="by hand", routes=(Route("r_0", ("near",)), Route("r_1", ("far",))))
    sky, heard = Sky(there), []
    sky.drones["r_1"].battery = 0.3  # of 400 m: 120 m
    fleet = sky.fleet(there)
    report = carry_out_live(there, plan, fleet, on_event=heard.append)
    fleet.close()
    sky.close()
    assert {task.task: task.robot for task in report.tasks} == {"near": "r_1", "far": "r_0"}
    (refused,) = [event.data for event in heard if event.kind == "task_refused"]
    assert (refused["task"], refused["robot"]) == ("far", "r_1")
    assert refused["reason"].startswith("capacity: ")
    assert fleet.faults == []
