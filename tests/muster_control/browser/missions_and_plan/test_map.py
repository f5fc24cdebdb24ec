"""Missions are edited on the map, by the mouse."""

import re

import pytest
from playwright.sync_api import expect
from tests.muster_control.browser.missions_and_plan.plan_view import (
    SCENE,
    SLOW_MS,
    own_missions,
    plan_view,
    task_place,
    text_of,
)

from muster_control.client import Client

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


def test_an_empty_mission_is_made_and_edited_on_the_map_and_undone(watched, page):
    watched.open("/")
    page.click("#new")
    page.get_by_label("Name", exact=True).fill("yard test")
    page.get_by_role("button", name="Make it").dblclick()
    page.wait_for_url("**/plan/yard-test")
    page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    assert [name for name in own_missions(watched) if name.startswith("yard test")] == ["yard test"]
    before = task_place(page, "1")
    page.mouse.move(before["px"], before["py"])
    page.mouse.down()
    page.mouse.move(before["px"] + 60, before["py"] + 30, steps=5)
    page.mouse.up()
    page.get_by_text("version 1, changed").wait_for()
    after = task_place(page, "1")
    assert after["x"] > before["x"]
    assert after["y"] < before["y"]
    text_of(page, f"position: [{after['x']:g}, {after['y']:g}]")
    page.get_by_role("button", name="Map", exact=True).click()
    page.locator(".muster-map-host").focus()
    page.keyboard.press("Control+z")
    page.get_by_text(re.compile(r"^version 1$")).wait_for()
    text_of(page, "position: [5, 8]")


@pytest.mark.long
def test_a_zone_is_drawn_by_its_corners_and_the_map_stays(watched, page, yard):
    plan_view(watched, yard)
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    box = page.locator(".muster-map-host").bounding_box()
    before = task_place(page, "1")
    for x, y in ((0.3, 0.3), (0.5, 0.3), (0.5, 0.6)):
        page.mouse.click(box["x"] + x * box["width"], box["y"] + y * box["height"])
    page.keyboard.press("Enter")
    page.get_by_label("ceiling_m").fill("3")
    page.get_by_role("button", name="Add the zone").dblclick()
    page.get_by_text("version 1, changed").wait_for()
    page.wait_for_function("getElement(document.querySelector('.muster-map')).stage.scene.zones.length === 1")
    assert task_place(page, "1") == before
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Move and choose").click()
    page.get_by_text("Click the corners of the zone").wait_for(state="hidden")
    corner = "getElement(document.querySelector('.muster-map')).stage.scene.zones[0].corners[2]"
    drawn = page.evaluate(corner)
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.6 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.7 * box["height"], steps=4)
    page.mouse.up()
    dragged = page.evaluate(corner)
    assert dragged[0] > drawn[0]
    text = text_of(page, f"[{dragged[0]:g}, {dragged[1]:g}]]")
    (polygon,) = re.findall(r"polygon: \[(.*?)\], ceiling_m: 3", text)
    corners = re.findall(r"\[([^\[\]]*), ([^\[\]]*)\]", polygon)
    assert len(corners) == 3
    assert all(len(number.partition(".")[2]) <= 2 for corner in corners for number in corner)
    page.click("#undo")
    page.click("#undo")
    page.get_by_text("version 1", exact=True).wait_for()


LAWN = """\
schema: muster/1
name: lawn
robots:
  - {id: r_0, position: [0, 0], speed_mps: 1}
tasks:
  - {id: lawn, action: {name: coverage, area: [[0, 5], [20, 5], [20, 15], [0, 15]], width_m: 2, split: 2}}
"""


def test_each_part_of_an_area_is_chosen_by_a_click_and_none_moves(watched, page):
    with Client(watched.origin) as client:
        mission = client.missions.create(LAWN).id
    plan_view(watched, mission)
    parts = page.evaluate(f"{SCENE}.tasks.map(({{ id }}) => id)")
    assert len(parts) == 2
    for part in parts:
        spot = task_place(page, part)
        page.mouse.click(spot["px"], spot["py"])
        expect(page.locator(".muster-map [aria-live]").first).to_contain_text(f"task {part};")
        assert page.locator(".muster-map-host").evaluate("host => host.style.cursor") == "pointer"
    page.locator(".muster-map-host").focus()
    page.keyboard.press("Alt+ArrowRight")
    page.mouse.move(spot["px"], spot["py"])
    page.mouse.down()
    page.mouse.move(spot["px"] + 60, spot["py"] + 30, steps=5)
    page.mouse.up()
    assert task_place(page, parts[-1])["x"] == spot["x"]
    expect(page.get_by_text("version 1", exact=True)).to_be_visible()
