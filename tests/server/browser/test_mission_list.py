"""The list of missions, read slowly."""

import asyncio

import pytest
from tests.server.browser.conftest import Watched
from tests.server.serving import served

from muster.server.services.missions import Missions

pytestmark = pytest.mark.xdist_group("watching")


def test_a_list_that_is_read_twice_at_once_is_shown_once(chromium, tmp_path, monkeypatch):
    read = Missions.list

    async def slowly(self):
        await asyncio.sleep(0.3)
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
        for name in ("6T-2R copy", "31T-6R50 copy"):
            page.get_by_role("button", name=f"Delete {name}", exact=True).wait_for()
        page.wait_for_timeout(900)
        assert page.locator("#missions").count() == 1
        page.close()
