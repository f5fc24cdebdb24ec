"""Missions are edited in the cells of the form."""

import re

import pytest
from playwright.sync_api import expect
from tests.muster_control.browser.missions_and_plan.plan_view import plan_view, text_of

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


@pytest.mark.long
def test_a_cell_of_the_form_changes_the_text_and_keeps_comments(watched, page):
    plan_view(watched, "floor")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of carrier").fill("0.75")
    page.keyboard.press("Tab")
    text = text_of(page, "speed_mps: 0.75")
    assert "# Source: Muster's own." in text
    assert "{id: carrier, position: [15.5, 9.5], heading_deg: 90, radius_m: 0.3, kinematics: differential-drive" in text
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of carrier").fill("fast")
    page.keyboard.press("Tab")
    page.get_by_text("'fast'; expected a number").wait_for()
    expect(page.get_by_label("speed_mps of carrier")).to_have_value("0.75")
    x = page.get_by_label("x of carrier", exact=True)
    x.fill("-1130.207654")
    page.keyboard.press("Tab")
    page.wait_for_function("cell => cell.scrollWidth <= cell.clientWidth", arg=x.element_handle())
    page.click("#undo")
    page.click("#undo")


@pytest.mark.long
def test_a_cell_is_that_of_its_task_though_another_is_taken_out_meanwhile(watched, page):
    plan_view(watched, "31T-6R50")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("type of 5", exact=True).wait_for()
    page.evaluate(
        """() => {
          document.querySelector("[aria-label='Remove 3']").click();
          const field = document.querySelector("[aria-label='type of 5']");
          field.value = "late";
          field.dispatchEvent(new Event("change"));
        }"""
    )
    page.get_by_label("type of 3", exact=True).wait_for(state="detached")
    page.wait_for_function("document.querySelector('#undo').ariaDisabled === 'false'")
    assert re.search(r"id: 5,.*type: late", text_of(page, "type: late"))
    page.click("#undo")
    page.click("#undo")
    page.get_by_text("shipped with Muster", exact=True).or_(page.get_by_text(re.compile("^version 1$"))).wait_for()


def test_what_is_being_typed_into_a_cell_stays_whatever_the_server_sends(watched, page, yard):
    plan_view(watched, yard)
    page.get_by_role("button", name="Form", exact=True).click()
    speed = page.get_by_label("speed_mps of r_0")
    speed.click()
    page.keyboard.press("Control+a")
    page.keyboard.type("0.7")
    rows = page.get_by_role("button", name=re.compile("^Remove"))
    before = rows.count()
    page.get_by_role("button", name="Add a row").last.dispatch_event("click")  # as an answer that comes now
    page.wait_for_function(f"document.querySelectorAll('.edit-table [aria-label^=Remove]').length > {before}")
    page.keyboard.type("5")
    assert speed.input_value() == "0.75"
    page.keyboard.press("Tab")
    page.keyboard.press("Control+s")
    page.get_by_text("version 2", exact=True).wait_for()
    assert speed.input_value() == "0.75"
    text_of(page, "speed_mps: 0.75")


@pytest.mark.long
def test_a_row_that_gets_another_id_stays_the_same_row(watched, page, yard):
    plan_view(watched, yard)
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("id of r_0", exact=True).click()
    page.keyboard.press("Control+a")
    page.keyboard.type("rover")
    page.keyboard.press("Tab")
    page.keyboard.type("2")
    page.get_by_label("x of rover", exact=True).wait_for()
    page.keyboard.type("5")
    page.keyboard.press("Tab")
    page.keyboard.press("Control+s")
    page.get_by_text("version 2", exact=True).wait_for()
    text_of(page, "{id: rover, position: [25, ")
