"""Missions are found in the list, copied, deleted and taken back."""

import re

import pytest
from tests.muster_control.browser.missions_and_plan.plan_view import own_missions

pytestmark = pytest.mark.xdist_group("missions and plan")  # a test goes on where the one before it ended


def copied(watched):
    return [name for name in own_missions(watched) if name.endswith("copy")]


def test_missions_are_found_made_deleted_and_taken_back(watched, page):
    watched.open("/")
    page.wait_for_selector("#missions")
    page.fill("#search", "31t 6r50")
    page.wait_for_function("() => document.querySelectorAll('#missions tr[data-name]').length === 3")
    assert page.url.endswith("/?search=31t%206r50")
    page.fill("#search", "no such")
    page.locator(".none-found").wait_for()
    page.fill("#search", "")
    page.get_by_role("button", name="Duplicate 6T-2R", exact=True).dblclick()
    row = page.locator("tr[data-name='6t-2r copy 6t-2r-copy']")
    row.wait_for()
    page.get_by_role("button", name="Delete 6T-2R copy").click()
    row.wait_for(state="detached")
    page.get_by_role("button", name="Undo").click()
    row.wait_for()
    assert copied(watched) == ["6T-2R copy"]


ROBOTS = b"id,lat,lon\nr_0,47.0001,8.0001\n"
PANELS = b"id,lat,lon,Remarks\nA1,47.0002,8.0002,dirty\nA2,47.0003,8.0001,\n"


def test_what_was_read_of_the_files_of_a_site_is_said_before_they_are_opened(watched, page):
    watched.open("/")
    page.get_by_role("button", name="New mission").click()
    files = [
        {"name": name, "mimeType": "text/csv", "buffer": data}
        for name, data in (("panels.csv", PANELS), ("robots.csv", ROBOTS))
    ]
    page.set_input_files("input[type=file]", files[:1])
    wrong = page.get_by_text("robots: missing; expected a sheet or file of robots")
    wrong.wait_for()
    page.get_by_label("Name", exact=True).fill("South roof")
    page.set_input_files("input[type=file]", files)
    wrong.wait_for(state="detached")
    for words in (
        "panels.csv: 2 tasks",
        "robots.csv: 1 robot",
        re.compile("origin_wgs84 chosen: "),
        re.compile("Remarks"),
    ):
        page.get_by_text(words).first.wait_for()
    page.get_by_role("button", name="Open it").click()
    page.wait_for_url("**/plan/South-roof")


AREA = b"""{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "West"}, "geometry":
{"type": "Polygon", "coordinates": [[[8, 47], [8.001, 47], [8.001, 47.001], [8, 47]]]}}]}"""


@pytest.mark.long
def test_what_a_site_does_not_say_is_asked_and_answered_without_choosing_its_files_again(watched, page):
    watched.open("/")
    page.get_by_role("button", name="New mission").click()
    page.set_input_files(
        "input[type=file]",
        [
            {"name": "fields.geojson", "mimeType": "application/json", "buffer": AREA},
            {"name": "robots.csv", "mimeType": "text/csv", "buffer": b"id,lat,lon,kind\nr_0,47.0001,8.0001,air\n"},
        ],
    )
    asked = page.get_by_text("undecided: no word says what it is; expected --as West=zone")
    asked.wait_for()
    page.get_by_text("What a site's files do not say").click()
    page.get_by_label("What features are").fill("West=survey")
    page.get_by_label("Height of surveys, m").fill("40")
    page.get_by_label("Width of the picture of their cameras, degrees").fill("60")
    page.get_by_label("Name", exact=True).fill("West field")
    page.get_by_role("button", name="Read them again").click()
    asked.wait_for(state="detached")
    page.get_by_text("fields.geojson: 1 area to survey").wait_for()
    page.get_by_role("button", name="Open it").click()
    page.wait_for_url("**/plan/West-field")
