"""Every list is read page by page: no query reads more rows than a page has, whatever there is."""

import sqlite3
from contextlib import closing, contextmanager

import httpx
import pytest
from playwright.sync_api import expect
from sqlalchemy import Engine, event
from tests.muster_control.browser.conftest import running_chromium
from tests.muster_control.long_lists import LISTS, PAGES, fill
from tests.muster_control.serving import served

from muster_control.api import api
from muster_control.client import Client
from muster_control.contract import MOST_ROWS, PAGE_ROWS
from muster_control.services.shipped import shipped_entries
from muster_control.store.store import Store

ROWS = 600
NO_ROWS_OF_THE_DATABASE = {"/allocators"}
SHOWN = {
    "/records/1": "summary:has-text('What users did (500, the newest)')",
    "/plan": ".mission-link",
    "/plan/yard-1": "button:has-text('Older plans')",
}
"""What is seen of a page when all of it is read."""
FILTERS = ("mission=yard-1", "state=done", "run=1", "search=yard")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The URL of a server with long lists, and its database."""
    folder = tmp_path_factory.mktemp("served")
    file = folder / "muster.db"
    store = Store.open(f"sqlite:///{file}")
    fill(store, ROWS)
    store.close()
    with served(folder) as url:
        yield url, file


@contextmanager
def queries():
    """All SELECTs within the block, with their parameters."""
    found = []

    def note(connection, cursor, statement, parameters, *_):
        if statement.lstrip().startswith("SELECT"):
            found.append((statement, parameters))

    event.listen(Engine, "before_cursor_execute", note)
    try:
        yield found
    finally:
        event.remove(Engine, "before_cursor_execute", note)


def require_bounded(file, asked):
    """Each query yields a page at most, in the order of an index; and there were some."""
    assert asked
    with closing(sqlite3.connect(file)) as database:
        for statement, parameters in asked:
            (rows,) = database.execute(f"SELECT count(*) FROM ({statement})", parameters).fetchone()
            assert rows <= MOST_ROWS + 1, statement
            how = database.execute(f"EXPLAIN QUERY PLAN {statement}", parameters).fetchall()
            assert "B-TREE" not in str(how), statement


def lists_described():
    """The paths of the API whose answers are lists."""
    paths = api(lambda: None).openapi()["paths"]
    for path, methods in paths.items():
        schema = methods.get("get", {}).get("responses", {}).get("200", {}).get("content", {})
        if schema.get("application/json", {}).get("schema", {}).get("type") == "array":
            yield path, methods["get"]


def test_each_list_of_the_api_is_one_of_these_and_says_how_it_goes_on():
    described = dict(lists_described())
    filled = {path.format(mission="yard-1", run=1): path for path in described}
    assert set(filled) - NO_ROWS_OF_THE_DATABASE == set(LISTS)
    for path in LISTS:
        operation = described[filled[path]]
        limit = next(one for one in operation["parameters"] if one["name"] == "limit")["schema"]
        assert (limit["default"], limit["maximum"]) == (PAGE_ROWS, MOST_ROWS)
        assert {"after", "before"} & {one["name"] for one in operation["parameters"]}
        assert 'rel="next"' in operation["responses"]["200"]["headers"]["Link"]["description"]


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("path", LISTS)
def test_a_list_is_answered_page_by_page(site, path):
    url, file = site
    with httpx.Client(base_url=url, timeout=60) as http, queries() as asked:
        address, pages = f"/api/v1{path}", []
        while address is not None:
            answer = http.get(address)
            pages.append(answer.json())
            address = answer.links.get("next", {}).get("url")
        assert http.get(f"/api/v1{path}", params={"limit": MOST_ROWS + 1}).status_code == 422
        most = http.get(f"/api/v1{path}", params={"limit": MOST_ROWS})
    require_bounded(file, asked)
    shipped = len(shipped_entries()) if path == "/missions" else 0
    assert [len(page) for page in pages[:-1]] == [PAGE_ROWS] * (len(pages) - 1)
    rows = [row for page in pages for row in page]
    assert len(rows) == ROWS + shipped
    assert len({str(row) for row in rows}) == len(rows)
    assert most.json() == rows[:MOST_ROWS]


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("path", LISTS)
def test_filters_stay_from_page_to_page(site, path):
    known = {one["name"] for one in dict(lists_described())[_template(path)]["parameters"] if one["in"] == "query"}
    url, file = site
    with httpx.Client(base_url=url, timeout=60) as http, queries() as asked:
        for filtered in (one for one in FILTERS if one.partition("=")[0] in known):
            answer = http.get(f"/api/v1{path}?{filtered}")
            assert len(answer.json()) == PAGE_ROWS
            assert filtered in answer.links["next"]["url"]
            http.get(answer.links["next"]["url"]).raise_for_status()
            require_bounded(file, asked)


def _template(path):
    return path.replace("yard-1", "{mission}").replace("/1/", "/{run}/")


@pytest.fixture(scope="module")
def chromium():
    with running_chromium() as browser:
        yield browser


@pytest.mark.long
@pytest.mark.parametrize("path", PAGES)
def test_a_page_reads_no_more_rows_than_it_shows(site, chromium, path):
    url, file = site
    page = chromium.new_page()
    page.route("**/page.html", lambda route: route.abort())  # the replay: a file that a worker makes of the whole log
    with queries() as asked:
        page.goto(url + path)
        page.locator(SHOWN.get(path, "table.plain")).first.wait_for()
    require_bounded(file, asked)
    assert page.locator("tr").count() <= 2 * MOST_ROWS + 10
    page.close()


@pytest.mark.long
def test_pages_lead_to_the_next_rows(site, chromium):
    page = chromium.new_page()
    page.goto(site[0] + "/")
    seen = []
    for links in (["Next page"], ["First page", "Next page"]):
        page.locator("#missions").wait_for()
        seen += page.locator("#missions .mission-link").all_inner_texts()
        assert page.locator(".pager a").all_inner_texts() == links
        page.get_by_role("link", name="Next page").click()
        page.wait_for_url(lambda url, after=f"~{seen[-1]}": url.endswith(after))
    assert len(set(seen)) == 2 * PAGE_ROWS
    page.goto(site[0] + "/records?mission=yard-1")
    page.get_by_role("link", name="Next page").click()
    page.get_by_role("link", name=f"Run {ROWS - PAGE_ROWS}", exact=True).wait_for()
    page.goto(f"{site[0]}/records/1?after=500")
    page.locator("summary", has_text=f"Events 501 to {ROWS}").wait_for()
    page.close()


@pytest.mark.long
def test_older_plans_and_versions_are_listed_when_they_are_asked_for(site, chromium):
    page = chromium.new_page()
    page.goto(f"{site[0]}/plan/yard-1")
    page.get_by_role("button", name="Older plans").click()
    page.locator(".plan-choice").click()
    page.get_by_role("option").first.wait_for()
    page.keyboard.press("End")
    page.get_by_role("option", name=f"{ROWS - 2 * PAGE_ROWS + 1}: greedy").wait_for()
    page.keyboard.press("Escape")
    page.get_by_text("History", exact=True).click()
    rows = page.locator(".versions tr")
    expect(rows).to_have_count(PAGE_ROWS, timeout=30_000)
    page.get_by_role("button", name="Older versions").click()
    expect(rows).to_have_count(2 * PAGE_ROWS, timeout=30_000)
    page.close()


def test_missions_are_found_by_all_words_of_their_names_and_ids(site):
    with httpx.Client(base_url=f"{site[0]}/api/v1", timeout=60) as http:

        def found(search):
            return [entry["id"] for entry in http.get("/missions", params={"search": search, "limit": 500}).json()]

        assert found("YARD 600") == ["yard-600"]
        assert found("31t 6r50") == [name for name in shipped_entries() if "31T" in name and "6R50" in name]
        assert found("%") == found("no such") == []
        assert len(found("rd-59")) == 11


def test_a_place_in_the_list_of_missions_that_is_none_is_refused(site):
    for after in ("yesterday", "2026~yard-1", "2026-11-29T12:00:00~yard-1"):
        answer = httpx.get(f"{site[0]}/api/v1/missions", params={"after": after})
        assert (answer.status_code, f"after: {after}; expected" in answer.json()["error"]) == (400, True)


@pytest.mark.long
def test_the_client_goes_from_page_to_page(site):
    with Client(site[0]) as client:
        assert len(client.missions.list()) == ROWS + len(shipped_entries())
        assert [mission.id for mission in client.missions.list(search="yard-600")] == ["yard-600"]
        plans = client.plans.list("yard-1", limit=None)
        assert [plan.id for plan in plans] == list(range(ROWS, 0, -1))
        assert client.plans.list("yard-1", limit=MOST_ROWS + 30) == plans[: MOST_ROWS + 30]
        assert client.plans.list(limit=3, before=plans[9].id) == plans[10:13]
        assert len(client.records.list()) == len(client.runs()) == len(client.jobs(limit=None)) == ROWS
        assert len(client.jobs()) == len(client.actions()) == 200
        assert [entry.seq for entry in client.run(1).events(after=20)] == list(range(21, ROWS + 1))
