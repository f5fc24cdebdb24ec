"""Missions are found in the list, copied, deleted and taken back."""

import pytest
from tests.server.browser.missions_and_plan.plan_view import own_missions

pytestmark = pytest.mark.xdist_group("missions and plan")  # a test goes on where the one before it ended

EACH_WAS_SEEN = """words => {
  window.wordsSeen ??= new Set();
  for (const each of words) if (document.body.innerText.includes(each)) window.wordsSeen.add(each);
  return words.every(each => window.wordsSeen.has(each));
}"""
"""Whether all of these words have been on the page since it was first asked, be they gone again by now."""


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


def test_two_missions_are_duplicated_at_once(watched, page):
    """The list is made anew by whichever is first, while the other is under way."""
    watched.open("/")
    page.get_by_role("button", name="Duplicate 31T-6R50", exact=True).wait_for()
    page.evaluate(
        "names => names.forEach(name => document.querySelector(`[aria-label='Duplicate ${name}']`).click())",
        ["6T-2R copy", "31T-6R50"],
    )
    copies = ["6T-2R copy copy", "31T-6R50 copy"]
    told = [f"is a copy of {name.removesuffix(' copy')}." for name in copies]
    page.wait_for_function(EACH_WAS_SEEN, arg=told)
    for name in copies:
        page.get_by_role("button", name=f"Delete {name}", exact=True).wait_for()
    for name in copies:
        page.get_by_role("button", name=f"Delete {name}", exact=True).click()
        page.get_by_role("button", name=f"Delete {name}", exact=True).wait_for(state="detached")
    assert copied(watched) == ["6T-2R copy"]
