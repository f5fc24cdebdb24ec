"""The view *Plan* of a mission with time windows, a deadline, a task that is late, and a team."""

import pytest
from playwright.sync_api import expect
from tests.report.page.conftest import TIMED, TIMED_ROUTES

from muster.mission.reading.plan_reader import plan_of
from muster_control.client import Client

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("timed plan")]


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


CELLS = {
    "window of boiler": ("10:05 to 10:20, 11:00 to 11:30", 'window: [["10:05", "10:20"], ["11:00", "11:30"]]'),
    "deadline of beam": ("10:02", 'deadline: "10:02"'),
    "duration_s of far": ("30", "duration_s: 30"),
    "needs of far": ("lift_kg: 30", "needs: {lift_kg: 30}"),
    "team of boiler": ("2; 1 requires=camera", "team: [{count: 2}, {count: 1, requires: [camera]}]"),
    "prerequisites of far": ("beam(5..60)", "prerequisites: [{task: beam, after_s: 5, within_s: 60}]"),
    "other_robot_than of far": ("boiler", "other_robot_than: [boiler]"),
    "shift of crawler": ("09:58 to 12:00", 'shift: ["09:58", "12:00"]'),
    "abilities of hauler": ("lift_kg: 40", "abilities: {lift_kg: 40}"),
    "min_tasks of hauler": ("1", "min_tasks: 1"),
}


def test_cells_of_times_and_teams_change_the_text(timed):
    page = timed.page
    page.get_by_role("button", name="Form", exact=True).click()
    for label, (typed, _) in CELLS.items():
        page.get_by_label(label, exact=True).fill(typed)
        page.keyboard.press("Tab")
    page.get_by_role("button", name="Text", exact=True).click()
    for _, written in CELLS.values():
        expect(page.locator(".cm-content")).to_contain_text(written)


@pytest.mark.parametrize(
    ("label", "typed", "told"),
    [
        ("window of boiler", "noon", "expected spans"),
        ("deadline_s of far", "soon", "expected a number"),
        ("team of boiler", "a camera", "expected parts"),
    ],
)
def test_a_cell_that_is_wrong_is_told_and_stays_as_it_was(timed, label, typed, told):
    page = timed.page
    page.get_by_role("button", name="Form", exact=True).click()
    cell = page.get_by_label(label, exact=True)
    before = cell.input_value()
    cell.fill(typed)
    page.keyboard.press("Tab")
    page.get_by_text(told).first.wait_for(timeout=10_000)
    expect(cell).to_have_value(before)


def test_a_cell_that_the_format_refuses_is_told_beside_the_form(timed):
    """It stands in the text, so that it can be mended there too."""
    page = timed.page
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("min_tasks of hauler", exact=True).fill("1.5")
    page.keyboard.press("Tab")
    told = page.locator(".findings").get_by_text("expected a whole number")
    told.wait_for(timeout=10_000)
    page.get_by_label("min_tasks of hauler", exact=True).fill("1")
    page.keyboard.press("Tab")
    told.wait_for(state="hidden")
