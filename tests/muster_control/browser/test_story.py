"""The whole story in a real browser: open, plan, ask why, carry out, change, see what follows, replay, take away.

Its parts are tests that follow one another on one page. Pictures of every view are kept where `MUSTER_SCREENSHOTS`
names a folder.
"""

import json
import re
import sqlite3

import pytest

from muster_control.client import Client

pytestmark = pytest.mark.xdist_group("browser")

MISSION = "31T-6R50"


@pytest.fixture
def page(watched):
    yield watched.page
    watched.require_clean()


@pytest.fixture
def out(watched):
    """The robot that is taken out: the one that has the most to do, as plans of a second differ."""
    with Client(watched.origin) as client:
        return max(client.plans.get(1).routes, key=lambda route: len(route.tasks)).robot


def on_the_map(page, x, y):
    """Where on the screen a place of the map is, as shares of its size."""
    box = page.locator(".muster-map-host").bounding_box()
    return box["x"] + x * box["width"], box["y"] + y * box["height"]


def clock(page):
    return float(page.locator(".clock").get_attribute("data-seconds"))


def test_a_mission_is_found_and_planned(watched, page):
    watched.open("/")
    page.get_by_role("link", name=MISSION, exact=True).wait_for()
    watched.shoot("missions")
    page.get_by_role("link", name=MISSION, exact=True).click()
    page.get_by_label("Time limit, s").fill("1")
    page.locator("#plan").dblclick()
    page.locator("#carry-out").wait_for()
    with Client(watched.origin) as client:
        assert len(client.jobs()) == 1
    watched.shoot("plan")


def test_why_a_task_is_done_so(watched, page):
    page.locator(".muster-map-host").focus()
    page.keyboard.press("p")  # the last task
    page.keyboard.press("Enter")
    page.get_by_role("heading", name=re.compile(r"^Task 30$")).wait_for()
    assert page.locator(".why p").first.inner_text()
    watched.shoot("why")


def test_it_is_carried_out(watched, page):
    page.locator("#carry-out").click()
    page.locator("#start").dblclick()
    page.wait_for_url("**/live/1")
    page.get_by_text("running", exact=False).first.wait_for()
    page.get_by_label("Speed", exact=True).select_option("4")  # ten times
    page.get_by_text("Speed 10").wait_for()
    page.wait_for_function("Number(document.querySelector('.clock').dataset.seconds) > 10")
    page.keyboard.press(" ")
    page.locator(".run-state[data-state=paused]").wait_for()
    with Client(watched.origin) as client:
        assert [run.id for run in client.runs()] == [1]
    watched.shoot("live")


def test_a_robot_that_fails_has_its_tasks_done_by_others(watched, page, out):
    page.locator(f"tr[data-robot={out}]").click()
    page.get_by_role("button", name="Take out").click()
    page.locator(f"tr[data-robot={out}].out").wait_for()
    page.get_by_role("button", name="Go on").click()
    replanned = page.locator("li[data-kind=replanned]").first
    replanned.wait_for()
    assert re.search(rf"from {out} to r_\d", replanned.inner_text())
    page.get_by_label("Speed", exact=True).select_option("1")  # so that all that follows finds it going
    watched.shoot("live-reallocated")


def test_a_task_is_added_by_a_click_and_taken_back(watched, page):
    page.keyboard.press("n")
    page.mouse.click(*on_the_map(page, 0.62, 0.82))
    form = page.get_by_role("dialog", name="A new task")
    form.get_by_label("type").select_option("D")
    watched.shoot("live-new-task")
    form.get_by_role("button", name="Add the task").click()
    page.locator("li[data-kind=new_task]").wait_for()
    assert "of 32 tasks done" in page.locator(".counts").inner_text()
    page.keyboard.press("Control+z")
    page.locator("li[data-kind=cancel_task]").wait_for()
    page.get_by_text("1 cancelled").wait_for()


def test_a_task_is_moved_and_moved_back(watched, page):
    page.keyboard.press("Escape")
    page.locator(".muster-map-host").focus()
    page.keyboard.press(",")  # the last, which was cancelled
    page.keyboard.press(",")
    page.get_by_role("heading", name="Task 30").wait_for()
    page.get_by_role("button", name="Move").click()
    page.mouse.click(*on_the_map(page, 0.45, 0.3))
    moved = page.locator("li[data-kind=move_task]")
    moved.first.wait_for()
    page.locator(".notices .done", has_text="Move 30").first.wait_for()
    page.keyboard.press("Control+z")
    page.locator(".notices .done", has_text="Move 30 back").wait_for()
    moved.nth(1).wait_for()
    page.locator(".chosen dd", has_text="-5.50, 5.50").wait_for()


