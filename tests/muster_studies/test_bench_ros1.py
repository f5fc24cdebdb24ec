"""The load on the bridge to ROS 1, with few robots: what it measures is there, and adds up."""

import pytest

from muster.mission.errors import MissingExtraError
from muster_robots.ros1 import extra
from muster_studies.benches.ros1 import under_load
from muster_studies.benches.ros1_load import Heard


class Pose:
    def __init__(self, number, stamp_s):
        self.header = self
        self.seq, self.stamp = number, self
        self._stamp_s = stamp_s

    def to_sec(self):
        return self._stamp_s


@pytest.mark.long
def test_poses_of_few_robots_arrive_and_the_robots_drive():
    try:
        rows = under_load(runs=1, robots=3, window_s=1.0)
    except MissingExtraError as error:
        pytest.skip(str(error))
    found = {row.name.rpartition(": ")[2]: row for row in rows}
    assert 0 < found["poses heard"].median <= 70
    assert 0 < found["latency, median"].median <= found["latency, 99 of 100"].median
    assert found["processor time"].median > 0
    assert found["lost"].median >= 0
    speed = float(found["poses heard"].note.split()[2])
    assert 0.1 < speed <= 0.6


def test_what_is_missing_among_the_numbers_of_a_robots_poses_is_lost():
    heard = Heard()
    for robot, numbers in {"a": (4, 5, 8), "b": (1, 2, 3)}.items():
        for number in numbers:
            heard.note(robot, Pose(number, 0.0))
    latencies, lost = heard.taken()
    assert (len(latencies), lost) == (6, 2)
    assert heard.taken() == ([], 0)


def test_without_rospy_the_bench_says_what_to_install(monkeypatch):
    monkeypatch.setattr(extra, "_absent", lambda *_: ["rospy"])
    with pytest.raises(MissingExtraError, match="apt-get install python3-rospy"):
        under_load(runs=1, robots=1, window_s=1.0)
