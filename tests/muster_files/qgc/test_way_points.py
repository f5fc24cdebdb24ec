"""Way points as text, `QGC WPL 110`: a mission of one robot, by whatever name the file has."""

import pytest
from tests.raw_counts import raw_count

import muster
from muster.mission.errors import MissionError, ParameterError
from muster.planning.loading import load_noted

HOME = "0 1 0 16 0 0 0 0 59.91 10.75 20 1"
TAKEOFF = "1 0 3 22 0 0 0 0 0 0 20 1"
POINT = "2 0 3 16 5 0 0 0 59.911 10.751 30 1"
PHOTO = "3 0 3 206 20 0 0 0 0 0 0 1"
SPEED = "4 0 3 178 1 4 -1 0 0 0 0 1"
JUMP = "5 0 3 177 2 1 0 0 0 0 0 1"
RETURN = "6 0 3 20 0 0 0 0 0 0 0 1"


def write(folder, *lines, name="route.txt", head="QGC WPL 110", numbered=True):
    """A file of lines, which get their numbers."""
    rows = [[str(k) if numbered else line.split()[0], *line.split()[1:]] for k, line in enumerate(lines)]
    file = folder / name
    file.write_text("\n".join([head, *map("\t".join, rows)]) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("name", ["route.txt", "route.waypoints", "route.wpl"])
@pytest.mark.parametrize("version", ["110", "120"])
def test_a_route_is_read_as_a_plan_is(name, version, tmp_path):
    file = write(tmp_path, HOME, TAKEOFF, POINT, PHOTO, JUMP, RETURN, name=name, head=f"QGC WPL {version}")
    found = load_noted(file)
    mission = found.mission
    (robot,) = mission.robots
    assert (robot.id, robot.kind, robot.position, robot.return_to_start) == ("route", "air", (0, 0, 0), True)
    assert [(task.id, task.duration_s) for task in mission.tasks] == [("route-2", 5), ("route-2.2", 5)]
    assert mission.tasks[0].position == pytest.approx((56, 111.4, 30), abs=0.1)
    assert mission.origin_wgs84.alt_m == 20
    assert any("DO_SET_CAM_TRIGG_DIST" in line for line in found.said)
    assert any("what vehicle it is for" in note for note in found.notes)
    assert raw_count(file) == found.ledger.read + found.ledger.passed_over


def test_speeds_are_those_of_the_file(tmp_path):
    assert load_noted(write(tmp_path, HOME, SPEED, POINT)).mission.robots[0].speed_mps == 4
    late = load_noted(write(tmp_path, HOME, POINT, SPEED))
    assert late.mission.robots[0].speed_mps == 1
    assert any("no speed is set before the first way point: speed_mps is 1" in note for note in late.notes)


def test_without_home_a_vehicle_starts_where_it_takes_off(tmp_path):
    mission = muster.load(write(tmp_path, "0 1 3 22 0 0 0 0 59.91 10.75 20 1", "1 0 3 16 0 0 0 0 59.911 10.751 30 1"))
    assert (mission.origin_wgs84.lat_deg, mission.robots[0].position) == (59.91, (0, 0, 0))


def test_a_vehicle_that_stays_on_the_ground_is_no_drone(tmp_path):
    mission = muster.load(write(tmp_path, HOME, "1 0 3 16 0 0 0 0 59.911 10.751 0 1"))
    assert (mission.robots[0].kind, mission.dimensions) == ("ground", 2)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (
            (HOME, "1 0 3 17 0 0 0 0 59.911 10.751 30 1"),
            "route.txt:3: command: MAV_CMD_NAV_LOITER_UNLIM (17); expected",
        ),
        (
            (HOME, "1 0 3 16 0 0 0 0 35 24 30 1"),
            "route.txt:3: latitude: latitude 35, longitude 24; expected within 100 km",
        ),
        ((HOME, "1 0 10 16 0 0 0 0 59.911 10.751 30 1"), "route.txt:3: frame: 10; expected one of 0, 3, 5, 6"),
        ((HOME, "1 0 3 16 0 0 0 0 59.911 10.751 30 0"), "route.txt:3: autocontinue: 0.0; expected 1: no wait"),
        ((HOME, "1 0 3 16 0 0 0 0 59.911 10.751 30"), "route.txt:3: 11 fields; expected 12 numbers"),
        ((HOME, "1 0 3 sixteen 0 0 0 0 59.911 10.751 30 1"), "route.txt:3: sixteen; expected 12 numbers"),
        ((HOME, "1 0 3 16.5 0 0 0 0 59.911 10.751 30 1"), "route.txt:3: command: 16.5; expected a whole number"),
        (
            (HOME, "1 0 3 16 -4 0 0 0 59.911 10.751 30 1"),
            "route.txt:3: parameter 1: -4.0; expected seconds of at least 0",
        ),
        ((HOME, "1 0 0 5001 4 0 0 0 59.911 10.751 0 1"), "command: MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION (5001)"),
        (("0 1 0 16 0.15 0 0 0 47.37 8.54 550 1", POINT), "expected home: a way point in frame 0; or a take-off"),
        (("0 1 0 16 0 0 0 0 0 0 0 1", POINT), "expected home: a way point in frame 0; or a take-off with a place"),
        ((), "route.txt:1: no items; expected a line for each item"),
    ],
)
def test_what_cannot_be_flown_is_refused_by_line(lines, said, tmp_path):
    with pytest.raises(MissionError) as error:
        muster.load(write(tmp_path, *lines))
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_items_out_of_order_are_refused(tmp_path):
    with pytest.raises(MissionError, match=r"route.txt:3: number: 2.0; expected 1: items in their order"):
        muster.load(write(tmp_path, HOME, POINT, numbered=False))


def test_another_version_and_flags_of_other_files_are_refused(tmp_path):
    with pytest.raises(MissionError, match="QGC WPL 200; expected QGC WPL 110 or 120"):
        muster.load(write(tmp_path, HOME, head="QGC WPL 200"))
    with pytest.raises(MissionError, match="expected QGC WPL 110 or 120"):
        muster.load(write(tmp_path, HOME, head="home", name="a.waypoints"))
    with pytest.raises(ParameterError, match="--salesmen given"):
        muster.load(write(tmp_path, HOME, POINT), salesmen=2)
