"""Plan files of QGroundControl as others make them: what bears on safety is read or refused, nothing else is lost."""

import copy
import json
import math
from pathlib import Path

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.qgc.test_survey_reading import SURVEY
from tests.raw_counts import raw_count

import muster
from muster.mission.errors import MissionError
from muster.planning.loading import load_noted
from muster_files.qgc.commands import NAMES, PASSED_OVER, READ

CASES = Path(__file__).parents[2] / "data" / "cases" / "import"
HOME = [59.91, 10.75, 20]
FIRST, SECOND, THIRD = [59.911, 10.751, 20], [59.912, 10.752, 20], [59.913, 10.753, 20]


def item(command, place=(0, 0, 0), *params, frame=3):
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": frame,
        "autoContinue": True,
        "params": [*params, *[0] * (4 - len(params)), *place],
    }


def plan(*items, **mission):
    numbered = [one | ({"doJumpId": k} if one["type"] == "SimpleItem" else {}) for k, one in enumerate(items, 1)]
    head = {"version": 2, "vehicleType": 2, "hoverSpeed": 5, "cruiseSpeed": 15, "plannedHomePosition": HOME}
    return {"fileType": "Plan", "version": 1, "mission": head | mission | {"items": numbered}}


def read(folder, data, name="x"):
    file = folder / f"{name}.plan"
    file.write_text(json.dumps(data), encoding="utf-8")
    return load_noted(file)


def places(mission):
    return {task.id: tuple(round(c) for c in task.position) for task in mission.tasks}


@pytest.mark.parametrize(("stated", "alt_m", "height_m"), [((59.911, 10.751), 20, 20), ((59.911, 10.751, 10), 10, 30)])
def test_a_stated_origin_holds_for_flights_too(stated, alt_m, height_m, tmp_path):
    file = tmp_path / "x.plan"
    file.write_text(json.dumps(plan(item(22), item(16, FIRST))), encoding="utf-8")
    robots = tmp_path / "robots.csv"
    robots.write_text("id,lat,lon,kind\nr,59.911,10.751,air\n", encoding="utf-8")
    mission = muster.read_site(file, robots, origin=stated).mission
    assert mission.origin_wgs84.alt_m == alt_m
    positions = {one.id: one.position for one in (*mission.robots, *mission.tasks)}
    assert positions["r"][:2] == pytest.approx((0, 0), abs=1e-6)
    assert positions["x-2"] == pytest.approx((0, 0, height_m), abs=1e-6)
    assert positions["x"] == pytest.approx((-56, -111.4, height_m - 20), abs=0.1)


def lost(found):
    return {row.kind: row.said for row in found.ledger.rows if row.how == "passed over"}


def refusal(folder, data):
    with pytest.raises(MissionError) as error:
        read(folder, data)
    assert "\n" not in str(error.value)
    assert str(error.value).startswith(f"{folder / 'x.plan'}: ")
    return str(error.value)


# Where


def test_landing_at_zero_zero_ends_above_the_last_way_point():
    mission = muster.load(CASES / "land-zero.plan")
    assert mission.robots[0].end_position is None
    assert max(map(math.hypot, *zip(*(task.position[:2] for task in mission.tasks), strict=True))) < 200
    plan_of = muster.solve(mission, iterations=50, seed=1)
    assert muster.verify(mission, plan_of).valid


@pytest.mark.parametrize("nowhere", [(0, 0), (None, None)])
@pytest.mark.parametrize("command", [16, 19])
def test_a_way_point_at_zero_zero_is_where_the_one_before_is(command, nowhere, tmp_path):
    found = read(tmp_path, plan(item(22), item(16, FIRST), item(command, (*nowhere, 35), 9), item(20)))
    assert places(found.mission) == {"x-2": (56, 111, 20), "x-3": (56, 111, 35)}
    assert found.mission.tasks[1].duration_s == 9


def test_the_first_way_point_at_zero_zero_is_above_home(tmp_path):
    assert places(read(tmp_path, plan(item(22), item(16, (0, 0, 30)), item(20))).mission) == {"x-2": (0, 0, 30)}


@pytest.mark.parametrize(
    "data",
    [
        plan(item(16, [35.0, 24.0, 20])),
        plan(item(16, FIRST), item(21, [0, 10.75, 0])),
        plan(item(16, [0.0, 1e-9, 20])),
        plan(item(16, FIRST), plannedHomePosition=[0, 0, 0]),
    ],
)
def test_a_place_beyond_reason_is_refused(data, tmp_path):
    assert "expected within 100 km of the planned home, not " in refusal(tmp_path, data)


