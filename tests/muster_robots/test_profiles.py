"""Profiles of robots on ROS: what they set, what comes before them, and what the pages say of them."""

from pathlib import Path

import pytest

from muster.mission.errors import ParameterError
from muster_robots.fleet_settings import Ros1Settings, Ros2Settings
from muster_robots.profiles import PROFILES, profile_help, profiles_of

DOCS = Path(__file__).parents[2] / "docs"
CASES = [(of, ros, name) for of, ros in ((Ros1Settings, "ros1"), (Ros2Settings, "ros2")) for name in profiles_of(ros)]


@pytest.mark.parametrize(("of", "ros", "name"), CASES)
def test_a_profile_sets_settings_and_what_is_given_comes_first(of, ros, name):
    sets = PROFILES[name].sets(ros)
    settings = of(profile=name)
    assert {key: getattr(settings, key) for key in sets} == dict(sets)
    given = of(profile=name, frame="site", odometry="start")
    assert (given.frame, given.odometry) == ("site", "start")


def test_the_usual_value_counts_where_it_is_given_beside_a_profile():
    assert Ros1Settings(profile="move_base", drive="cmd_vel").drive == "cmd_vel"
    assert Ros2Settings(profile="mocap", poses="").poses == ""


def test_without_a_profile_all_is_as_usual():
    assert Ros1Settings() == Ros1Settings(drive="cmd_vel", frame="map", odometry="map", poses="")
    assert Ros2Settings().give == "goals"


@pytest.mark.parametrize(("of", "other"), [(Ros1Settings, "nav2"), (Ros2Settings, "move_base")])
def test_a_profile_of_the_other_ros_is_refused_with_those_there_are(of, other):
    with pytest.raises(ParameterError, match=rf"^profile: \"?{other}\"?; expected \w+ or amcl or mocap$"):
        of(profile=other)


def test_avoidance_is_refused_for_robots_whose_profile_lets_them_find_their_way():
    with pytest.raises(ParameterError, match="auto with drive move_base"):
        Ros1Settings(profile="move_base", avoidance="rvo")


@pytest.mark.parametrize(("of", "ros", "name"), CASES)
def test_help_and_page_tell_of_each(of, ros, name):
    page = (DOCS / ("ros.md" if ros == "ros1" else "ros2.md")).read_text(encoding="utf-8")
    (row,) = [line for line in page.splitlines() if f"`--profile {name}` (" in line]
    way = "drive" if ros == "ros1" else "give"
    value = PROFILES[name].sets(ros)[way]
    assert f"`{way}` {value}" in row
    assert f"{name}: " in profile_help(ros)
    assert f"{way} {value}" in profile_help(ros)
