"""Goals of a robot's own navigation, and where a robot is by all that says so: without ROS."""

import pytest

from muster.motion.frames import pose_transform
from muster_robots.localisation import Localisation
from muster_robots.navigation import Ended, NavigationGoals, Outcome
from muster_robots.tied_frames import TiedFrames


class Navigation(list):
    outcome = None

    def take(self):
        return []

    def cancel(self):
        self.outcome = Outcome("canceled")


class Navigator:
    """Of a server that may go; `given` are its goals."""

    ready, unfit = True, ""

    def __init__(self):
        self.given = []

    def go(self, goal):
        self.given.append(goal)
        self.last = Navigation()
        return self.last


@pytest.fixture
def navigator():
    return Navigator()


def test_a_goal_that_is_lost_with_its_server_is_given_to_each_server_that_comes(navigator):
    goals = NavigationGoals(navigator, "move_base")
    goals.give("there")
    for k in range(5):
        navigator.ready = False
        assert goals.hear(10.0 * k, under_way=True) is None
        assert goals.hear(10.0 * k + 1, under_way=True) is None
        navigator.ready = True
        assert goals.hear(10.0 * k + 2, under_way=True) is None
    assert navigator.given == ["there"] * 6
    navigator.last.outcome = Outcome("succeeded")
    assert goals.hear(100.0, under_way=True) == Ended()


@pytest.mark.parametrize(
    ("outcome", "given", "reason"),
    [
        (Outcome("aborted", "no way"), 2, "move_base: aborted (no way)"),
        (Outcome("rejected"), 2, "move_base: rejected"),
        (Outcome("canceled"), 1, "move_base: canceled by somebody else"),
    ],
)
def test_a_goal_that_is_given_up_is_refused_with_the_words(navigator, outcome, given, reason):
    goals = NavigationGoals(navigator, "move_base")
    goals.give("there")
    ended = None
    while ended is None:
        navigator.last.outcome = outcome
        ended = goals.hear(0.0, under_way=True)
    assert ended == Ended(reason, by_others=outcome.status == "canceled")
    assert navigator.given == ["there"] * given


def pose(x):
    return pose_transform((x, 0.0, 0.0, 0.0, 0.0, 0.0))


def test_odometry_goes_on_from_each_fix_and_tf_comes_before_fixes():
    frames = TiedFrames("map")
    there = Localisation(frames)
    assert there.odometry(0.0, "/r/odom", "r/odom", pose(5.0)) is None
    assert "/r/odom is in frame r/odom" in there.untied
    assert there.fix(0.0, "/r/amcl_pose", "map", pose(1.0))[0, 3] == 1.0
    assert there.odometry(0.1, "/r/odom", "r/odom", pose(5.5))[0, 3] == pytest.approx(1.5)
    assert there.fix(0.2, "/r/amcl_pose", "map", pose(2.0)) is None  # odometry tells it, corrected
    assert there.odometry(0.3, "/r/odom", "r/odom", pose(5.6))[0, 3] == pytest.approx(2.1)
    frames.fix("r/odom", pose(10.0))
    assert there.odometry(0.4, "/r/odom", "r/odom", pose(5.6))[0, 3] == pytest.approx(15.6)


def test_a_pose_that_names_no_frame_is_taken_as_one_of_the_map_and_that_is_said_once(caplog):
    there = Localisation(TiedFrames("map"))
    for _ in range(3):
        assert there.pose(0.0, "/r/pose", "", pose(1.0))[0, 3] == 1.0
    assert [record.getMessage() for record in caplog.records] == ["/r/pose names no frame; it is taken as one of map"]


def test_the_body_in_tf_counts_where_nothing_else_says_where_the_robot_is():
    frames = TiedFrames("map")
    there = Localisation(frames)
    assert there.body(0.0, frames, "r/base_link") is None
    frames.fix("r/base_link", pose(3.0))
    assert there.body(0.0, frames, "r/base_link")[0, 3] == 3.0
    there.pose(1.0, "/r/pose", "map", pose(4.0))
    assert there.body(1.5, frames, "r/base_link") is None
    assert there.body(2.5, frames, "r/base_link")[0, 3] == 3.0
