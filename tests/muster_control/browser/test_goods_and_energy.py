"""The view *Plan* of a mission with goods, batteries and stations: map, form, time chart."""

import pytest
from playwright.sync_api import expect

from muster.mission.reading.plan_reader import plan_of
from muster_control.client import Client

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("goods and energy")]

YARD = """\
schema: muster/1
name: yard
rules: {timing: constant}
stations:
  - {id: dock, position: [40, 0], services: [charge], charge_per_s: 2}
  - {id: bin, position: [40, 30], services: [unload]}
robots:
  - {id: r, position: [0, 0], load_capacity: 4, battery: {capacity: 60, reserve: 0.1}}
  - {id: s, position: [0, 30], battery: {capacity: 60, at_start: 0.9}}
tasks:
  - {id: a, position: [20, 0], load: 3, duration_s: 10}
  - {id: b, position: [60, 20], delivers: a, duration_s: 10}
  - {id: c, position: [60, 0], duration_s: 10}
"""
ROUTES = {"r": ["a", "dock", "b"], "s": ["dock", "c"]}


@pytest.fixture(scope="module")
def yard(watched):
    """A page that shows the plan of the mission."""
    with Client(watched.origin) as client:
        mission = client.missions.create(YARD)
        client.plans.upload(mission.id, plan_of(ROUTES))
    watched.open(f"/plan/{mission.id}")
    watched.page.wait_for_selector(".gantt rect.work", timeout=90_000)
    yield watched
    watched.require_clean()


def test_the_time_chart_has_services_waiting_for_a_slot_and_levels(yard):
    page = yard.page
    services = page.locator(".gantt rect.service")
    labels = [services.nth(k).get_attribute("aria-label") for k in range(services.count())]
    assert labels == [
        "r adds 40.00 to its battery at [dock]: 50.0 to 70.0 s",
        "s adds 56.00 to its battery at [dock]: 70.0 to 98.0 s",
    ]
    waiting = page.locator(".gantt rect.waiting")
    assert waiting.get_attribute("aria-label") == "s waits at [dock]: 50.0 to 70.0 s"
    assert page.locator(".gantt path.level").count() == 2
    assert page.locator(".gantt line.reserve").count() == 1
    legend = [words.strip() for words in page.locator(".gantt .legend > span").all_text_contents()]
    assert {"[station]", "battery, empty to full"} <= set(legend)
    yard.shoot("goods-and-energy")


def test_the_order_of_a_route_names_stations_which_can_be_chosen_there_and_in_the_chart(yard):
    page = yard.page
    chips = page.locator("table.robots tr").nth(1).locator(".chip")
    assert chips.all_text_contents() == ["a", "[dock]", "b"]
    chips.nth(1).click()
    expect(page.locator(".muster-map [aria-live]").first).to_have_text("station dock; charge; at 40, 0 m; serves r, s")
    page.locator(".gantt rect.work").first.click()
    page.locator(".gantt rect.service").first.click()
    expect(page.locator(".muster-map [aria-live]").first).to_contain_text("station dock")


def test_a_run_tells_what_batteries_have_left_and_what_was_cancelled(yard):
    page = yard.page
    with Client(yard.origin) as client:
        plan = client.plans.list()[0]
        run = client.start(plan.id, speed=0.5)
        run.act("event", cancel_task="c")
        yard.open(f"/live/{run.id}")
        expect(page.locator("table.robots th").nth(2)).to_have_text("battery")
        expect(page.locator("table.robots .spent").first).to_contain_text("% left")
        page.get_by_text("s goes to [dock] (90 % in its battery)").wait_for()
        yard.shoot("live-batteries")
        run.act("speed", speed=None)
        page.get_by_text("The run is over (ended): 2 tasks done, 0 not, 1 cancelled.").wait_for()
    page.get_by_text("task c is not done: cancelled at").wait_for()
    page.get_by_text("report: 2 tasks done, 1 cancelled,").wait_for()
    page.get_by_text("plan: 3 tasks, 2 robots").wait_for()
    yard.shoot("live-cancelled")
    yard.open(f"/plan/{plan.mission}")
    page.wait_for_selector(".gantt rect.work", timeout=90_000)


CELLS = {
    "load of a": ("2,5", "load: 2.5"),
    "delivers of c": ("", ""),
    "load_capacity of s": ("6", "load_capacity: 6"),
    "battery of s": ("capacity 70, at_start 0.9", "battery: {capacity: 70, at_start: 0.9}"),
    "services of bin": ("swap unload", "services: [swap, unload]"),
    "swap_s of bin": ("30", "swap_s: 30"),
    "slots of dock": ("2", "slots: 2"),
    "partial of dock": ("false", "partial: false"),
    "x of dock": ("42", "position: [42, 0]"),
    "id of bin": ("rack", "id: rack"),
}


def test_cells_of_goods_batteries_and_stations_change_the_text(yard):
    page = yard.page
    page.get_by_role("button", name="Form", exact=True).click()
    for label, (typed, _) in CELLS.items():
        cell = page.get_by_label(label, exact=True)
        cell.select_option(typed) if label.startswith("partial") else cell.fill(typed)
        page.keyboard.press("Tab")
    yard.shoot("goods-and-energy-form")
    page.get_by_role("button", name="Text", exact=True).click()
    for _, written in CELLS.values():
        expect(page.locator(".cm-content")).to_contain_text(written)


def test_stations_are_placed_moved_and_removed_on_the_map(yard):
    page = yard.page
    page.get_by_role("button", name="Map", exact=True).click()
    page.get_by_label("What a click on the map does").click()
    page.get_by_role("option", name="Add stations").click()
    host = page.locator(".muster-map-host").first
    host.focus()
    page.keyboard.press("Enter")
    rows = page.locator(".muster-map table tr:has(td:text-is('station'))")
    expect(rows).to_have_count(3)
    expect(rows.last).to_contain_text("station_0")
    page.keyboard.press("Escape")
    page.keyboard.press("p")
    expect(page.locator(".muster-map [aria-live]").first).to_contain_text("station station_0")
    before = rows.last.text_content()
    page.keyboard.press("Alt+ArrowRight")
    expect(rows.last).not_to_have_text(before)
    page.keyboard.press("Delete")
    expect(rows).to_have_count(2)
