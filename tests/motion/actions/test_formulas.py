"""What each action makes a robot do, by hand."""

import math

import pytest

from muster import Robot, Task
from muster.mission.model import Action, Camera
from muster.motion.actions import Impossible, TaskMotion, plan

ROVER = Robot(id="rover", position=(0, 0), speed_mps=2, efficiency=0.5)


def drone(**camera):
    return Robot(id="drone", position=(0, 0), kind="air", camera=Camera(**camera) if camera else None)


def task(position=(4.0, 4.0), *, action=None, **more):
    return Task(id="t", position=position, action=None if action is None else Action(**action), **more)


def places(doing):
    return [waypoint.position for waypoint in doing.waypoints]


def test_a_task_without_action_is_one_to_go_to():
    doing = plan(task(actuation_cost=12), ROVER)
    assert places(doing) == [(4, 4, 0)]
    assert (doing.entry, doing.exit, doing.cost_m, doing.hold_s) == ((4, 4), (4, 4), 12, 6)
    assert doing.legs == ()
    assert doing == plan(task(actuation_cost=12, action={"name": "go-to-goal"}), ROVER)


def test_what_is_typed_beside_no_geometry_is_arrived_at_and_left():
    doing = plan(task(entry=(4, 0), exit=(7, 4), duration_s=5), ROVER)
    assert places(doing) == [(4, 0, 0), (7, 4, 0)]
    assert (doing.entry, doing.exit, doing.cost_m) == ((4, 0), (7, 4), 0)
    assert [waypoint.hold_s for waypoint in doing.waypoints] == [10 - 5 / 2, 0]


@pytest.mark.parametrize(("portal", "holds"), [("entry", [0, 8]), ("exit", [8, 0])])
def test_it_stays_at_the_position_if_it_comes_there(portal, holds):
    doing = plan(task(duration_s=5, **{portal: (4, 0)}), ROVER)
    assert [waypoint.hold_s for waypoint in doing.waypoints] == holds
    assert places(doing)[holds.index(8)] == (4, 4, 0)


def test_a_sensor_is_waited_for():
    doing = plan(task(action={"name": "sensor-activation", "duration_s": 3}), ROVER)
    assert places(doing) == [(4, 4, 0)]
    assert (doing.cost_m, doing.hold_s) == (0, 6)


def test_a_patrol_is_the_square():
    """Thesis section 4.2: north, east, south, back; cost 4 L."""
    doing = plan(task(action={"name": "ground-patrol", "side_m": 6}), ROVER)
    assert places(doing) == [(1, 1, 0), (1, 7, 0), (7, 7, 0), (7, 1, 0), (1, 1, 0)]
    assert (doing.entry, doing.exit, doing.cost_m, doing.hold_s) == ((1, 1), (1, 1), 24, 0)


def test_a_delivery_begins_at_the_pickup():
    doing = plan(task(action={"name": "delivery", "pickup": (1, 0)}), ROVER)
    assert places(doing) == [(1, 0, 0), (4, 4, 0)]
    assert (doing.entry, doing.exit, doing.cost_m, doing.hold_s) == ((1, 0), (4, 4), 5, 0)


def test_what_is_left_of_the_duration_is_waited_at_the_end():
    doing = plan(task(action={"name": "delivery", "pickup": (1, 0)}, duration_s=5), ROVER)
    assert [waypoint.hold_s for waypoint in doing.waypoints] == [0, 10 - 5 / 2]
    assert plan(task(action={"name": "delivery", "pickup": (1, 0)}, duration_s=1), ROVER).hold_s == 0


def test_typed_entries_and_exits_are_passed_and_paid_for():
    doing = plan(task(action={"name": "delivery", "pickup": (1, 0)}, entry=(1, -2), exit=(4, 7)), ROVER)
    assert places(doing) == [(1, -2, 0), (1, 0, 0), (4, 4, 0), (4, 7, 0)]
    assert doing.cost_m == 2 + 5 + 3
    same = plan(task(action={"name": "delivery", "pickup": (1, 0)}, entry=(1, 0), exit=(4, 4)), ROVER)
    assert places(same) == [(1, 0, 0), (4, 4, 0)]


