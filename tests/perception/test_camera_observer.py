"""From drawn images to points of interest; what is wrong with one image is told, and the next one counts."""

import math

import numpy as np
import pytest

pytest.importorskip("apriltag")
pytest.importorskip("cv2")
from muster.motion.frames import transform
from muster.perception.camera import RB5_MOUNT, mount_of
from muster.perception.camera_observer import CameraObserver
from muster.perception.clusters import by_tag
from muster.perception.detection import TagDetector
from muster.perception.estimates import RawEstimates
from muster.perception.localisation import Uncertainty
from muster.perception.matching import error_table
from muster.perception.points_of_interest import points_of_interest, remarks

from .scenes import VGA, drawn, over, tag_pose

DETECTOR = TagDetector()
TAGS = {"3": (0.5, 0.0), "11": (1.2, 0.7), "500": (0.9, -0.6)}
SCENE = [(int(tag), tag_pose(*place, turned=int(tag))) for tag, place in TAGS.items()]


def observer(robot="r_0", **other):
    return CameraObserver(robot=robot, intrinsics=VGA, mount=RB5_MOUNT, detector=DETECTOR, **other)


def flight(robot, seed, angle_rad=0.0, position_m=0.0):
    """Around the tags, looking inwards; the robot takes its pose for another than it is."""
    random = np.random.default_rng(seed)
    eye = observer(robot, uncertainty=Uncertainty(position_m=position_m or 0.001, angle_rad=angle_rad))
    for step in range(6):
        yaw = seed + step * math.pi / 3
        at = np.array([0.9 - 3 * math.cos(yaw), -3 * math.sin(yaw), 3.0, 0.0, 0.0, yaw])
        image = drawn(over(*at[:3], yaw), SCENE, noise=2, seed=step)
        taken_for = at + random.normal(0, 1, 6) * ([position_m] * 3 + [angle_rad] * 3)
        yield eye.look(image, taken_for, float(step))


@pytest.mark.long
@pytest.mark.parametrize(("angle_rad", "position_m", "most"), [(0.0, 0.0, 0.005), (math.radians(1), 0.03, 0.1)])
def test_two_robots_find_all_tags(angle_rad, position_m, most):
    looks = [look for seed, robot in enumerate(("r_0", "r_1")) for look in flight(robot, seed, angle_rad, position_m)]
    raw = RawEstimates.joined([look.estimates for look in looks])
    points = points_of_interest(raw, by_tag(raw, 1.0))
    assert remarks(points) == ()
    assert [str(point.tag) for point in points] == list(TAGS)
    assert all(point.robots == ("r_0", "r_1") for point in points)
    table = error_table([point.position for point in points], TAGS)
    assert table.greatest_error_m < most
    for point in points:
        error = point.position - TAGS[str(point.tag)]
        assert error @ np.linalg.solve(point.covariance, error) < 18.4  # of two coordinates, 1 in 10,000 is above


def test_an_image_of_the_wrong_size_is_told_and_the_next_one_counts():
    eye, image = observer(), drawn(over(-1.5, 0, 3), SCENE)
    wrong = eye.look(image[:240], [-1.5, 0, 3, 0, 0, 0], 1.25)
    assert wrong.remarks == (
        "r_0 at 1.25 s: image: 640 x 240 pixels; expected 640 x 480, as its camera's intrinsics say",
    )
    assert (wrong.sightings.all, len(wrong.estimates)) == ((), 0)
    right = eye.look(image, [-1.5, 0, 3, 0, 0, 0], 1.5)
    assert (right.remarks, right.estimates.tags.tolist()) == ((), [3, 11, 500])


def test_a_pose_that_is_none_is_told():
    look = observer().look(drawn(over(-1.5, 0, 3), SCENE), [math.nan] * 6, 2.0)
    assert look.remarks == ("r_0 at 2.00 s: pose: a number that is not finite; expected finite numbers",)


def test_a_tag_twice_is_told_and_both_count():
    twice = [(7, tag_pose(0.7, 0.7)), (7, tag_pose(1.5, -0.7))]
    look = observer().look(drawn(over(-1.5, 0, 3), twice), [-1.5, 0, 3, 0, 0, 0], 3.0)
    assert look.remarks == ("r_0 at 3.00 s: tag 7 is twice in one image",)
    points = points_of_interest(look.estimates, by_tag(look.estimates, 1.0))
    assert error_table([p.position for p in points], {"a": (0.7, 0.7), "b": (1.5, -0.7)}).greatest_error_m < 0.01
    assert remarks(points) == ("tag 7 is at 2 places",)


def test_no_tag_at_all_is_no_error():
    look = observer().look(drawn(over(0, 0, 3), []), [0, 0, 3, 0, 0, 0], 0.0)
    assert (look.remarks, len(look.estimates)) == ((), 0)
    raw = RawEstimates.joined([look.estimates])
    assert remarks(points_of_interest(raw, by_tag(raw, 1.0))) == ("no point of interest: no tag was seen",)


def test_what_is_too_far_gives_no_estimate():
    image, body = drawn(over(-1.5, 0, 3), SCENE), [-1.5, 0, 3, 0, 0, 0]
    near = observer(farthest_m=3.9).look(image, body, 0.0)
    assert (len(near.sightings.all), near.estimates.tags.tolist()) == (3, [3, 500])


def test_a_tag_above_the_horizon_gives_no_estimate():
    """The camera looks level, and the robot takes itself for pitched up: the tag seems to hang in the air."""
    level = CameraObserver(robot="r", intrinsics=VGA, mount=mount_of([0] * 6), detector=DETECTOR)
    view = over(0, 0, 1.5, mount=level.mount)
    image = drawn(view, [(7, view.pose @ transform([0.0, 0.8, 4.0], np.eye(3)))])
    assert len(level.look(image, [0, 0, 1.5, 0, 0, 0], 0.0).estimates) == 1
    look = level.look(image, [0, 0, 1.5, 0, -0.7, 0], 0.0)
    assert (len(look.sightings.all), len(look.estimates)) == (1, 0)
