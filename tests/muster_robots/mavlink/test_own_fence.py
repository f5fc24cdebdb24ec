"""The autopilot's own fence: how its items are read, message by message, and which places and legs it refuses."""

import random
import re

import pytest
from tests.muster_robots.mavlink.drones import ORIGIN, Sky, mission
from tests.muster_robots.mavlink.talk import M, from_drone

import muster
from muster.execution.robots.task_motion import straight
from muster.mission.errors import ParameterError
from muster_robots.fleet_settings import FlightSettings
from muster_robots.mavlink import MavlinkFleet
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.frames import GlobalFrame
from muster_robots.mavlink.own_fence import FenceUnreadError, fence_of, read_fence
from muster_robots.mavlink.own_limits import has_fence_on
from muster_robots.mavlink.requests import RequestSequence
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated.geofence import Area, Geofence

FRAME = GlobalFrame(ORIGIN, (0.0, 0.0, 0.0))
INSIDE, OUTSIDE = True, False
SQUARE = ((-10.0, -10.0), (50.0, -10.0), (50.0, 50.0), (-10.0, 50.0))
L_SHAPE = ((-10.0, -10.0), (80.0, -10.0), (80.0, 20.0), (20.0, 20.0), (20.0, 80.0), (-10.0, 80.0))
"""Concave: two arms, to the east and to the north, and between their ends is outside."""


def items_of(*areas, **more):
    """The items of a fence as a simulated autopilot tells them; its home is at the origin of the map."""
    fence, said = Geofence(areas, **more), []
    for seq in range(sum(len(area.corners) for area in areas) + fence.return_point):
        asked = from_drone(M.MAVLink_mission_request_int_message(1, 1, seq, M.MAV_MISSION_TYPE_FENCE))
        ((name, values),) = fence.reply(asked, ORIGIN, 0)
        assert name == "mission_item_int"
        said.append(M.MAVLink_mission_item_int_message(*values))
    return said


def fence(*areas, is_union=False):
    return fence_of(items_of(*areas), FRAME.to_map, is_union=is_union)


def at(*pairs):
    return [(x, y, 10.0) for x, y in pairs]


@pytest.mark.parametrize(
    "areas",
    [
        (Area(INSIDE, SQUARE),),
        (Area(OUTSIDE, SQUARE),),
        (Area(INSIDE, L_SHAPE),),
        (Area(OUTSIDE, L_SHAPE),),
        (Area(INSIDE, ((5.0, 8.0),), 30.0),),
        (Area(OUTSIDE, ((5.0, 8.0),), 30.0),),
        (Area(INSIDE, L_SHAPE), Area(OUTSIDE, ((5.0, 40.0),), 6.0), Area(INSIDE, ((0.0, 0.0),), 60.0)),
    ],
    ids=["square", "around a square", "concave", "around one", "circle", "around a circle", "three"],
)
def test_places_are_judged_as_the_autopilot_judges_them(areas):
    """The bridge's frames and geometry against the simulator's, which share no code; edges are left out."""
    draw, judged, refused = random.Random(7), fence(*areas), 0
    for _ in range(300):
        x, y = draw.uniform(-60, 100), draw.uniform(-60, 100)
        around = [(x + dx, y + dy) for dx in (-0.05, 0.0, 0.05) for dy in (-0.05, 0.0, 0.05)]
        verdicts = {Geofence(areas).is_left_at((north, east, 0.0), 0.0) for east, north in around}
        if len(verdicts) == 1:
            assert bool(judged.refusal(at((x, y)))) == verdicts.pop(), (x, y)
            refused += bool(judged.refusal(at((x, y))))
    assert 10 < refused < 290


