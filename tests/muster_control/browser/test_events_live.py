"""The live page shows each kind of event: in the list of events, on the map, in the tables and at what is selected."""

import pytest
from playwright.sync_api import expect
from tests.state.drawn_events import one_of_each, tied_site

from muster.mission.yaml_writer import yaml_text
from muster.state.event import KINDS
from muster.state.words import ALARM, DETAIL, words_of
from muster_control.client import Client

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("events live")]
TAKE = """(entries) => {
  const frame = document.querySelector(".muster-live-frame").id.slice(1);
  const { view } = getElement(Number(frame));
  for (const entry of entries) view.take({ type: "entry", ...entry });
  view.showPanels();
}"""


@pytest.fixture(scope="module")
def run(watched):
    """A run that is paused, on its page."""
    with Client(watched.origin) as client:
        mission = client.missions.create(yaml_text(tied_site()))
        run = client.start(client.plan(mission.id, iterations=50).wait(), speed=0.1)
        watched.open(f"/live/{run.id}")
        watched.page.locator("li[data-kind=sets_out]").first.wait_for()
        run.act("pause")
        watched.page.locator(".run-state[data-state=paused]").wait_for()
        yield run
        run.cancel()
    watched.require_clean()


def row(watched, name):
    return watched.page.locator(f"tr[data-site='{name}'] td")


def test_a_station_that_fails_is_marked_until_it_serves_again_and_a_door_until_it_opens(watched, run):
    expect(row(watched, "station rack")).to_have_text("serves")
    expect(row(watched, "door a")).to_have_text("open")
    run.act("event", station_fails="rack")
    run.act("event", door_closes="a")
    run.act("resume")
    expect(row(watched, "station rack")).to_have_text("⚠ failed, serves nobody")
    expect(row(watched, "door a")).to_have_text("⚠ closed")
    watched.shoot("live-station-failed")
    run.act("event", station_returns="rack")
    run.act("event", door_opens="a")
    expect(row(watched, "station rack")).to_have_text("serves")
    expect(row(watched, "door a")).to_have_text("open")
    run.act("pause")


def entry(k, kind, **data):
    return {"seq": 9000 + k, "time_s": 60.0, "kind": kind, "data": data, **words_of(kind, data)}


def test_what_is_selected_says_why_it_is_not_done(watched, run):
    told = [
        entry(0, "task_refused", task="t_1", robot="r_0", reason="skill: lift"),
        entry(1, "window_missed", task="t_1", reason="window: closed at 20 s", next_s=None),
        entry(5, "delay_task", task="t_1", by_s=4.0),
        entry(2, "ends", task="t_2", robot="r_0"),
        entry(3, "load_lies", task="t_2", robot="r_0", position=[1.0, 2.0], load={"kg": 1.0}),
        entry(4, "twice", task="t_2", robots=["r_0", "r_1"]),
    ]
    watched.page.evaluate(TAKE, told)
    chosen = watched.page.locator(".chosen")
    watched.page.locator("li[data-kind=task_refused]").first.click()
    watched.page.locator("li[data-kind=window_missed]").first.click()
    expect(chosen).to_contain_text("r_0: skill: lift")
    expect(chosen).to_contain_text("window: closed at 20 s")
    expect(chosen).to_contain_text("by 4 s")
    watched.page.locator("li[data-kind=twice]").first.click()
    expect(chosen).to_contain_text("lies where r_0 failed")
    expect(chosen).to_contain_text("begun by r_0 and r_1")


def test_each_kind_of_event_has_its_line_and_its_mark(watched, run):
    told = one_of_each()
    assert {one["kind"] for one in told} == set(KINDS)
    entries = [{**one, "seq": 10_000 + k, **words_of(one["kind"], one["data"])} for k, one in enumerate(told)]
    watched.page.evaluate(TAKE, entries)
    for one in entries:
        item = watched.page.locator(f"li[data-kind={one['kind']}]").first
        if one["mark"] == DETAIL:
            expect(item).to_have_count(0)
            continue
        sign = "⚠ " if one["mark"] == ALARM else ""
        expect(item.locator("span")).to_have_text(f"{sign}{one['line']}")
        expect(item).to_have_class(one["mark"] or "")
    watched.shoot("live-all-events")
