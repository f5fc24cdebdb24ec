"""Flights in DJI's layout of KML: heights over what the file says, hovers as durations, all else named."""

import zipfile
from pathlib import Path

import pytest
from tests.muster_files.sites import writers
from tests.raw_counts import raw_count

from muster.mission.errors import MissionError
from muster_files.importing import read_site

CASES = Path(__file__).parents[2] / "data" / "cases" / "import"
ORIGIN = (47.377, 8.5417)


def action(func, param=""):
    inside = f"<wpml:actionActuatorFuncParam>{param}</wpml:actionActuatorFuncParam>" if param else ""
    return f"<wpml:action><wpml:actionActuatorFunc>{func}</wpml:actionActuatorFunc>{inside}</wpml:action>"


def group(*actions, first=0, last=0, trigger="reachPoint"):
    return (
        f"<wpml:actionGroup><wpml:actionGroupStartIndex>{first}</wpml:actionGroupStartIndex>"
        f"<wpml:actionGroupEndIndex>{last}</wpml:actionGroupEndIndex>"
        f"<wpml:actionTrigger><wpml:actionTriggerType>{trigger}</wpml:actionTriggerType></wpml:actionTrigger>"
        f"{''.join(actions)}</wpml:actionGroup>"
    )


HOVER = action("hover", "<wpml:hoverTime>12</wpml:hoverTime>")


def mark(inside="<wpml:executeHeight>50</wpml:executeHeight>"):
    return f"<Placemark><Point><coordinates>8.5417,47.378</coordinates></Point>{inside}</Placemark>"


def flight(*inside, mode="relativeToStartPoint"):
    said = f"<wpml:executeHeightMode>{mode}</wpml:executeHeightMode>" if mode else ""
    return (
        '<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2" xmlns:wpml="http://www.dji.com/wpmz/1.0.6">'
        "<Document><wpml:missionConfig><wpml:finishAction>goHome</wpml:finishAction></wpml:missionConfig>"
        f"<Folder>{said}<wpml:autoFlightSpeed>7</wpml:autoFlightSpeed>{''.join(inside)}</Folder></Document></kml>"
    )


def read(folder, text, name="way.wpml", robots=writers.ROBOTS):
    (folder / "robots.csv").write_text(robots, encoding="utf-8")
    (folder / name).write_text(text, encoding="utf-8")
    return read_site(folder / name, robots=folder / "robots.csv", origin=ORIGIN)


def test_the_way_lines_of_an_archive_are_read_with_heights_and_hovers():
    found = read_site(CASES / "wpmz.kmz", robots=CASES / "robots.csv", origin=(59.911, 10.751))
    assert [(task.position[2], task.duration_s) for task in found.mission.tasks] == [(50, 12), (60, 12), (70, 12)]
    assert any("flies at 5 and 7 m/s: robots say how fast they are" in note for note in found.notes)
    assert any("does not say what its heights are over: relativeToStartPoint is taken" in note for note in found.notes)
    lost = {row.kind: row.said for row in found.ledger.not_read}
    assert lost["<actionGroup> <action>"].startswith("is for a camera")
    assert lost["<Placemark> <waypointSpeed>"].startswith("is a speed")
    assert raw_count(CASES / "wpmz.kmz") == sum(row.count for row in found.ledger.rows if row.file.endswith(".kmz"))


@pytest.mark.parametrize(("mode", "height"), [("relativeToStartPoint", 50), ("aboveGroundLevel", 50)])
@pytest.mark.parametrize("name", ["way.wpml", "template.kml"])
def test_heights_over_the_start_or_the_ground_are_those_of_the_map(mode, height, name, tmp_path):
    (task,) = read(tmp_path, flight(mark(), mode=mode), name).mission.tasks
    assert task.position[2] == height


