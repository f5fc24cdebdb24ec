"""`muster replay` with recordings of ROS."""

import json
from pathlib import Path

import pytest
from tests.cli.yard import table_rows
from tests.report.voyages import carry_out

from muster import load, solve
from muster.report.record import RecordWriter

pytest.importorskip("mcap")
pytest.importorskip("rosbags")


@pytest.fixture
def recorded(folder):
    mission = load("yard.yaml")
    with RecordWriter("r.mcap", mission) as writer:
        carry_out(mission, solve(mission, "greedy"), writer)
    return Path("r.mcap")


@pytest.mark.long
def test_a_record_beside_itself(recorded, muster):
    code, _, err = muster("replay", recorded, "--ros2", "o.mcap", "--ros1", "o.bag", "--begins", "1000")
    assert code == 0
    assert [line.split(":")[0] for line in err.splitlines()] == ["wrote o.mcap", "wrote o.bag"]
    for file in ("o.mcap", "o.bag"):
        code, out, _ = muster("replay", recorded, "--reference", file, "--format", "json")
        off = json.loads(out)["reference"]
        assert code == 0
        assert off["begins_s"] == 1000.0
        assert all(row["mean_m"] < 1e-9 and row["samples"] > 10 for row in off["robots"])
    rows = table_rows(muster("replay", recorded, "--reference", "o.bag", "--topic", "r_0=/tf:r_0/base_link")[1])
    assert next(row[:2] for row in rows if len(row) == 9 and row[1].startswith("/")) == ["r_0", "/tf:r_0/base_link"]


def test_poses_of_a_recording(recorded, muster):
    pytest.importorskip("matplotlib")
    muster("replay", recorded, "--ros1", "o.bag", "-q")
    code, out, err = muster("replay", "o.bag", "--plot", "o.svg")
    assert (code, err) == (0, "")
    assert ["/r_0/odom", "nav_msgs/Odometry", "map"] in [row[:3] for row in table_rows(out)]
    assert "track-/r_0/odom" in Path("o.svg").read_text(encoding="utf-8")
    tracks = json.loads(muster("replay", "o.bag", "--format", "json")[1])["tracks"]
    assert tracks[0]["travelled_m"] > 1


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("r.mcap", "--ros2", "x.bag"), "--ros2: x.bag; expected a file that ends in .mcap"),
        (("r.mcap", "--topic", "r_0=/a"), "--topic given; expected it together with --reference"),
        (("r.mcap", "--begins", "3"), "--begins given; expected it together with"),
        (("r.mcap", "--reference", "nowhere.bag"), "nowhere.bag: No such file or directory; expected a recording"),
        (("r.mcap", "--reference", "o.bag", "--topic", "r_0"), "--topic: r_0; expected ROBOT=TOPIC"),
        (("o.bag", "--html", "x.html"), "--html: o.bag is a recording of poses; expected a record of muster"),
        (("r.mcap", "--ros1", "r.mcap"), "given twice"),
    ],
)
def test_bad_input_is_one_line(options, said, recorded, muster):
    muster("replay", recorded, "--ros1", "o.bag", "-q")
    code, out, err = muster("replay", *options)
    assert (code, out) == (2, "")
    assert said in err
    assert len(err.splitlines()) == 1