def test_homes_of_several_files_are_near_each_other(tmp_path):
    read(tmp_path, plan(item(16, FIRST)), "a")
    (tmp_path / "b.plan").write_text(
        json.dumps(plan(item(16, [35.0, 24.0, 9]), plannedHomePosition=[35, 24, 0])), encoding="utf-8"
    )
    with pytest.raises(MissionError, match=r"b.plan: mission.plannedHomePosition: .* within 100 km"):
        load_noted(tmp_path)


def test_a_landing_on_the_way_is_refused(tmp_path):
    told = refusal(tmp_path, plan(item(16, FIRST), item(21, SECOND), item(22), item(16, THIRD)))
    assert "mission.items[1].command: MAV_CMD_NAV_LAND (21); expected it after the last way point" in told


# How fast, how long


def test_a_rover_goes_at_its_cruising_speed():
    (robot,) = muster.load(CASES / "rover-speed.plan").robots
    assert (robot.kind, robot.speed_mps) == ("ground", 2)


@pytest.mark.parametrize(
    ("vehicle", "kind", "speed"),
    [
        (1, "air", 15),
        (2, "air", 5),
        (13, "air", 5),
        (4, "air", 5),
        (20, "air", 5),
        (10, "ground", 15),
        (11, "ground", 15),
    ],
)
def test_each_vehicle_has_its_own_speed(vehicle, kind, speed, tmp_path):
    found = read(tmp_path, plan(item(16, FIRST), vehicleType=vehicle))
    (robot,) = found.mission.robots
    assert (robot.kind, robot.speed_mps) == (kind, speed)
    assert any("fixed wing" in note or "VTOL" in note for note in found.notes) == (vehicle in (1, 20))


@pytest.mark.parametrize("vehicle", [12, 5, 6, 7, 8, 9, 99, "quad", True])
def test_a_vehicle_of_another_kind_is_refused(vehicle, tmp_path):
    told = refusal(tmp_path, plan(item(16, FIRST), vehicleType=vehicle))
    assert "mission.vehicleType: " in told
    assert ("MAV_TYPE_SUBMARINE (12)" in told) == (vehicle == 12)


@pytest.mark.parametrize(
    ("items", "speed"),
    [
        ((item(178, (0, 0, 0), 1, 3), item(16, FIRST)), 3),
        ((item(178, (0, 0, 0), 1, 3), item(16, FIRST), item(178, (0, 0, 0), 1, 8), item(16, SECOND)), 3),
        ((item(16, FIRST), item(178, (0, 0, 0), 0, 2), item(16, SECOND)), 2),
        ((item(16, FIRST), item(178, (0, 0, 0), 1, 9), item(16, SECOND)), 5),
        ((item(178, (0, 0, 0), 1, -1, -1), item(16, FIRST)), 5),
        (
            (copy.deepcopy(SURVEY) | {"polygon": [FIRST[:2], SECOND[:2], [59.912, 10.75]]}, item(178, (0, 0, 0), 1, 9)),
            5,
        ),
    ],
)
def test_the_slowest_speed_of_a_flight_is_taken(items, speed, tmp_path):
    if "TransectStyleComplexItem" in items[0]:
        items[0]["TransectStyleComplexItem"]["VisualTransectPoints"] = [FIRST[:2], SECOND[:2]]
    found = read(tmp_path, plan(*items))
    assert found.mission.robots[0].speed_mps == speed
    several = len({5, *(one["params"][1] for one in items if one.get("command") == 178)}) > 1
    assert several or not any("slowest" in note for note in found.notes)


def test_speeds_of_climb_and_descent_are_read(tmp_path):
    data = plan(item(178, (0, 0, 0), 2, 3), item(178, (0, 0, 0), 3, 1.5), item(16, FIRST))
    (robot,) = read(tmp_path, data).mission.robots
    assert (robot.speed_mps, robot.climb_mps) == (5, 1.5)


