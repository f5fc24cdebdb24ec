"""Fleets of simulated autopilots: missions flown, every fault in its documented state, nothing sent unasked."""

import pytest
from tests.bridges.mavlink.drones import ORIGIN, Sky, flown, mission

import muster
from muster.bridges.mavlink import Kind, MavlinkFleet
from muster.bridges.mavlink.autopilots import ARDUPILOT, PX4
from muster.bridges.mavlink.dialect import Codec
from muster.bridges.mavlink.simulated_drone import Faults
from muster.mission.errors import NetworkError, ParameterError
from muster.mission.model import Map, Robot, Task, Zone
from muster.motion.port import Waypoint

KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)


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


@KINDS
def test_lost_packets_do_no_harm(kind):
    lossy = {f"r_{k}": Faults(loss=0.2, repeat_reached=True) for k in range(2)}
    report, fleet, _, _ = flown(mission(2), kind, lossy, link_lost_s=8)
    assert len(report.tasks_done) == 4
    assert fleet.faults == []


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
    fleet.go_back()
    fleet.land()
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
        events = fleet.advance(fleet.time_s + 5)
        assert [event.robot_fails for event in events] == ["r_0"]
        assert fleet.faults[0].kind is Kind.OUTSIDE_FENCE
        assert why in fleet.faults[0].detail
        assert not any(message.get_type().startswith("MISSION") for message in sky.drones["r_0"].heard)
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


@pytest.mark.parametrize("endpoint", ["", "udp:host", "udp:127.0.0.1:99999", "tcp:1.2.3.4:5", "serial:"])
def test_endpoints_that_are_none(endpoint):
    with pytest.raises(ParameterError, match="expected udp:HOST:PORT"):
        MavlinkFleet(mission(1), {"r_0": endpoint})
