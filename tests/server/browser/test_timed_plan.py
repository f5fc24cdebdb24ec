"""The view *Plan* of a mission with time windows, a deadline, a task that is late, and a team."""

import pytest
from playwright.sync_api import expect
from tests.report.page.conftest import TIMED, TIMED_ROUTES

from muster.client import Client
from muster.mission.plan_reader import plan_of

pytestmark = pytest.mark.xdist_group("timed plan")


@pytest.fixture(scope="module")
def timed(watched):
    """A page that shows the plan of a timed mission."""
    with Client(watched.origin) as client:
        mission = client.missions.create(TIMED)
        client.plans.upload(mission.id, plan_of(TIMED_ROUTES))
    watched.open(f"/plan/{mission.id}")
    watched.page.wait_for_selector(".gantt rect.work", timeout=90_000)
    yield watched
    watched.require_clean()


def box(page, selector):
    found = page.locator(f".gantt {selector}").first.bounding_box()
    return found["x"], found["x"] + found["width"], found["y"], found["y"] + found["height"]


def test_limits_of_time_are_drawn_where_they_are(timed):
    page = timed.page
    begins, ends, high, low = box(page, "rect.work[aria-label*='boiler']")
    left, right, top, bottom = box(page, "rect.window[data-task=boiler]")
    assert left == pytest.approx(begins, abs=1.5)
    assert right >= ends - 1
    assert top < high < low < bottom
    late = box(page, "rect.late")
    assert late[:2] == pytest.approx(((begins + ends) / 2, ends), abs=1.5)
    expect(page.locator(".gantt rect.late")).to_have_css("fill", "rgb(176, 0, 32)")
    assert page.locator(".gantt line.due").count() == 1
    assert page.locator(".gantt line.deadline[data-task=beam]").count() == 2


def test_a_team_is_linked_and_says_who_it_is(timed):
    page = timed.page
    bars = page.locator(".gantt rect.work[aria-label*='beam']")
    assert bars.count() == 2
    left = bars.first.bounding_box()["x"]
    link = page.locator(".gantt g.team line")
    assert link.bounding_box()["x"] == pytest.approx(left, abs=1.5)
    assert page.locator(".gantt g.team title").text_content() == "crawler and hauler do beam together"


def test_waiting_is_hatched_and_work_is_not(timed):
    page = timed.page
    looks = {kind: page.locator(f".gantt rect.{kind}").first.get_attribute("style") for kind in ("waiting", "work")}
    assert "url(" in looks["waiting"]
    assert "url(" not in looks["work"]


def test_times_are_by_the_clock_and_the_legend_names_what_is_drawn(timed):
    page = timed.page
    assert "10:00:00 to 10:01:00" in page.locator(".gantt rect.work[aria-label*='boiler']").get_attribute("aria-label")
    ticks = page.locator(".gantt svg > g > text").all_text_contents()
    assert "09:58:00" in ticks
    legend = [words.strip() for words in page.locator(".gantt .legend > span").all_text_contents()]
    assert {"time window", "deadline", "due time", "late", "team"} <= set(legend)
    timed.shoot("timed-plan")
