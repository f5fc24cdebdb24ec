"""What is saved, by whom, and who is asked before something is lost."""

import re

import pytest
from tests.muster_control.browser.missions_and_plan.plan_view import SLOW_MS, choose_task, plan_view, text_of

from muster_control.client import Client

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


@pytest.mark.long
def test_who_saves_second_is_told_and_asked(watched, page, chromium, yard):
    plan_view(watched, yard)
    other = chromium.new_page()
    other.goto(f"{watched.origin}/plan/{yard}")
    other.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    for one, speed in ((other, "2"), (page, "3")):
        one.get_by_role("button", name="Form", exact=True).click()
        one.get_by_label("speed_mps of r_0").fill(speed)
        one.keyboard.press("Tab")
        one.keyboard.press("Control+s")
    other.get_by_text("version 2", exact=True).wait_for()
    page.get_by_text("Somebody else has saved this mission").wait_for()
    page.get_by_role("button", name="Save mine on top").click()
    page.get_by_text("version 3", exact=True).wait_for()
    other.close()
    page.get_by_role("button", name="History").click()
    page.get_by_role("row", name=re.compile("version 1 ")).get_by_role("button", name="Restore").click()
    page.get_by_text("version 4", exact=True).wait_for()
    text_of(page, "speed_mps: 1}")


def test_saving_twice_at_once_is_no_conflict(watched, page, yard):
    plan_view(watched, yard)
    choose_task(page, "1")
    page.keyboard.press("Alt+ArrowRight")
    page.get_by_text("version 1, changed").wait_for()
    for _ in range(3):
        page.keyboard.press("Control+s")
    page.get_by_text("version 2", exact=True).wait_for()
    page.keyboard.press("Control+s")
    page.get_by_text("Nothing has changed since the last version.").first.wait_for()
    assert not page.get_by_text("Somebody else has saved this mission").count()
    with Client(watched.origin) as client:
        assert client.missions.get(yard).version == 2


def test_the_page_asks_before_one_leaves_it_right_after_an_edit(watched, page, yard):
    plan_view(watched, yard)
    choose_task(page, "1")
    asks = page.evaluate(
        """() => {
          const key = new KeyboardEvent("keydown", { key: "ArrowRight", altKey: true });
          document.querySelector(".muster-map-host").dispatchEvent(key);
          return window.musterUnsaved;
        }"""
    )
    assert asks
    page.get_by_text("version 1, changed").wait_for()
    page.keyboard.press("Control+z")
    page.wait_for_function("window.musterUnsaved === false")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of r_0").wait_for()
    asks = page.evaluate(
        """() => {
          const field = document.querySelector("[aria-label='speed_mps of r_0']");
          field.value = "fast";
          field.dispatchEvent(new Event("change"));
          return window.musterUnsaved;
        }"""
    )
    assert asks
    page.get_by_text("'fast'; expected a number").wait_for()
    page.wait_for_function("window.musterUnsaved === false")


def test_a_zone_that_is_drawn_and_not_added_leaves_nothing_to_save(watched, page, yard):
    plan_view(watched, yard)
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    page.locator(".muster-map-host").focus()
    for key in (" ", "ArrowRight", " ", "ArrowDown", " ", "Enter"):
        page.keyboard.press(key)
    assert page.evaluate("window.musterUnsaved")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("window.musterUnsaved === false")