def test_a_leg_that_leaves_a_concave_inclusion_is_refused_although_both_ends_are_inside():
    concave = fence(Area(INSIDE, L_SHAPE))
    assert concave.refusal(at((70, 0))) == concave.refusal(at((0, 70))) == ""
    why = concave.refusal(at((0, 70)), here=(70.0, 0.0, 10.0))
    assert why == (
        "straight from (70.00, 0.00) to (0.00, 70.00); "
        "expected a way inside inclusion polygon 1 of the autopilot's fence"
    )
    assert concave.refusal(at((70, 0), (0, 70))) == why
    assert concave.refusal(at((70, 0), (0, 0), (0, 70)), here=(0.0, 0.0, 0.0)) == ""


@pytest.mark.parametrize("area", [Area(OUTSIDE, ((30.0, 0.0),), 5.0), Area(OUTSIDE, ((25, -9), (35, -9), (30, 4)))])
def test_a_leg_through_an_exclusion_is_refused_and_one_beside_it_is_not(area):
    kind = "circle" if area.radius_m else "polygon"
    passed = fence(area)
    assert f"expected a way outside exclusion {kind} 1" in passed.refusal(at((60, 0)), here=(0.0, 0.0, 0.0))
    assert passed.refusal(at((60, 20)), here=(0.0, 20.0, 0.0)) == ""
    assert passed.refusal(at((0, 0)), here=(0.0, 0.0, 0.0)) == ""  # straight up


def test_several_inclusions_count_together_unless_the_autopilot_takes_their_union():
    apart = Area(INSIDE, SQUARE), Area(INSIDE, ((60.0, 0.0),), 20.0)  # they overlap in a narrow strip
    assert "inclusion circle 2" in fence(*apart).refusal(at((0, 0)))
    assert "inclusion polygon 1" in fence(*apart).refusal(at((60, 0)))
    assert fence(*apart).refusal(at((45, 0))) == ""
    union = fence(*apart, is_union=True)
    assert union.refusal(at((0, 0), (60, 0))) == ""
    assert "one of the inclusions" in union.refusal(at((60, 40)))


def test_a_return_point_limits_nothing():
    told = items_of(Area(INSIDE, SQUARE), return_point=True)
    assert told[0].command == M.MAV_CMD_NAV_FENCE_RETURN_POINT
    assert [area.name for area in fence_of(told, FRAME.to_map).areas] == ["inclusion polygon 1"]


def change(index, **fields):
    told = items_of(Area(INSIDE, SQUARE), Area(OUTSIDE, ((0.0, 0.0),), 3.0))
    for name, value in fields.items():
        setattr(told[index], name, value)
    return told


@pytest.mark.parametrize(
    ("told", "why"),
    [
        (change(2, command=M.MAV_CMD_NAV_WAYPOINT), "item 0: a polygon of 4 corners, of which some are missing"),
        (change(4, command=5010), "item 4: 5010"),
        (change(1, param1=5.0), "item 0: a polygon of 4 corners"),
        (change(0, param1=2.0), "item 0: a polygon of 2 corners"),
        (change(0, param1=float("nan")), "item 0: a polygon of nan corners"),
        (change(4, param1=0.0), "item 4: a circle of 0 m"),
        (change(3, frame=M.MAV_FRAME_LOCAL_NED), "item 0: MAV_FRAME"),
        (items_of(Area(INSIDE, SQUARE))[:3], "item 0: a polygon of 4 corners, of which some are missing"),
        (items_of(Area(INSIDE, ((0, 0), (5, 5), (10, 10)))), "item 0: an area of nothing"),
    ],
)
def test_an_item_that_is_not_understood_is_named(told, why):
    with pytest.raises(FenceUnreadError, match=re.escape(why)):
        fence_of(told, FRAME.to_map)


def test_a_fence_in_degrees_needs_a_mission_with_an_origin():
    with pytest.raises(FenceUnreadError, match="no origin_wgs84"):
        fence_of(items_of(Area(INSIDE, SQUARE)), None)


