"""Properties of the way points of actions, each found in another way than the actions find them."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from muster import Robot, Task
from muster.mission.model import Action, Camera
from muster.motion.actions import TaskMotion, plan

numbers = st.floats(-50, 50)
points = st.tuples(numbers, numbers, numbers)
sizes = st.floats(0.5, 20)


def from_body(heading, vector):
    cos, sin = np.cos(heading), np.sin(heading)
    return np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]) @ np.asarray(vector)


def on_ground(origin, direction, height):
    """Where a ray meets the plane of a height."""
    assert direction[2] < 0
    return origin + (height - origin[2]) / direction[2] * direction


@given(points, sizes, st.floats(-360, 360), st.floats(5, 170), st.floats(5, 90), points)
def test_an_observer_looks_at_the_target_and_sees_the_width(target, width, heading_deg, fov_deg, tilt_deg, mount):
    """The optical axis meets the ground at the target, the lowest ray of the picture half the width before it."""
    assume(tilt_deg + fov_deg / 2 < 179)
    robot = Robot(
        id="d", position=(0, 0, 0), kind="air", camera=Camera(fov_deg=fov_deg, tilt_deg=tilt_deg, mount=mount)
    )
    action = Action(name="stationary-observation", width_m=width, heading_deg=heading_deg)
    doing = plan(Task(id="t", position=target, action=action), robot)
    assert isinstance(doing, TaskMotion)
    (waypoint,) = doing.waypoints
    camera = np.array(waypoint.position) + from_body(waypoint.heading, mount)

    def ray(below_horizon_deg):
        below = np.radians(below_horizon_deg)
        return from_body(waypoint.heading, (np.cos(below), 0, -np.sin(below)))

    seen = on_ground(camera, ray(tilt_deg), target[2])
    near = on_ground(camera, ray(tilt_deg + fov_deg / 2), target[2])
    forward = from_body(waypoint.heading, (1, 0, 0))
    scale = 1 + np.linalg.norm(camera - target)
    np.testing.assert_allclose(seen, target, atol=1e-7 * scale)
    np.testing.assert_allclose(near, target - width / 2 * forward, atol=1e-7 * scale)


@given(points, sizes, sizes, sizes)
def test_a_raster_covers_its_square(centre, side, spacing, height):
    """No point of the square is farther than half a spacing from a lane, and neighbouring lanes are a spacing apart."""
    action = Action(name="raster-search", side_m=side, height_m=height, spacing_m=spacing)
    robot = Robot(id="d", position=(0, 0, 0), kind="air")
    way = np.array(plan(Task(id="t", position=centre, action=action), robot).points)
    np.testing.assert_allclose(way[:, 2], centre[2] + height)
    lanes = way.reshape(-1, 2, 3)
    np.testing.assert_allclose(lanes[:, 0, 1], lanes[:, 1, 1])
    np.testing.assert_allclose(
        np.sort(lanes[:, :, 0], axis=1), [[centre[0] - side / 2, centre[0] + side / 2]] * len(lanes)
    )
    np.testing.assert_allclose(lanes[1:, 0, 0], lanes[:-1, 1, 0])  # from lane to lane straight north
    norths = lanes[:, 0, 1]
    np.testing.assert_allclose(np.diff(norths), spacing)
    assert np.isclose(norths[0], centre[1] - side / 2)
    assert norths[-1] >= centre[1] + side / 2 - 1e-6
    assert norths[-2] < centre[1] + side / 2  # no lane more than needed