@pytest.mark.parametrize(
    ("params", "said"),
    [
        ((7, 3), "params[0]: 7; expected one of 0, 1, 2, 3 (DO_CHANGE_SPEED kind of speed)"),
        ((1, 0), "params[1]: 0; expected metres a second above 0"),
        ((1, -1, 60), "params[2]: 60; expected -1: a speed in metres a second, not a throttle"),
        ((1, 3, 60), "params[2]: 60; expected -1: a speed"),
        ((1, 3, -1, 1), "params[3]: 1; expected 0: speeds in m/s"),
    ],
)
def test_a_speed_that_is_none_is_refused(params, said, tmp_path):
    assert said in refusal(tmp_path, plan(item(178, (0, 0, 0), *params), item(16, FIRST)))


def test_delays_are_added_to_the_hold_before_them(tmp_path):
    found = read(tmp_path, plan(item(16, FIRST, 4), item(93, (0, 0, 0), 10), item(112, (0, 0, 0), 7), item(16, SECOND)))
    assert [task.duration_s for task in found.mission.tasks] == [14, None]
    assert lost(found)["CONDITION_DELAY"] == "waits before a command, and not before the next way point"
    assert "expected a way point before the delay" in refusal(tmp_path, plan(item(93, (0, 0, 0), 10), item(16, FIRST)))
    assert "times of day are not read" in refusal(tmp_path, plan(item(16, FIRST), item(93, (0, 0, 0), -1, 12)))


# Jumps


def test_a_jump_is_three_more_rounds_one_after_the_other():
    mission = muster.load(CASES / "jump.plan")
    assert [task.id for task in mission.tasks] == [
        *("jump-2", "jump-3", "jump-2.2", "jump-3.2", "jump-2.3", "jump-3.3", "jump-2.4", "jump-3.4", "jump-5")
    ]
    by_id = {task.id: task for task in mission.tasks}
    assert by_id["jump-3.4"].position == by_id["jump-3"].position
    assert set(by_id["jump-2.3"].prerequisites) == {"jump-2.2", "jump-3.2"}
    assert by_id["jump-5"].prerequisites == ()


@pytest.mark.parametrize(("to", "times"), [(1, 0), (2, 1)])
def test_a_jump_to_an_earlier_item_repeats_what_is_between(to, times, tmp_path):
    found = read(tmp_path, plan(item(16, FIRST), item(16, SECOND), item(177, (0, 0, 0), to, times), item(16, THIRD)))
    assert len(found.mission.tasks) == 3 + times * (3 - to)


def test_two_jumps_after_each_other_are_two_loops(tmp_path):
    jump = item(177, (0, 0, 0), 1, 1)
    again = item(177, (0, 0, 0), 3, 2)
    mission = read(tmp_path, plan(item(16, FIRST), jump, item(16, SECOND), again)).mission
    assert [task.id for task in mission.tasks] == ["x-1", "x-1.2", "x-3", "x-3.2", "x-3.3"]


@pytest.mark.parametrize(
    ("items", "said"),
    [
        ((item(16, FIRST), item(177, (0, 0, 0), 1, -1)), "params[1]: -1; expected a jump to an item before it"),
        ((item(177, (0, 0, 0), 2, 1), item(16, FIRST)), "params[0]: 2; expected a jump to an item before it"),
        ((item(16, FIRST), item(177, (0, 0, 0), 9, 1)), "params[0]: 9; expected a jump"),
        ((item(16, FIRST), item(177, (0, 0, 0), 1.5, 1)), "params[0]: 1.5; expected a jump"),
        ((item(16, FIRST), item(177, (0, 0, 0), None, 1)), "params[0]: missing; expected a jump"),
        ((item(16, FIRST), item(177, (0, 0, 0), 1, 1e6)), "expected at most 5,000 stops in all"),
        (
            (item(16, FIRST), item(177, (0, 0, 0), 1, 1), item(16, SECOND), item(177, (0, 0, 0), 1, 1)),
            "items[1].params[0]: 1; expected a jump that no other jump repeats",
        ),
    ],
)
def test_a_jump_that_cannot_be_unrolled_is_refused(items, said, tmp_path):
    assert said in refusal(tmp_path, plan(*items))


# Commands


def test_photos_and_regions_of_interest_are_named():
    found = load_noted(CASES / "roi.plan")
    assert lost(found)["DO_SET_ROI_LOCATION"].startswith("is for a camera")
    told = next(line for line in found.said if "DO_SET_ROI_LOCATION" in line)
    assert "IMAGE_START_CAPTURE" in told
    assert "DO_SET_CAM_TRIGG_DIST" in told