def test_what_cannot_be_is_refused_in_words_and_may_be_changed(watched, page):
    page.get_by_role("button", name="+ Task").click()
    page.mouse.click(*on_the_map(page, 0.5, 0.9))
    form = page.get_by_role("dialog", name="A new task")
    form.get_by_label("id").fill("30")
    form.get_by_role("button", name="Add the task").click()
    wrong = form.get_by_label("id").evaluate("field => field.validationMessage")
    assert wrong == "There is a task 30 already."
    form.locator("form").evaluate("form => { form.noValidate = true; }")  # as if it came to be meanwhile
    form.get_by_label("duration").fill("7")
    form.get_by_role("button", name="Add the task").click()
    refused = page.locator(".notices .refused")
    refused.wait_for()
    assert "30" in refused.locator(".state").inner_text()
    refused.get_by_role("button", name="Change it").click()
    assert form.get_by_label("duration").input_value() == "7"
    form.get_by_role("button", name="Leave it").click()


def test_the_keyboard_alone_places_a_task(watched, page):
    page.locator(".muster-map-host").focus()
    page.keyboard.press("Escape")
    for key in ("n", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    form = page.get_by_role("dialog", name="A new task")
    form.get_by_label("id").wait_for()
    page.keyboard.press("Escape")
    form.wait_for(state="hidden")
    for key in ("n", "Escape"):
        page.keyboard.press(key)
    assert not page.locator(".field .hint").is_visible()


def test_what_nobody_can_do_is_seen_at_once(watched, page, out):
    page.keyboard.press("Escape")
    with Client(watched.origin) as client:
        wanted = {"id": "for-nobody", "position": [0, 1], "type": "D", "only_robots": [out]}
        client.run(1).act("event", new_task=wanted)
    page.get_by_text("1 cannot be done").wait_for()
    told = page.locator("li[data-kind=replanned].alarm", has_text=f"nobody can do: for-nobody (lock: only {out}")
    told.first.wait_for()
    page.locator(".muster-map-host").focus()
    page.keyboard.press(",")
    page.locator(".chosen dd", has_text=f"nobody: lock: only {out}").wait_for()
    watched.shoot("live-for-nobody")
    page.get_by_role("button", name="Cancel …").click()
    asked = page.get_by_role("dialog", name="Cancel task for-nobody?")
    asked.get_by_role("button", name="Leave it").click()
    page.get_by_role("button", name="Cancel …").click()
    asked.get_by_role("button", name="Cancel the task").click()
    page.get_by_text("cannot be done").wait_for(state="hidden")
    page.get_by_text("2 cancelled").wait_for()


def test_commands_that_only_memory_holds_are_marked_until_the_database_has_them(watched, page, served_in):
    lock = sqlite3.connect(served_in / "muster.db", isolation_level=None)
    lock.execute("BEGIN IMMEDIATE")
    page.keyboard.press(" ")
    mark = page.locator(".notices .unkept", has_text="in the journal")
    mark.wait_for()
    lock.execute("COMMIT")
    lock.close()
    mark.wait_for(state="detached")
    page.locator(".run-state[data-state=paused]").wait_for()
    page.keyboard.press(" ")
    page.locator(".run-state[data-state=running]").wait_for()


def test_who_comes_back_misses_nothing(watched, page):
    """The stream breaks off: the page says so, goes on by itself, and tells each event once; outcomes too."""
    page.keyboard.press(" ")
    page.locator(".run-state[data-state=paused]").wait_for()
    told = page.locator("ol.events li")
    page.locator("li[data-kind=command]", has_text="pause").first.wait_for()
    before = told.all_inner_texts()
    sockets = []

    def without_outcomes(socket):
        """A stream as of whoever was away in the moment when outcomes were told."""
        server = socket.connect_to_server()
        server.on_message(lambda text: None if '"type":"action"' in text else socket.send(text))
        sockets.append((socket, server))

    page.route_web_socket(re.compile("/stream"), without_outcomes)
    page.reload()
    page.wait_for_function("count => document.querySelectorAll('ol.events li').length === count", arg=len(before))
    sockets[0][0].close(code=1012, reason="restarts")
    page.locator(".connection", has_text="connection lost").wait_for()
    page.locator(".connection").wait_for(state="hidden")
    page.keyboard.press(" ")
    page.locator(".notices .done", has_text="Go on").wait_for()
    page.locator(".run-state[data-state=running]").wait_for()
    page.keyboard.press(" ")
    page.locator(".run-state[data-state=paused]").wait_for()
    assert len(sockets) == 2
    assert not sockets[1][0].url.endswith("after=0")
    assert told.all_inner_texts()[-len(before) :] == before


def test_keys_go_on_from_what_was_asked_for_last(watched, page):
    """However long the run takes to say that it has obeyed: here it cannot between two keys."""
    twice = (
        "key => [1, 2].forEach(() => document.body.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true})))"
    )
    asked = page.locator("li[data-kind=command]")

    def newest(count):
        with Client(watched.origin) as client:
            return [action.verb for action in client.actions(run=1)][:count]

    before = asked.count()
    page.evaluate(twice, " ")
    page.wait_for_function("n => document.querySelectorAll('li[data-kind=command]').length === n", arg=before + 2)
    assert newest(2) == ["run.pause", "run.resume"]
    page.locator(".run-state[data-state=paused]").wait_for()
    page.evaluate(twice, "+")
    page.locator(".notices .done", has_text="Speed 5").wait_for()
    page.evaluate(twice, "-")
    page.locator(".notices .done", has_text="Speed 1 ").wait_for()
    page.get_by_role("button", name="Go on").dblclick()
    page.wait_for_function("n => document.querySelectorAll('li[data-kind=command]').length === n", arg=before + 8)
    page.locator(".run-state[data-state=paused]").wait_for()
    assert newest(2) == ["run.pause", "run.resume"]


def test_on_a_wall_there_is_nothing_to_press(watched, page):
    page.goto(page.url + "?wall=1")
    page.locator(".clock").wait_for()
    page.wait_for_timeout(500)
    watched.shoot("live-wall")
    assert not page.locator(".pause").is_visible()


def test_it_ends(watched, page):
    watched.open("/live")
    page.get_by_role("link", name="Run 1").wait_for()
    watched.shoot("live-list")
    page.get_by_role("link", name="Run 1").click()
    page.get_by_role("button", name="Go on").click()
    page.get_by_label("Speed", exact=True).select_option(label="as fast as it goes")
    page.get_by_text(re.compile(r"The run is over \(ended\): \d+ tasks done, \d+ not, \d+ cancelled\.")).wait_for(
        timeout=90_000
    )
    watched.shoot("live-ended")


def test_its_record_is_replayed_by_the_slider(watched, page, out):
    page.get_by_role("link", name="Look at its record").click()
    replay = page.frame_locator("iframe")
    replay.locator("#slider").wait_for(timeout=60_000)
    end = float(replay.locator("#slider").get_attribute("max"))
    replay.locator("#slider").fill(str(round(end / 2, 1)))
    assert float(replay.locator("#clock").inner_text().split()[0]) == pytest.approx(end / 2, abs=0.2)
    watched.shoot("record", settles_ms=800)
    assert page.get_by_role("table", name="Robots, planned against flown").locator("tr").count() == 7
    page.get_by_text("What users did").click()
    assert f"takes {out} out" in page.get_by_role("table", name="What users did").inner_text()
    watched.open("/live/1?wall=1")
    page.wait_for_url("**/records/1?wall=1")
    watched.open("/records")
    page.get_by_role("link", name="Run 1").wait_for()
    watched.shoot("records")


def test_it_is_taken_away(watched, page, tmp_path):
    watched.open("/records/1")
    for name, check in (("Log (JSON)", json.loads), ("Spreadsheets (CSV", None), ("MCAP", None)):
        with page.expect_download() as taken:
            page.get_by_role("link", name=name).click()
        file = tmp_path / taken.value.suggested_filename
        taken.value.save_as(file)
        assert file.stat().st_size > 1000
        if check is not None:
            check(file.read_text())


@pytest.mark.long
def test_drones_are_seen_in_space_and_a_run_is_ended(watched, page):
    with Client(watched.origin) as client:
        run = client.start(client.plan("auction-1", allocator="greedy").wait(), speed=0.5).id
    watched.open(f"/live/{run}")
    page.locator("ol.events li[data-kind=plan]").wait_for()
    page.keyboard.press("v")
    page.locator(".space-host canvas").wait_for()
    page.locator(".in-space.robot").first.wait_for()
    watched.shoot("live-space", settles_ms=1000)
    page.keyboard.press("v")
    page.get_by_role("button", name="End the run").click()
    page.get_by_role("button", name="End it").click()
    page.get_by_text("The run is over (cancelled)").wait_for()
    watched.open(f"/records/{run}")
    page.get_by_text("not done when the run was cancelled").first.wait_for()