@pytest.mark.parametrize(
    ("kind", "values", "offboard", "is_on"),
    [
        (PX4, {}, False, None),
        (PX4, {"GF_ACTION": 2}, False, True),
        (PX4, {"GF_ACTION": 0}, False, None),  # a mission is refused all the same
        (PX4, {"GF_ACTION": 0}, True, False),
        (ARDUPILOT, {}, False, None),
        (ARDUPILOT, {"FENCE_ENABLE": 1}, False, None),
        (ARDUPILOT, {"FENCE_ENABLE": 1, "FENCE_TYPE": 7}, False, True),
        (ARDUPILOT, {"FENCE_ENABLE": 1, "FENCE_TYPE": 3}, False, False),
        (ARDUPILOT, {"FENCE_ENABLE": 0, "FENCE_TYPE": 7}, False, False),
        (ARDUPILOT, {"FENCE_ENABLE": 0, "FENCE_AUTOENABLE": 3, "FENCE_TYPE": 7}, False, True),
    ],
)
def test_the_parameters_say_whether_the_fence_is_on(kind, values, offboard, is_on):
    assert has_fence_on(kind, values, offboard=offboard) is is_on


def downloaded(fence, loss=0.0, seed=1):
    """Read a fence over a link that loses messages both ways; the items, why there are none, and what was said last."""
    draw, items, said, replies = random.Random(seed), [], [], []
    heartbeat = from_drone(M.MAVLink_heartbeat_message(2, 12, 0, 0, 4, 3))
    requests = 0
    result = []

    def script():
        result.append((yield from read_fence(heartbeat, items)))

    now, sequence = 0.0, None

    def say(message):
        nonlocal requests
        said.append(message)
        if message.get_type() != "MISSION_ACK" and draw.random() >= loss:
            message._header.srcSystem, message._header.srcComponent = 255, 190
            for name, values in fence.reply(message, ORIGIN, requests):
                replies.append(getattr(M, f"MAVLink_{name}_message")(*values))
            requests += 1

    sequence = RequestSequence(script(), say, now)
    while not sequence.done:
        taken, replies[:] = replies[:], []
        for message in taken:
            if draw.random() >= loss:
                sequence.hear(message, now)
        now += 0.1
        sequence.tick(now)
    return items, result[0], said


FENCE = Geofence((Area(INSIDE, L_SHAPE), Area(OUTSIDE, ((5.0, 40.0),), 6.0)), return_point=True)


@pytest.mark.parametrize("seed", range(5))
def test_items_that_are_lost_are_asked_for_again(seed):
    items, why, said = downloaded(FENCE, loss=0.4, seed=seed)
    assert why == ""
    assert [item.seq for item in items] == list(range(8))
    assert len(said) > 10
    assert [item.to_dict() for item in items] == [item.to_dict() for item in downloaded(FENCE)[0]]


def test_a_download_ends_with_an_acknowledgement():
    _, _, said = downloaded(FENCE)
    names = ["MISSION_REQUEST_LIST", *["MISSION_REQUEST_INT"] * 8, "MISSION_ACK"]
    assert [message.get_type() for message in said] == names
    assert {message.mission_type for message in said} == {M.MAV_MISSION_TYPE_FENCE}


def test_reading_begins_anew_while_another_station_sends_a_fence():
    items, why, said = downloaded(Geofence(FENCE.areas, denied=2))
    assert (len(items), why) == (7, "")
    assert [message.get_type() for message in said].count("MISSION_REQUEST_LIST") == 3
    with pytest.raises(FenceUnreadError, match="MAV_MISSION_DENIED"):
        downloaded(Geofence(FENCE.areas, denied=99))


@pytest.mark.parametrize(
    ("fence", "why"),
    [
        (Geofence(), ""),
        (Geofence(answers="unsupported"), "it answers MAV_MISSION_UNSUPPORTED"),
        (Geofence(answers="silent"), "it does not answer MISSION_REQUEST_LIST of a fence"),
    ],
    ids=["none", "unsupported", "silent"],
)
def test_an_autopilot_without_a_fence_says_so_in_its_way(fence, why):
    assert downloaded(fence)[:2] == ([], why)