@pytest.mark.parametrize("command", sorted({*NAMES, 9999} - {*READ}))
def test_each_other_command_is_named_or_refused_by_name(command, tmp_path):
    data = plan(item(16, FIRST), item(command, THIRD, 1, 2, 3, 4))
    if command in PASSED_OVER:
        found = read(tmp_path, data)
        assert len(found.mission.tasks) == 1
        assert NAMES[command] in lost(found)
        assert any(NAMES[command] in line for line in found.said)
    else:
        name = f"MAV_CMD_{NAMES[command]} ({command})" if command in NAMES else "9999, a MAV_CMD without a name here"
        assert f"mission.items[1].command: {name}; expected one of NAV_WAYPOINT" in refusal(tmp_path, data)


def test_an_older_item_has_its_place_apart(tmp_path):
    old = item(16, FIRST, 4) | {"coordinate": FIRST}
    old["params"] = old["params"][:4]
    found = read(tmp_path, plan(old, item(16, SECOND) | {"coordinate": SECOND}))
    assert places(found.mission) == {"x-1": (56, 111, 20), "x-2": (112, 223, 20)}
    assert raw_count(tmp_path / "x.plan") == sum(row.count for row in found.ledger.rows)
    told = refusal(tmp_path, plan(item(16, FIRST) | {"coordinate": SECOND}))
    assert "mission.items[0].coordinate: " in told


def test_a_file_of_a_fence_alone_is_a_robot_without_tasks(tmp_path):
    mission = read(tmp_path, plan() | {"geoFence": {"version": 2, "polygons": [fence_polygon()]}}).mission
    assert (len(mission.robots), mission.tasks, len(mission.map.boundary)) == (1, (), 4)


def test_an_item_that_waits_for_a_pilot_is_refused(tmp_path):
    data = plan(item(16, FIRST) | {"autoContinue": False})
    assert "mission.items[0].autoContinue: false; expected true: no wait for a pilot" in refusal(tmp_path, data)


@pytest.mark.parametrize(
    "change",
    [
        lambda p: p.update(version=42),
        lambda p: p["mission"].update(version=42),
        lambda p: p["geoFence"].update(version=42),
        lambda p: p["geoFence"]["polygons"][0].update(version=42),
        lambda p: p["geoFence"]["circles"][0].update(version=42),
        lambda p: p["rallyPoints"].update(version=42),
        lambda p: p["mission"]["items"][1].update(version=42),
        lambda p: p["mission"]["items"][1]["TransectStyleComplexItem"].update(version=42),
        lambda p: p["mission"]["items"][1]["TransectStyleComplexItem"]["CameraCalc"].update(version=42),
    ],
)
def test_a_part_of_a_version_that_is_not_known_is_refused(change, tmp_path):
    survey = copy.deepcopy(SURVEY) | {"polygon": [FIRST[:2], SECOND[:2], [59.912, 10.75]]}
    survey["TransectStyleComplexItem"]["VisualTransectPoints"] = []
    data = plan(item(16, FIRST), survey)
    data["geoFence"] = {"version": 2, "polygons": [fence_polygon()], "circles": [fence_circle(False, FIRST)]}
    data["rallyPoints"] = {"version": 2, "points": []}
    read(tmp_path, data)
    change(data)
    assert "version: 42; expected " in refusal(tmp_path, data)


def test_rally_points_are_named(tmp_path):
    data = plan(item(16, FIRST)) | {"rallyPoints": {"version": 2, "points": [FIRST]}}
    assert lost(read(tmp_path, data))["rallyPoints.points"].startswith("is a point to go to in an emergency")


# Fences

RING = [[59.909, 10.749], [59.909, 10.756], [59.914, 10.756], [59.914, 10.749]]


def fence_polygon(inclusion=True, ring=RING):
    return {"version": 1, "inclusion": inclusion, "polygon": ring}


def fence_circle(inclusion, center, radius=30):
    return {"version": 1, "inclusion": inclusion, "circle": {"center": center[:2], "radius": radius}}


def test_the_ring_of_an_old_fence_is_the_boundary():
    mission = muster.load(CASES / "fence-v1.plan")
    assert len(mission.map.boundary) == 4
    assert max(x for x, _ in mission.map.boundary) == pytest.approx(280, abs=1)
    assert mission.map.zones == ()


