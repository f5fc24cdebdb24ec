"""The list of missions, read slowly."""

import asyncio

import pytest
from tests.server.browser.conftest import Watched
from tests.server.serving import served

from muster.client import Client
from muster.server.services.missions import Missions

pytestmark = pytest.mark.xdist_group("watching")

EACH_WAS_SEEN = """words => {
  window.wordsSeen ??= new Set();
  for (const each of words) if (document.body.innerText.includes(each)) window.wordsSeen.add(each);
  return words.every(each => window.wordsSeen.has(each));
}"""
"""Whether all of these words have been on the page since it was first asked, be they gone again by now."""


def test_two_missions_are_duplicated_at_once_and_the_list_is_shown_once(chromium, tmp_path, monkeypatch):
    """The list is made anew by whichever is first, while the other is under way."""
    read = Missions.list

    async def slowly(self):
        await asyncio.sleep(0.5)
        return await read(self)

    monkeypatch.setattr(Missions, "list", slowly)
    with served(tmp_path) as url:
        page = Watched(chromium, url).page
        page.goto(f"{url}/")
        page.get_by_role("button", name="Duplicate 31T-6R50", exact=True).wait_for()
        page.evaluate(
            "names => names.forEach(name => document.querySelector(`[aria-label='Duplicate ${name}']`).click())",
            ["6T-2R", "31T-6R50"],
        )
        copies = ("6T-2R copy", "31T-6R50 copy")
        told = [f"is a copy of {name.removesuffix(' copy')}." for name in copies]
        page.wait_for_function(EACH_WAS_SEEN, arg=told)
        for name in copies:
            page.get_by_role("button", name=f"Delete {name}", exact=True).wait_for()
        page.wait_for_timeout(1500)
        assert page.locator("#missions").count() == 1
        for name in copies:
            page.get_by_role("button", name=f"Delete {name}", exact=True).click()
            page.get_by_role("button", name=f"Delete {name}", exact=True).wait_for(state="detached")
        with Client(url) as client:
            assert all(mission.shipped for mission in client.missions.list())
        page.close()
