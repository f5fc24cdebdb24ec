"""Missions are planned, explained, exported, compared and carried out."""

import json
import re
import zipfile

import pytest
from playwright.sync_api import expect
from tests.muster_control.browser.missions_and_plan.plan_view import SLOW_MS, plan_view

from muster.mission.reading.plan_reader import plan_of
from muster_control.client import Client

pytestmark = pytest.mark.xdist_group("missions and plan")  # they share a server


def test_focus_is_seen_and_words_on_buttons_are_read_in_the_dark(watched, page):
    """Quasar says otherwise of both, and that it is important."""
    plan_view(watched, "6T-2R")
    page.keyboard.press("Tab")
    page.locator("#plan").focus()
    expect(page.locator("#plan")).to_have_css("outline-style", "solid")
    page.emulate_media(color_scheme="dark")
    expect(page.locator("#plan")).to_have_css("color", "rgb(23, 24, 27)")
    page.emulate_media(color_scheme="light")
    expect(page.locator("#plan")).to_have_css("color", "rgb(255, 255, 255)")


@pytest.mark.long
def test_a_run_that_failed_before_it_began_has_no_record_to_show(watched, page):
    with Client(watched.origin) as client:
        run = client.start(client.plan("yard", iterations=1).wait(), avoidance="rvo")
        run.wait()
    watched.open(f"/records/{run.id}")
    page.get_by_text("the mission is in space").wait_for()
    page.get_by_text("What users did").wait_for()
    assert page.locator("iframe, .downloads").count() == 0


def test_planning_shows_the_answer_says_why_and_exports(watched, page):
    plan_view(watched, "31T-6R50")
    page.get_by_label("Time limit, s").fill("1")
    page.click("#plan")
    page.wait_for_selector("table.robots", timeout=SLOW_MS)
    assert page.locator("dl.figures").inner_text().count("31 of 31") == 1
    expect(page.locator(".gantt rect.work")).to_have_count(31)
    page.locator(".chip", has_text=re.compile("^30$")).click()
    page.click("#why")
    page.get_by_text(re.compile("^Task 30 is done by")).wait_for(timeout=SLOW_MS)
    page.click("#export")
    with page.expect_download() as kept:
        page.get_by_text("Plan file (JSON)").click()
    assert json.loads(kept.value.path().read_text())["schema"] == "muster-plan/1"
    page.click("#export")
    greyed = page.locator(".q-item.disabled", has_text="GeoJSON")
    assert "needs origin_wgs84" in greyed.inner_text()
    page.keyboard.press("Escape")
    watched.shoot("plan")


FLAT = """\
schema: muster/1
name: flat
origin_wgs84: {lat_deg: 47, lon_deg: 8}
robots:
  - {id: rover, position: [0, 0]}
  - {id: kite, position: [3, 0], kind: air}
  - {id: lark, position: [6, 0], kind: air}
tasks:
  - {id: a, position: [5, 8]}
  - {id: b, position: [9, 8]}
"""


@pytest.mark.long
def test_drones_in_the_plane_get_heights_where_they_are_exported(watched, page):
    with Client(watched.origin) as client:
        mission = client.missions.create(FLAT).id
        client.plans.upload(mission, plan_of({"rover": [], "kite": ["a"], "lark": ["b"]}))
    watched.open(f"/plan/{mission}")
    page.wait_for_selector("table.robots", timeout=SLOW_MS)
    page.click("#export")
    page.get_by_text("QGroundControl", exact=True).click()
    page.get_by_label("Height above the start, m").fill("0")
    export = page.get_by_role("dialog").get_by_role("button", name="Export")
    export.click()
    page.get_by_text("expected more than 0 m").wait_for()
    page.get_by_label("Height above the start, m").fill("30")
    page.get_by_label("Step between drones, m").fill("5")
    watched.shoot("heights")
    with page.expect_download() as kept:
        export.click()
    with zipfile.ZipFile(kept.value.path()) as files:
        items = [json.loads(files.read(f"{drone}.plan"))["mission"]["items"] for drone in ("kite", "lark")]
    assert [max(item.get("Altitude", 0) for item in own) for own in items] == [30, 35]


@pytest.mark.long
def test_robots_keep_the_colours_of_the_plan_that_is_shown_while_others_come(watched, page):
    with Client(watched.origin) as client:
        made = client.missions.create(FLAT)
        client.plans.upload(made.id, plan_of({"rover": [], "kite": ["a"], "lark": ["b"]}))
        before = "  - {id: kite, position: [3, 0], kind: air}\n"
        text = FLAT.replace(before, f"  - {{id: extra, position: [9, 0]}}\n{before}")
        client.missions.save(made.id, text, base_version=1)
    watched.open(f"/plan/{made.id}")
    page.wait_for_selector("table.robots", timeout=SLOW_MS)
    stage = "getElement(document.querySelector('.muster-map')).stage"
    page.wait_for_function(f"{stage}.routes.length === 3")
    colours = page.evaluate(f"Object.fromEntries({stage}.places.robotIndex)")
    assert colours == {"rover": 0, "kite": 1, "lark": 2, "extra": 3}
    swatches = page.locator("table.robots .swatch")
    assert [swatches.nth(k).get_attribute("style") for k in range(3)] == [f"background: var(--c{k})" for k in range(3)]
    assert "done by kite" in page.evaluate(
        f"import('muster-map/words.js').then(({{ told }}) => told({stage}, {{ what: 'task', id: 'a' }}))"
    )
    watched.shoot("colours")


@pytest.mark.long
def test_two_plans_are_compared_side_by_side(watched, page):
    with Client(watched.origin) as client:
        client.plan("31T-6R50", iterations=300).wait()
    plan_view(watched, "31T-6R50")
    page.get_by_label("Allocator").click()
    page.get_by_role("option", name="greedy", exact=True).click()
    page.click("#plan")
    page.get_by_text("Left out (4)").wait_for(timeout=SLOW_MS)
    page.get_by_role("button", name="Compare").click()
    page.get_by_text(re.compile("tasks are done by another robot")).wait_for(timeout=SLOW_MS)
    assert page.locator(".muster-map").count() == 2
    watched.shoot("compare")
