"""Missions are found in the list, copied, deleted and taken back."""

import pytest
from tests.server.browser.missions_and_plan.plan_view import own_missions

pytestmark = pytest.mark.xdist_group("missions and plan")  # a test goes on where the one before it ended


def copied(watched):
    return [name for name in own_missions(watched) if name.endswith("copy")]


def test_missions_are_found_made_deleted_and_taken_back(watched, page):
    watched.open("/")
    page.wait_for_selector("#missions")
    page.fill("#search", "31t 6r50")
    shown = page.locator("#missions tr[data-name]:visible")
    assert shown.count() == 3
    page.fill("#search", "no such")
    assert page.locator(".none-found").is_visible()
    page.fill("#search", "")
    page.get_by_role("button", name="Duplicate 6T-2R", exact=True).dblclick()
    row = page.locator("tr[data-name='6t-2r copy 6t-2r-copy']")
    row.wait_for()
    page.get_by_role("button", name="Delete 6T-2R copy").click()
    row.wait_for(state="detached")
    page.get_by_role("button", name="Undo").click()
    row.wait_for()
    assert copied(watched) == ["6T-2R copy"]