@pytest.mark.parametrize(
    ("side", "spacing", "lanes", "leaving"),
    [
        (6, 1.5, 5, (7, 7)),
        (6, 2, 4, (1, 7)),
        (5, 2, 4, (1.5, 7.5)),  # the last lane lies beyond the square: 0, 2, 4, 6 of 5
        (1, 0.1, 11, (4.5, 4.5)),  # 1 / 0.1 is 10 but for rounding
        (2, 9, 2, (3, 12)),
    ],
)
def test_a_raster_has_its_true_length(side, spacing, lanes, leaving):
    """Equations (4.31)-(4.34); (4.35) would say side**2 / spacing + side."""
    action = {"name": "raster-search", "side_m": side, "height_m": 3, "spacing_m": spacing}
    doing = plan(task(action=action), drone())
    assert doing.entry == (4 - side / 2, 4 - side / 2)
    assert doing.exit == pytest.approx(leaving)
    assert len(doing.waypoints) == 2 * lanes
    assert doing.cost_m == pytest.approx(lanes * side + (lanes - 1) * spacing)


def test_heights_count_in_space_alone():
    action = {"name": "raster-search", "side_m": 2, "height_m": 3, "spacing_m": 2}
    corners = [(3, 3), (5, 3), (5, 5), (3, 5)]
    assert places(plan(task(action=action), drone())) == [(*corner, 0) for corner in corners]
    doing = plan(task((4.0, 4.0, 10.0), action=action), drone())
    assert places(doing) == [(*corner, 13) for corner in corners]
    assert doing.entry == (3, 3, 13)


def test_where_an_observer_stands():
    """Tilted 45 degrees with a field of 60: tan 45 = 1, tan 15 = 2 - sqrt(3), so that h = r = 4 / (2 (sqrt(3) - 1))."""
    action = {"name": "stationary-observation", "width_m": 4}
    doing = plan(task((4.0, 4.0, 1.0), action=action, duration_s=7), drone(fov_deg=60, tilt_deg=45))
    r = 2 / (math.sqrt(3) - 1)
    assert doing.entry == doing.exit == pytest.approx((4 - r, 4, 1 + r))
    assert (doing.cost_m, doing.hold_s, doing.waypoints[0].heading) == (0, 7, 0)


def test_the_mount_turns_with_the_body():
    """Facing north, a camera 0.2 m ahead, 0.1 m to the left and 0.3 m below: straight above the target."""
    action = {"name": "stationary-observation", "width_m": 4, "heading_deg": 90}
    robot = drone(fov_deg=90, tilt_deg=90, mount=(0.2, 0.1, -0.3))
    assert plan(task((4.0, 4.0, 0.0), action=action), robot).entry == pytest.approx((4 + 0.1, 4 - 0.2, 2 + 0.3))


@pytest.mark.parametrize(
    ("robot", "reason"),
    [
        (drone(), "it has no camera"),
        (drone(fov_deg=60), "its camera (tilt_deg 0) does not look down"),
        (drone(fov_deg=60, tilt_deg=-20), "its camera (tilt_deg -20) does not look down"),
        (drone(fov_deg=1e-9, tilt_deg=40), "its camera (fov_deg 1e-09) sees too little to see a width of 4 m"),
        (drone(fov_deg=1e-300, tilt_deg=90), "its camera (fov_deg 1e-300) sees too little to see a width of 4 m"),
    ],
)
def test_who_cannot_observe(robot, reason):
    assert plan(task(action={"name": "stationary-observation", "width_m": 4}), robot) == Impossible(reason)


def test_a_ground_robot_does_not_fly():
    rover = Robot(id="rover", position=(0, 0, 0), camera=Camera(fov_deg=90, tilt_deg=90))
    search = {"name": "raster-search", "side_m": 2, "height_m": 3, "spacing_m": 2}
    look = {"name": "stationary-observation", "width_m": 4}
    assert plan(task((4, 4, 0), action=search), rover) == Impossible(
        "a ground robot cannot search from 3 m above the ground"
    )
    assert plan(task((4, 4, 0), action=look), rover) == Impossible(
        "a ground robot cannot look from 2 m above the ground"
    )
    for action in (search, look):  # in the plane there are no heights
        assert isinstance(plan(task(action=action), rover), TaskMotion)


def test_a_task_is_done_when_all_way_points_are_passed():
    doing = plan(task(action={"name": "ground-patrol", "side_m": 6}), ROVER)
    assert [doing.done(passed) for passed in range(6)] == [False] * 5 + [True]
