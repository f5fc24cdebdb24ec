"""`muster init`."""

from pathlib import Path

import pytest
from tests.cli.yard import FOUND

from muster.library import mission_path

pytestmark = pytest.mark.usefixtures("folder")


def test_init(muster):
    assert muster("init")[:2] == (0, "mission.yaml\n")
    assert muster("check", "mission.yaml") == (
        0,
        "mission: 2 robots, 4 tasks; no errors\n" + FOUND,
        "",
    )
    assert muster("solve", "mission.yaml", "--iterations", 20, "--require-complete")[0] == 0


@pytest.mark.parametrize("name", ["rescue", "rescue.yaml", "rescue.yml"])
def test_init_with_a_name(name, muster):
    code, out, err = muster("init", name)
    assert (code, out) == (0, "rescue.yaml\n")
    assert err == "next: muster check rescue.yaml; muster solve rescue.yaml\n"
    assert muster("check", "rescue.yaml")[1].startswith("rescue: ")


@pytest.mark.parametrize(
    "name", ["hall: north", "true", "null", "1.5", "7", "007", "@home", "x #1", "a 'b'", "été", "- a"]
)
def test_init_with_a_name_that_yaml_could_take_for_something_else(name, muster):
    assert muster("init", "--", name)[:2] == (0, f"{name}.yaml\n")
    assert muster("check", "--", f"{name}.yaml") == (
        0,
        f"{name}: 2 robots, 4 tasks; no errors\n{FOUND}",
        "",
    )


@pytest.mark.parametrize("more", [[], ["--from", "31T-6R50"]])
def test_init_leaves_an_existing_file_alone(more, muster):
    Path("mission.yaml").write_text("mine", encoding="utf-8")
    assert muster("init", *more) == (2, "", "mission.yaml: exists; expected the name of a new file\n")
    assert Path("mission.yaml").read_text(encoding="utf-8") == "mine"


def test_init_from_a_shipped_mission(muster):
    assert muster("init", "copy", "--from", "31T-6R50")[:2] == (0, "copy.yaml\n")
    assert Path("copy.yaml").read_bytes() == mission_path("31T-6R50").read_bytes()
    assert muster("init", "--from", "6T-2R", "-o", "other.yaml")[:2] == (0, "other.yaml\n")
    assert muster("check", "other.yaml")[0] == 0


def test_init_from_a_shipped_mission_with_a_map_copies_the_map_too(muster):
    """The copy needs nothing of what the package ships."""
    written = "hall.yaml\nfloor-plan.png\nfloor-plan.yaml\n"
    assert muster("init", "hall", "--from", "floor")[:2] == (0, written)
    pytest.importorskip("shapely")
    from muster import load
    from muster.motion.map_world import World

    mission = load("hall.yaml")
    assert mission.map.ros_yaml == "floor-plan.yaml"
    assert World.of(mission).image.shape == World.of(load("floor")).image.shape
    assert muster("init", "again", "--from", "floor") == (
        2,
        "",
        "floor-plan.png: exists; expected the name of a new file\n",
    )
    assert not Path("again.yaml").exists()
    assert muster("init", "--from", "floor", "-o", "floor-plan.yaml") == (
        2,
        "",
        "floor-plan.yaml: the name of the mission's map; expected another one\n",
    )


def test_init_from_what_cannot_be_copied(muster):
    assert muster("init", "--from", "31T-6R5") == (
        2,
        "",
        "--from: no shipped mission 31T-6R5; expected one of `muster missions`; did you mean '31T-6R50'?\n",
    )
    code, out, err = muster("init", "--from", "eil51")
    assert (code, out) == (2, "")
    assert err == "--from: eil51 is no YAML; use it as it is: muster solve eil51 --salesmen 3\n"
    assert not Path("mission.yaml").exists()


def test_init_in_a_folder_that_does_not_exist(muster):
    code, out, err = muster("init", "none/mission")
    assert (code, out) == (2, "")
    assert err == "none/mission.yaml: No such file or directory; expected a file that can be read or written\n"
