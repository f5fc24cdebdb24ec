"""On the live page and over REST a robot is moved, taken away and brought back, and where that is refused."""

import math

import pytest
from playwright.sync_api import expect

from muster import Map, Mission, Robot, Task
from muster.mission.model import Zone
from muster.mission.yaml_writer import yaml_text
from muster_control.client import Client

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("removed and moved")]

WALL = Zone(polygon=((9, 3), (11, 3), (11, 7), (9, 7)))
"""In the middle of the map."""
HALL = Mission(
    name="hall",
    robots=(Robot(id="a", position=(1, 1), radius_m=0.3), Robot(id="b", position=(1, 9), radius_m=0.3)),
    tasks=tuple(Task(id=f"t_{k}", position=(18.0, 1.0 + 2 * k), duration_s=30) for k in range(4)),
    map=Map(boundary=((0, 0), (20, 0), (20, 10), (0, 10)), zones=(WALL,)),
)
FREE = "expected a place where a is free"


@pytest.fixture(scope="module")
def run(watched):
    """A run that is paused, on its page."""
    with Client(watched.origin) as client:
        mission = client.missions.create(yaml_text(HALL))
        run = client.start(client.plan(mission.id, iterations=50).wait(), speed=1.0)
        watched.open(f"/live/{run.id}")
        watched.page.locator("li[data-kind=sets_out]").first.wait_for()
        run.act("pause")
        watched.page.locator(".run-state[data-state=paused]").wait_for()
        yield run
        run.cancel()
    watched.require_clean()


def choose(watched, robot):
    watched.page.locator(f"tr[data-robot={robot}]").click()


def told(run, kind):
    return [event.data for event in run.events() if event.kind == kind]


def test_a_robot_is_moved_by_a_click_and_not_into_a_wall(watched, run):
    page = watched.page
    choose(watched, "a")
    page.get_by_role("button", name="Move …").click()
    page.locator(".muster-map-host").focus()
    page.keyboard.press("Enter")  # the middle of the map
    expect(page.locator(".notices .refused").first).to_contain_text(FREE)
    assert told(run, "robot_moved") == []
    page.get_by_role("button", name="Move …").click()
    box = page.locator(".muster-map-host").bounding_box()
    page.mouse.click(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    page.locator("li[data-kind=robot_moved]").first.wait_for()
    (moved,) = told(run, "robot_moved")
    assert moved["robot"] == "a"
    assert math.dist(moved["position"], (1, 1)) > 2
    watched.shoot("live-robot-moved")


def test_a_robot_is_taken_away_and_brought_back(watched, run):
    page = watched.page
    choose(watched, "b")
    page.get_by_role("button", name="Take away").click()
    page.locator("tr[data-robot=b].out").wait_for()
    page.locator("li[data-kind=robot_removed]").first.wait_for()
    watched.shoot("live-robot-taken-away")
    page.get_by_role("button", name="Bring back").click()
    page.locator("li[data-kind=robot_returns]").first.wait_for()
    expect(page.locator("tr[data-robot=b].out")).to_have_count(0)
    choose(watched, "b")
    page.get_by_role("button", name="Take away").click()
    page.locator("tr[data-robot=b].out").wait_for()
    page.keyboard.press("Control+z")
    expect(page.locator("tr[data-robot=b].out")).to_have_count(0)
    assert len(told(run, "robot_removed")) == 2


@pytest.mark.parametrize(
    ("event", "said"),
    [
        ({"robot_moved": {"robot": "a", "position": [10.0, 5.0]}}, f"robot_moved.position: [10.0, 5.0]; {FREE}"),
        ({"robot_moved": {"robot": "a", "position": [30.0, 5.0]}}, f"robot_moved.position: [30.0, 5.0]; {FREE}"),
        ({"robot_moved": {"robot": "a", "position": [3.0]}}, "robot_moved.position: "),
        ({"robot_moved": {"robot": "c", "position": [3.0, 3.0]}}, 'robot: "c"; expected '),
        ({"robot_moved": {"robot": "a"}}, "robot_moved.position: "),
        ({"robot_removed": "c"}, 'robot: "c"; expected '),
    ],
)
def test_what_does_not_fit_is_refused_over_rest_in_one_line(run, watched, event, said):
    run.act("event", **event)
    (outcome,) = wait_for(lambda: [one["outcome"] for one in told(run, "command") if one["data"] == event], watched)
    assert outcome.startswith(said)
    assert "\n" not in outcome


def wait_for(found, watched):
    for _ in range(100):
        if here := found():
            return here
        watched.page.wait_for_timeout(100)
    raise AssertionError("this did not come about")