@pytest.mark.parametrize(("mode", "noted"), [("WGS84", False), ("EGM96", True)])
def test_absolute_heights_are_over_the_altitude_of_the_origin(mode, noted, tmp_path):
    robots = "id,lat,lon,alt,kind\nr_0,47.377,8.5417,400,air\n"
    text = flight(mark("<wpml:executeHeight>450</wpml:executeHeight>"), mode=mode)
    found = read(tmp_path, text, robots=robots)
    (task,), (robot,) = found.mission.tasks, found.mission.robots
    assert task.position[2] - robot.position[2] == pytest.approx(50, abs=0.01)
    assert any("EGM96" in note for note in found.notes) == noted


def test_absolute_heights_are_refused_where_robots_have_none(tmp_path):
    with pytest.raises(MissionError, match=r"height: 50 m; expected heights of all robots and places \(alt\)"):
        read(tmp_path, flight(mark(), mode="WGS84"))
    flat = read_site(tmp_path / "way.wpml", robots=tmp_path / "robots.csv", origin=ORIGIN, flat=True)
    assert flat.mission.dimensions == 2


def test_a_template_has_a_height_of_all_and_those_of_its_own(tmp_path):
    system = "<wpml:waylineCoordinateSysParam><wpml:heightMode>relativeToStartPoint</wpml:heightMode>"
    system += "</wpml:waylineCoordinateSysParam><wpml:globalHeight>80</wpml:globalHeight>"
    own = mark("<wpml:useGlobalHeight>0</wpml:useGlobalHeight><wpml:height>60</wpml:height>")
    of_all = mark("<wpml:useGlobalHeight>1</wpml:useGlobalHeight><wpml:height>60</wpml:height>")
    found = read(tmp_path, flight(system, own, of_all, mode=""), "template.kml")
    assert [task.position[2] for task in found.mission.tasks] == [60, 80]


def test_hovers_are_added_and_other_actions_named(tmp_path):
    height = "<wpml:executeHeight>50</wpml:executeHeight>"
    found = read(tmp_path, flight(mark(height + group(HOVER, action("takePhoto"), HOVER))))
    assert found.mission.tasks[0].duration_s == 24
    file = str(tmp_path / "way.wpml")
    assert raw_count(tmp_path / "way.wpml") == sum(row.count for row in found.ledger.rows if row.file == file)


HEIGHT = "<wpml:executeHeight>50</wpml:executeHeight>"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (flight(mark(), mode="realTimeFollowSurface"), "executeHeightMode: realTimeFollowSurface; expected relativeTo"),
        (flight(mark("")), "executeHeight: missing; expected metres"),
        (flight(mark("<wpml:executeHeight>high</wpml:executeHeight>")), "executeHeight: high; expected a number"),
        (flight(mark(HEIGHT + group(action("megaphone")))), "actionActuatorFunc: megaphone; expected hover, or"),
        (flight(mark(HEIGHT + group(HOVER, last=3))), "hover: hover at several way points; expected a hover at one"),
        (
            flight(mark(HEIGHT + group(HOVER, trigger="multipleTiming"))),
            "hover: multipleTiming; expected a hover at one",
        ),
        (flight(mark(HEIGHT + group(action("hover")))), "hoverTime: missing; expected seconds"),
        (
            flight(mark(HEIGHT + group(action("hover", "<wpml:hoverTime>-3</wpml:hoverTime>")))),
            "hoverTime: -3; expected",
        ),
        (
            flight("<Placemark><wpml:executeHeight>5</wpml:executeHeight></Placemark>"),
            "no <Point>; expected a way point",
        ),
    ],
)
def test_what_bears_on_safety_and_is_not_known_is_refused(text, said, tmp_path):
    with pytest.raises(MissionError) as error:
        read(tmp_path, text)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_an_archive_without_way_lines_is_read_by_its_template(tmp_path):
    with zipfile.ZipFile(tmp_path / "way.kmz", "w") as archive:
        archive.writestr("wpmz/template.kml", flight(mark()))
        archive.writestr("wpmz/res/image.jpg", b"0")
    (tmp_path / "robots.csv").write_text(writers.ROBOTS, encoding="utf-8")
    found = read_site(tmp_path / "way.kmz", robots=tmp_path / "robots.csv", origin=ORIGIN)
    assert found.mission.tasks[0].position[2] == 50
    assert any(row.first == "wpmz/res/image.jpg" for row in found.ledger.not_read)
