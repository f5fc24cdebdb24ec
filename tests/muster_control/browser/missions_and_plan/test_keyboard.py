"""Missions are edited on the map by the keyboard alone, also faster than answers come."""

import re

import pytest
from tests.muster_control.browser.missions_and_plan.plan_view import SCENE, choose_task, plan_view, task_place

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


def test_the_keyboard_alone_chooses_and_moves_a_task(watched, page, yard):
    plan_view(watched, yard)
    page.locator(".muster-map-host").focus()
    page.keyboard.press("p")
    page.get_by_text("task 1; at 5, 8 m").wait_for(state="attached")
    page.keyboard.press("Alt+ArrowRight")
    page.get_by_text(re.compile("version 1, changed")).wait_for()
    page.keyboard.press("?")
    assert page.get_by_role("dialog", name="Keyboard").is_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("Control+z")
    page.get_by_text("version 1", exact=True).wait_for()


def test_the_keyboard_alone_adds_a_task_and_a_zone(watched, page, yard):
    plan_view(watched, yard)
    scene = "getElement(document.querySelector('.muster-map')).stage.scene"
    tasks = page.evaluate(f"{scene}.tasks.length")
    clicks, ground = page.get_by_role("combobox", name="What a click on the map does"), page.locator(".muster-map-host")
    clicks.click()
    page.get_by_role("option", name="Add tasks").click()
    page.get_by_text("Click where the new task is").wait_for()
    ground.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    page.get_by_text("version 1, changed").wait_for()
    page.wait_for_function(f"{scene}.tasks.length === {tasks + 1}")
    clicks.click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    ground.focus()
    for key in (" ", "ArrowRight", " ", "ArrowDown", " ", "Enter"):
        page.keyboard.press(key)
    page.get_by_role("button", name="Add the zone").click()
    page.wait_for_function(f"{scene}.zones.length === 1")


def test_undo_right_after_a_nudge_takes_it_back(watched, page, yard):
    plan_view(watched, yard)
    before = task_place(page, "1")
    choose_task(page, "1")
    page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("Control+z")
    page.wait_for_selector("#redo[aria-disabled=false]")
    page.get_by_text("version 1", exact=True).wait_for()
    page.wait_for_function(f"{SCENE}.tasks.find(({{ id }}) => id === '1').x === {before['x']}")


@pytest.mark.long
def test_what_is_nudged_on_and_on_never_jumps_back(watched, page, yard):
    plan_view(watched, yard)
    choose_task(page, "1")
    page.evaluate(
        """() => {
          const { stage } = getElement(document.querySelector('.muster-map'));
          window.seen = [];
          const show = stage.show;
          stage.show = (scene) => { show.call(stage, scene); window.seen.push(stage.places.tasks.get('1').x); };
          window.nudged = [];
          const place = stage.place;
          stage.place = (one, x, y) => { place.call(stage, one, x, y); window.nudged.push([x, window.seen.length]); };
        }"""
    )
    for _ in range(40):
        page.keyboard.press("Alt+ArrowRight", delay=40)
    last = page.evaluate("nudged.at(-1)[0]")
    page.wait_for_function(f"seen.at(-1) === {last}")
    moved = [x for x, _ in page.evaluate("nudged")]
    assert moved == sorted(set(moved))
    for _ in moved:
        page.keyboard.press("Control+z")
    page.get_by_text("version 1", exact=True).wait_for()


@pytest.mark.long
def test_delete_pressed_on_and_on_takes_out_one_zone(watched, page):
    plan_view(watched, "yard")
    zones = page.evaluate(f"{SCENE}.zones.length")
    assert zones > 1
    page.evaluate("getElement(document.querySelector('.muster-map')).heard('choose', {what: 'zone', id: 0, corner: 0})")
    page.locator(".muster-map-host").focus()
    page.keyboard.down("Delete")
    page.keyboard.down("Delete")
    page.keyboard.up("Delete")
    page.keyboard.press("Delete")
    page.wait_for_function(f"{SCENE}.zones.length < {zones}")
    page.keyboard.press("Control+z")
    page.wait_for_function(f"{SCENE}.zones.length === {zones}")
    page.wait_for_selector("#undo[aria-disabled=true]")