def connected(fence, kind=PX4, faults=None, **settings):
    there = mission()
    sky = Sky(there, kind, {"r_0": faults or Faults()}, {"r_0": fence})
    try:
        fleet = sky.fleet(there, **settings)
        fleet.close()
        return fleet.sessions["r_0"].drone.limits, sky.drones["r_0"]
    finally:
        sky.close()


KINDS = pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)


@KINDS
@pytest.mark.parametrize(
    ("fence", "why"),
    [
        (Geofence(FENCE.areas, untold=3), "item 3 of 7 was not told"),
        (Geofence(FENCE.areas, answers="silent"), "it does not answer MISSION_REQUEST_LIST of a fence"),
        (Geofence(FENCE.areas, denied=99), "MAV_MISSION_DENIED"),
    ],
    ids=["an item is missing", "silent", "denied"],
)
def test_a_fence_that_is_on_and_is_not_read_to_its_end_refuses_the_start(fence, why, kind):
    with pytest.raises(ParameterError) as refused:
        connected(fence, kind)
    head = "r_0: the fence of its autopilot is on and was not read to its end: "
    assert str(refused.value) == f"{head}{why}; expected all of it before a flight, or the fence off"


@KINDS
def test_a_fence_that_may_be_on_counts_if_it_has_items(kind):
    """No parameter is told: the items are read, and one that is missing refuses the start all the same."""
    limits, _ = connected(Geofence(FENCE.areas), kind, Faults(mute_parameters=True))
    assert len(limits.fence.areas) == 2
    with pytest.raises(ParameterError, match="item 3 of 7"):
        connected(Geofence(FENCE.areas, untold=3), kind, Faults(mute_parameters=True))


@KINDS
@pytest.mark.parametrize("answers", ["unsupported", "silent"])
def test_an_autopilot_that_does_not_know_fences_is_told_of_and_flies(answers, kind, caplog):
    limits, _ = connected(Geofence(answers=answers), kind, Faults(mute_parameters=True))
    assert limits.unread == ""
    assert [record.getMessage() for record in caplog.records] == [
        f"r_0: no polygons and circles of its autopilot's fence are checked: {limits.note}"
    ]


def test_a_fence_that_is_off_is_not_asked_for():
    off = Geofence(FENCE.areas, is_on=False, untold=0)
    for kind, settings in ((ARDUPILOT, {}), (PX4, {"offboard": True})):
        limits, drone = connected(off, kind, **settings)
        assert limits.fence.areas == ()
        assert "MISSION_REQUEST_LIST" not in {message.get_type() for message in drone.heard}


def test_nothing_is_asked_without_leave_to_arm():
    _, drone = connected(Geofence(FENCE.areas), arm=False)
    assert {message.get_type() for message in drone.heard} <= {"HEARTBEAT", "COMMAND_LONG"}


def test_where_a_mission_goes_on_a_fence_that_was_not_read_refuses_all_tasks_of_its_drone():
    """Its drone may be in the air: it is heard and brought home, and flies nothing else."""
    there = mission(2)
    sky = Sky(there, PX4, {}, {"r_0": Geofence(FENCE.areas, untold=3)})
    fleet = MavlinkFleet(there, sky.endpoints, FlightSettings(arm=True), clock=sky.clock, wait=sky.wait)
    try:
        fleet.connect(5.0, again=True)
        refused = list(fleet.refusals(there, muster.solve(there, iterations=50), straight))
        assert {(robot, task) for robot, task, _ in refused} == {("r_0", task.id) for task in there.tasks}
        assert all("was not read to its end: item 3 of 7 was not told" in why for _, _, why in refused)
    finally:
        fleet.close()
        sky.close()
