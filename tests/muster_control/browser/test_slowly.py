"""Pages while database and workers are slow, or gone: of a server in this process, so that it can be held up."""

import asyncio
import threading
import time
from contextlib import contextmanager

import httpx
import pytest
from nicegui import Client as PageClient
from nicegui import core, ui
from tests.muster_control.serving import served as serving

from muster_control.client import Client
from muster_control.contract import StoreError
from muster_control.services.missions import Missions
from muster_control.services.plans import Plans
from muster_control.store.database import Database

pytestmark = pytest.mark.xdist_group("slowly")

MISSION = "6T-2R"
SCENE_MS = 90_000
EACH_WAS_SEEN = """words => {
  window.wordsSeen ??= new Set();
  for (const each of words) if (document.body.innerText.includes(each)) window.wordsSeen.add(each);
  return words.every(each => window.wordsSeen.has(each));
}"""
"""Whether all of these words have been on the page since it was first asked, be they gone again by now."""


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """Not that of conftest, which is another process: what is patched here would not reach it."""
    with serving(tmp_path_factory.mktemp("slowly")) as url:
        yield url


@pytest.fixture
def client(served):
    with Client(served) as client:
        yield client


class Held:
    """Answers of a service of the services wait until they are let go."""

    def __init__(self, monkeypatch, service, name, only):
        self._gate, self._answered = threading.Event(), threading.Event()
        answer = getattr(service, name)

        async def slow(asked, *what):
            if not only(*what):
                return await answer(asked, *what)
            await asyncio.to_thread(self._gate.wait)
            found = await answer(asked, *what)
            self._answered.set()
            return found

        monkeypatch.setattr(service, name, slow)

    def let_go(self):
        self._gate.set()

    def wait_for_answer(self):
        assert self._answered.wait(30)


@pytest.fixture
def hold(monkeypatch):
    held = []

    def hold(service, name, only=lambda *_: True):
        held.append(Held(monkeypatch, service, name, only))
        return held[-1]

    yield hold
    for one in held:
        one.let_go()


def wait_for(condition):
    until = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.02)


@pytest.mark.long
def test_the_plan_that_was_chosen_last_is_shown_and_carried_out(watched, client, hold):
    page = watched.page
    older, newer = (client.plan(MISSION, iterations=20, seed=seed).wait().id for seed in (1, 2))
    watched.open(f"/plan/{MISSION}")
    page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SCENE_MS)
    page.locator(".ordering").get_by_text("search", exact=True).wait_for()
    page.locator("table.robots").wait_for()
    held = hold(Plans, "get", only=lambda plan: plan == older)

    # the newest: the page of a test before may not have been put away yet
    *_, built = (one for one in PageClient.instances.values() if one.page.path == "/plan/{mission}")
    selects = (one for one in built.elements.values() if isinstance(one, ui.select))
    (choice,) = (one for one in selects if one.props.get("id") == "plans")

    def choose(plan):
        """As by the menu, which closes by itself where a slow page is laid out anew under it."""
        core.loop.call_soon_threadsafe(choice.set_value, plan)

    choose(older)
    page.locator("#carry-out").wait_for(state="detached")
    choose(newer)
    page.locator("table.robots").wait_for()
    held.let_go()
    held.wait_for_answer()
    page.locator("#carry-out").click()
    page.locator("#start").click()
    page.wait_for_url("**/live/*")
    run = client.runs()[0]
    assert run.plan == newer
    client.run(run.id).cancel()
    watched.require_clean()


@pytest.mark.long
def test_a_page_waits_for_a_database_that_takes_its_time(served, hold):
    """Beyond the three seconds after which NiceGUI would by itself show an error page."""
    held = hold(Missions, "list")
    threading.Timer(4.0, held.let_go).start()
    assert httpx.get(served, timeout=60).status_code == 200


@pytest.mark.long
def test_two_missions_are_duplicated_at_once_and_the_list_is_shown_once(watched, client, monkeypatch):
    """It is made anew by whichever is first, while the other is under way."""
    read, page = Missions.list, watched.page

    async def slowly(self, *which):
        await asyncio.sleep(0.5)
        return await read(self, *which)

    monkeypatch.setattr(Missions, "list", slowly)
    watched.open("/")
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
    assert not [mission.name for mission in client.missions.list() if mission.name.endswith("copy")]
    watched.require_clean()


@contextmanager
def gone():
    """The database can be read no more."""
    with pytest.MonkeyPatch.context() as patch:

        @contextmanager
        def reading(_):
            raise StoreError("the database is gone")
            yield

        patch.setattr(Database, "reading", reading)
        yield


@pytest.mark.long
def test_live_opens_and_stops_robots_while_the_database_is_gone(watched, client):
    page = watched.page
    run = client.start(client.plan(MISSION, iterations=20).wait(), speed=0.2).id
    client.run(run).act("pause")
    client.run(run).act("resume")
    watched.open(f"/live/{run}")
    page.locator(".run-state[data-state=running]").wait_for()
    with gone():
        watched.open(f"/live/{run}")
        page.locator(".run-state[data-state=running]").wait_for()
        page.keyboard.press(" ")
        page.locator(".run-state[data-state=paused]").wait_for()
        watched.open("/live")
        page.get_by_text("the database is gone").first.wait_for()
    client.run(run).cancel()
    watched.require_clean()


@pytest.mark.long
def test_live_and_records_open_while_workers_are_busy(watched, client, hold):
    page = watched.page
    run = client.start(client.plan(MISSION, iterations=20).wait(), speed=0.2).id
    held = hold(Missions, "read_keys")
    watched.open(f"/live/{run}")
    page.locator(".run-state[data-state=running]").wait_for()
    page.get_by_role("button", name="End the run").click()
    page.get_by_role("button", name="End it").click()
    page.get_by_text("The run is over (cancelled)").wait_for()
    page.get_by_role("link", name="Look at its record").click()
    page.get_by_role("link", name="Records", exact=True).wait_for()
    held.let_go()
    page.get_by_role("link", name="Log (JSON)").wait_for()
    watched.require_clean()


@pytest.mark.long
def test_a_page_with_unsaved_work_waits_longer_for_its_browser(watched, chromium, client, monkeypatch):
    monkeypatch.setattr(core.app.config, "reconnect_timeout", 0.1)
    text = client.missions.get(MISSION).text
    name = client.missions.create(text, name="kept").id

    def opened():
        before = set(PageClient.instances)
        page = chromium.new_page()
        page.goto(f"{watched.origin}/plan/{name}")
        page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SCENE_MS)
        (new,) = set(PageClient.instances) - before
        return page, new

    (edited, kept), (other, left) = opened(), opened()
    edited.locator(".muster-map-host").focus()
    edited.keyboard.press("p")
    edited.keyboard.press("Alt+ArrowRight")
    edited.get_by_text("version 1, changed").wait_for()
    edited.close()
    wait_for(lambda: not PageClient.instances[kept].has_socket_connection)
    other.close()
    wait_for(lambda: left not in PageClient.instances)
    assert kept in PageClient.instances