@pytest.mark.parametrize(
    ("fence", "said"),
    [
        ({"version": 1, "polygon": RING, "breachReturn": FIRST}, "geoFence.breachReturn: "),
        ({"version": 1, "polygon": RING[:2]}, "geoFence.polygon: "),
        ({"version": 1, "polygon": 3}, "geoFence.polygon: 3; expected a list of corners"),
        (
            {"version": 2, "polygons": [fence_polygon() | {"floor": 3}]},
            "geoFence.polygons[0].floor: 3; expected no more",
        ),
        ({"version": 2, "heights": [3]}, "geoFence.heights: "),
        ({"version": 2, "polygons": {"a": 1}}, "geoFence.polygons: "),
        ({"version": 2, "circles": [fence_circle(False, FIRST, 0)]}, "geoFence.circles[0].circle.radius: 0; expected"),
        ({"version": 2, "circles": [fence_circle(False, [35, 24])]}, "geoFence.circles[0].circle.center: latitude 35"),
        ({"version": 2, "polygons": [fence_polygon(), fence_polygon()]}, "not the mission's boundary"),
    ],
)
def test_a_fence_that_is_not_wholly_read_is_refused(fence, said, tmp_path):
    assert said in refusal(tmp_path, plan(item(16, FIRST)) | {"geoFence": fence})


def test_a_fence_that_excludes_alone_closes_its_zones():
    found = load_noted(CASES / "exclusion-only.plan")
    (zone,) = found.mission.map.zones
    assert zone.forbidden_to == ("air",)
    inside = shapely.Polygon(found.mission.map.boundary)
    assert all(inside.contains(shapely.Point(task.position[:2])) for task in found.mission.tasks)
    assert any("a rectangle 50 m around everything" in note for note in found.notes)


@pytest.mark.parametrize("inclusion", [True, False])
def test_a_circle_is_never_smaller_where_it_is_closed_nor_larger_where_it_is_open(inclusion, tmp_path):
    circle = fence_circle(inclusion, SECOND, 200)
    chart = read(tmp_path, plan(item(16, FIRST)) | {"geoFence": {"version": 2, "circles": [circle]}}).mission.map
    ring = chart.boundary if inclusion else chart.zones[0].polygon
    center = [sum(axis) / len(ring) for axis in zip(*ring, strict=True)]
    sides = [(a, b) for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)]
    nearest = min(math.dist(center, [(p + q) / 2 for p, q in zip(a, b, strict=True)]) for a, b in sides)
    farthest = max(math.dist(center, corner) for corner in ring)
    assert 199 < nearest < farthest < 201.5
    assert farthest <= 200.01 if inclusion else nearest >= 199.99


# The ledger

names = st.text(st.characters(codec="ascii", categories=["L"]), min_size=1, max_size=5)
values = (
    st.none() | st.booleans() | st.integers(-5, 5) | st.sampled_from(["", "a", [1, 2], {"x": {"y": 1}}, [{"z": 2}]])
)
members = st.dictionaries(names, values, max_size=3)
commands = st.sampled_from([16, 16, 19, 22, 93, 112, 115, 178, 195, 206, 2000, 20, 21])


@st.composite
def plans(draw):
    """A plan of any commands, with members that nobody knows anywhere but in its fence."""
    items = []
    for _ in range(draw(st.integers(0, 5))):
        params = draw(st.lists(st.sampled_from([0, 1, 3, None]), min_size=4, max_size=4))
        place = draw(st.sampled_from([FIRST, SECOND, [0, 0, 0], [None, None, 5]]))
        items.append(draw(members) | item(draw(commands), place, *params))
    data = draw(members) | plan(item(16, FIRST), *items)
    data["mission"] = draw(members) | data["mission"]
    data["geoFence"] = {"version": 2, "polygons": draw(st.sampled_from([[], [fence_polygon()]]))}
    return data | {"rallyPoints": draw(members) | {"points": draw(st.sampled_from([[], [FIRST]])), "version": 2}}


@examples(100)
@given(plans())
def test_members_of_any_plan_are_accounted_for(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("any", numbered=True)
    found, refused = None, ""
    try:
        found = read(folder, data)
    except MissionError as error:
        refused = str(error)
    assert found is not None or refused.startswith(f"{folder / 'x.plan'}: ")
    if found is not None:
        assert raw_count(folder / "x.plan") == sum(row.count for row in found.ledger.rows)
        unknown = {key for key in data if key not in ("fileType", "version", "mission", "geoFence", "rallyPoints")}
        assert {row.kind for row in found.ledger.rows if row.how == "passed over"} >= unknown
