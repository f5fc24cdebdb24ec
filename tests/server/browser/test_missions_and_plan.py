"""Missions and Plan as somebody sees them who makes, edits, plans and compares."""

import json
import re

import pytest
from playwright.sync_api import expect

from muster.client import Client

pytestmark = pytest.mark.xdist_group("missions and plan")  # a test goes on where the one before it ended

SLOW_MS = 90_000
SCENE = "getElement(document.querySelector('.muster-map')).stage.scene"
EACH_WAS_SEEN = """words => {
  window.wordsSeen ??= new Set();
  for (const each of words) if (document.body.innerText.includes(each)) window.wordsSeen.add(each);
  return words.every(each => window.wordsSeen.has(each));
}"""
"""Whether all of these words have been on the page since it was first asked, be they gone again by now."""


@pytest.fixture
def page(watched):
    yield watched.page
    watched.require_clean()


def plan_view(watched, mission):
    """Open a mission and wait until it is on the map and may be planned."""
    watched.open(f"/plan/{mission}")
    watched.page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    watched.page.wait_for_function("document.querySelector('#plan:not([disabled])')")


def task_place(page, task):
    """Where a task is on the screen, as the map's own scripts know it, and in metres as its table says."""
    return page.evaluate(
        """task => {
          const map = document.querySelector('.muster-map');
          const { stage } = getElement(map);
          const { x, y } = stage.places.tasks.get(task);
          const box = map.getBoundingClientRect();
          return { px: box.left + stage.view.x(x), py: box.top + stage.view.y(y), x, y };
        }""",
        task,
    )


def choose_task(page, task):
    """Go from mark to mark by keyboard until that task is chosen."""
    page.locator(".muster-map-host").focus()
    for _ in range(page.evaluate(f"{SCENE}.robots.length + {SCENE}.tasks.length")):
        page.keyboard.press("n")
        if page.get_by_text(re.compile(f"^task {task}[ ;]")).count():
            return
    raise AssertionError(f"no task {task}")


def own_missions(watched):
    with Client(watched.origin) as client:
        return sorted(mission.name for mission in client.missions.list() if not mission.shipped)


def text_of(page, words=""):
    """The mission's text, once these words are in it: what was changed may still be on its way."""
    page.get_by_role("button", name="Text", exact=True).click()
    expect(page.locator(".cm-content")).to_contain_text(words, timeout=SLOW_MS)
    return page.evaluate("[...document.querySelectorAll('.cm-line')].map(line => line.textContent).join('\\n')")


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
    assert own_missions(watched) == ["6T-2R copy"]


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
    assert own_missions(watched) == ["6T-2R copy"]


def test_an_empty_mission_is_made_and_edited_on_the_map_and_undone(watched, page):
    watched.open("/")
    page.click("#new")
    page.get_by_label("Name", exact=True).fill("yard test")
    page.get_by_role("button", name="Make it").dblclick()
    page.wait_for_url("**/plan/yard-test")
    page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    assert own_missions(watched) == ["6T-2R copy", "yard test"]
    before = task_place(page, "1")
    page.mouse.move(before["px"], before["py"])
    page.mouse.down()
    page.mouse.move(before["px"] + 60, before["py"] + 30, steps=5)
    page.mouse.up()
    page.get_by_text("version 1, changed").wait_for()
    after = task_place(page, "1")
    assert after["x"] > before["x"]
    assert after["y"] < before["y"]
    text_of(page, f"position: [{after['x']:g}, {after['y']:g}]")
    page.get_by_role("button", name="Map", exact=True).click()
    page.locator(".muster-map-host").focus()
    page.keyboard.press("Control+z")
    page.get_by_text(re.compile(r"^version 1$")).wait_for()
    text_of(page, "position: [5, 8]")


def test_a_zone_is_drawn_by_its_corners_and_the_map_stays(watched, page):
    plan_view(watched, "yard-test")
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    box = page.locator(".muster-map-host").bounding_box()
    before = task_place(page, "1")
    for x, y in ((0.3, 0.3), (0.5, 0.3), (0.5, 0.6)):
        page.mouse.click(box["x"] + x * box["width"], box["y"] + y * box["height"])
    page.keyboard.press("Enter")
    page.get_by_label("ceiling_m").fill("3")
    page.get_by_role("button", name="Add the zone").dblclick()
    page.get_by_text("version 1, changed").wait_for()
    page.wait_for_function("getElement(document.querySelector('.muster-map')).stage.scene.zones.length === 1")
    assert task_place(page, "1") == before
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Move and choose").click()
    page.get_by_text("Click the corners of the zone").wait_for(state="hidden")
    corner = "getElement(document.querySelector('.muster-map')).stage.scene.zones[0].corners[2]"
    drawn = page.evaluate(corner)
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.6 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.7 * box["height"], steps=4)
    page.mouse.up()
    dragged = page.evaluate(corner)
    assert dragged[0] > drawn[0]
    text = text_of(page, f"[{dragged[0]:g}, {dragged[1]:g}]]")
    (polygon,) = re.findall(r"polygon: \[(.*?)\], ceiling_m: 3", text)
    corners = re.findall(r"\[([^\[\]]*), ([^\[\]]*)\]", polygon)
    assert len(corners) == 3
    assert all(len(number.partition(".")[2]) <= 2 for corner in corners for number in corner)
    page.click("#undo")
    page.click("#undo")
    page.get_by_text("version 1", exact=True).wait_for()


def test_what_is_wrong_is_said_with_its_line_while_one_types(watched, page):
    plan_view(watched, "yard-test")
    page.get_by_role("button", name="Text", exact=True).click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.type("taskss: []")
    page.get_by_text("did you mean 'tasks'").first.wait_for()
    page.wait_for_selector(".wrong-line")
    page.keyboard.press("Control+z")
    page.wait_for_selector(".findings", state="hidden")


def test_a_cell_of_the_form_changes_the_text_and_keeps_comments(watched, page):
    plan_view(watched, "floor")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of carrier").fill("0.75")
    page.keyboard.press("Tab")
    text = text_of(page, "speed_mps: 0.75")
    assert "# Source: Muster's own." in text
    assert "{id: carrier, position: [15.5, 9.5], heading_deg: 90, radius_m: 0.3, kinematics: differential-drive" in text
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of carrier").fill("fast")
    page.keyboard.press("Tab")
    page.get_by_text("'fast'; expected a number").wait_for()
    expect(page.get_by_label("speed_mps of carrier")).to_have_value("0.75")
    page.click("#undo")


def test_focus_is_seen_and_words_on_buttons_are_read_in_the_dark(watched, page):
    """Quasar says otherwise of both, and that it is important."""
    plan_view(watched, "6T-2R")
    page.keyboard.press("Tab")
    page.locator("#plan").focus()
    expect(page.locator("#plan")).to_have_css("outline-style", "solid")
    page.emulate_media(color_scheme="dark")
    expect(page.locator("#plan")).to_have_css("color", "rgb(23, 24, 27)")
    page.emulate_media(color_scheme="light")
    expect(page.locator("#plan")).to_have_css("color", "rgb(255, 255, 255)")


def test_a_run_that_failed_before_it_began_has_no_record_to_show(watched, page):
    with Client(watched.origin) as client:
        run = client.start(client.plan("yard", iterations=1).wait(), avoidance="rvo")
        run.wait()
    watched.open(f"/records/{run.id}")
    page.get_by_text("the mission is in space").wait_for()
    page.get_by_text("What users did").wait_for()
    assert page.locator("iframe, .downloads").count() == 0


def test_planning_shows_the_answer_says_why_and_exports(watched, page):
    plan_view(watched, "31T-6R50")
    page.get_by_label("Time limit, s").fill("1")
    page.click("#plan")
    page.wait_for_selector("table.robots", timeout=SLOW_MS)
    assert page.locator("dl.figures").inner_text().count("31 of 31") == 1
    expect(page.locator(".gantt rect.work")).to_have_count(31)
    page.locator(".chip", has_text=re.compile("^30$")).click()
    page.click("#why")
    page.get_by_text(re.compile("^Task 30 is done by")).wait_for(timeout=SLOW_MS)
    page.click("#export")
    with page.expect_download() as kept:
        page.get_by_text("Plan file (JSON)").click()
    assert json.loads(kept.value.path().read_text())["schema"] == "muster-plan/1"
    page.click("#export")
    greyed = page.locator(".q-item.disabled", has_text="GeoJSON")
    assert "needs origin_wgs84" in greyed.inner_text()
    page.keyboard.press("Escape")
    watched.shoot("plan")


def test_two_plans_are_compared_side_by_side(watched, page):
    plan_view(watched, "31T-6R50")
    page.get_by_label("Allocator").click()
    page.get_by_role("option", name="greedy", exact=True).click()
    page.click("#plan")
    page.get_by_text("Left out (4)").wait_for(timeout=SLOW_MS)
    page.get_by_role("button", name="Compare").click()
    page.get_by_text(re.compile("tasks are done by another robot")).wait_for(timeout=SLOW_MS)
    assert page.locator(".muster-map").count() == 2
    watched.shoot("compare")


def test_who_saves_second_is_told_and_asked(watched, page, chromium):
    plan_view(watched, "yard-test")
    other = chromium.new_page()
    other.goto(f"{watched.origin}/plan/yard-test")
    other.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    for one, speed in ((other, "2"), (page, "3")):
        one.get_by_role("button", name="Form", exact=True).click()
        one.get_by_label("speed_mps of r_0").fill(speed)
        one.keyboard.press("Tab")
        one.keyboard.press("Control+s")
    other.get_by_text("version 2", exact=True).wait_for()
    page.get_by_text("Somebody else has saved this mission").wait_for()
    page.get_by_role("button", name="Save mine on top").click()
    page.get_by_text("version 3", exact=True).wait_for()
    other.close()
    page.get_by_role("button", name="History").click()
    page.get_by_role("row", name=re.compile("version 1 ")).get_by_role("button", name="Restore").click()
    page.get_by_text("version 4", exact=True).wait_for()
    text_of(page, "speed_mps: 1}")


def test_the_keyboard_alone_chooses_and_moves_a_task(watched, page):
    plan_view(watched, "yard-test")
    page.locator(".muster-map-host").focus()
    page.keyboard.press("p")
    page.get_by_text("task 1; at 5, 8 m").wait_for(state="attached")
    page.keyboard.press("Alt+ArrowRight")
    page.get_by_text(re.compile("version 4, changed")).wait_for()
    page.keyboard.press("?")
    assert page.get_by_role("dialog", name="Keyboard").is_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("Control+z")
    page.get_by_text("version 4", exact=True).wait_for()


def test_the_keyboard_alone_adds_a_task_and_a_zone(watched, page):
    plan_view(watched, "yard-test")
    scene = "getElement(document.querySelector('.muster-map')).stage.scene"
    tasks = page.evaluate(f"{scene}.tasks.length")
    clicks, ground = page.get_by_role("combobox", name="What a click on the map does"), page.locator(".muster-map-host")
    clicks.click()
    page.get_by_role("option", name="Add tasks").click()
    page.get_by_text("Click where the new task is").wait_for()
    ground.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    page.get_by_text("version 4, changed").wait_for()
    page.wait_for_function(f"{scene}.tasks.length === {tasks + 1}")
    clicks.click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    ground.focus()
    for key in (" ", "ArrowRight", " ", "ArrowDown", " ", "Enter"):
        page.keyboard.press(key)
    page.get_by_role("button", name="Add the zone").click()
    page.wait_for_function(f"{scene}.zones.length === 1")


def test_undo_right_after_a_nudge_takes_it_back(watched, page):
    plan_view(watched, "yard-test")
    before = task_place(page, "1")
    choose_task(page, "1")
    page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("Control+z")
    page.wait_for_selector("#redo[aria-disabled=false]")
    page.get_by_text("version 4", exact=True).wait_for()
    page.wait_for_function(f"{SCENE}.tasks.find(({{ id }}) => id === '1').x === {before['x']}")


def test_saving_twice_at_once_is_no_conflict(watched, page):
    plan_view(watched, "yard-test")
    choose_task(page, "1")
    page.keyboard.press("Alt+ArrowRight")
    page.get_by_text("version 4, changed").wait_for()
    for _ in range(3):
        page.keyboard.press("Control+s")
    page.get_by_text("version 5", exact=True).wait_for()
    page.keyboard.press("Control+s")
    page.get_by_text("Nothing has changed since the last version.").first.wait_for()
    assert not page.get_by_text("Somebody else has saved this mission").count()
    with Client(watched.origin) as client:
        assert client.missions.get("yard-test").version == 5


def test_what_is_nudged_on_and_on_never_jumps_back(watched, page):
    plan_view(watched, "yard-test")
    choose_task(page, "1")
    page.evaluate(
        """() => {
          const { stage } = getElement(document.querySelector('.muster-map'));
          window.seen = [];
          const show = stage.show;
          stage.show = (scene) => { show.call(stage, scene); window.seen.push(stage.places.tasks.get('1').x); };
          window.nudged = [];
          const place = stage.place;
          stage.place = (one, x, y) => { place.call(stage, one, x, y); window.nudged.push([x, window.seen.length]); };
        }"""
    )
    for _ in range(40):
        page.keyboard.press("Alt+ArrowRight", delay=40)
    last = page.evaluate("nudged.at(-1)[0]")
    page.wait_for_function(f"seen.at(-1) === {last}")
    moved = [x for x, _ in page.evaluate("nudged")]
    assert moved == sorted(set(moved))
    for _ in moved:
        page.keyboard.press("Control+z")
    page.get_by_text("version 5", exact=True).wait_for()


def test_a_cell_is_that_of_its_task_though_another_is_taken_out_meanwhile(watched, page):
    plan_view(watched, "31T-6R50")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("type of 5", exact=True).wait_for()
    page.evaluate(
        """() => {
          document.querySelector("[aria-label='Remove 3']").click();
          const field = document.querySelector("[aria-label='type of 5']");
          field.value = "late";
          field.dispatchEvent(new Event("change"));
        }"""
    )
    page.get_by_label("type of 3", exact=True).wait_for(state="detached")
    page.wait_for_function("document.querySelector('#undo').ariaDisabled === 'false'")
    assert re.search(r"id: 5,.*type: late", text_of(page, "type: late"))
    page.click("#undo")
    page.click("#undo")
    page.get_by_text("shipped with Muster", exact=True).or_(page.get_by_text(re.compile("^version 1$"))).wait_for()


def test_what_is_being_typed_into_a_cell_stays_whatever_the_server_sends(watched, page):
    plan_view(watched, "yard-test")
    page.get_by_role("button", name="Form", exact=True).click()
    speed = page.get_by_label("speed_mps of r_0")
    speed.click()
    page.keyboard.press("Control+a")
    page.keyboard.type("0.7")
    rows = page.get_by_role("button", name=re.compile("^Remove"))
    before = rows.count()
    page.get_by_role("button", name="Add a row").last.dispatch_event("click")  # as an answer that comes now
    page.wait_for_function(f"document.querySelectorAll('.edit-table [aria-label^=Remove]').length > {before}")
    page.keyboard.type("5")
    assert speed.input_value() == "0.75"
    page.keyboard.press("Tab")
    page.keyboard.press("Control+s")
    page.get_by_text("version 6", exact=True).wait_for()
    assert speed.input_value() == "0.75"
    text_of(page, "speed_mps: 0.75")


def test_a_row_that_gets_another_id_stays_the_same_row(watched, page):
    plan_view(watched, "yard-test")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("id of r_0", exact=True).click()
    page.keyboard.press("Control+a")
    page.keyboard.type("rover")
    page.keyboard.press("Tab")
    page.keyboard.type("2")
    page.get_by_label("x of rover", exact=True).wait_for()
    page.keyboard.type("5")
    page.keyboard.press("Tab")
    page.keyboard.press("Control+s")
    page.get_by_text("version 7", exact=True).wait_for()
    text_of(page, "{id: rover, position: [25, ")


def test_delete_pressed_on_and_on_takes_out_one_zone(watched, page):
    plan_view(watched, "yard")
    zones = page.evaluate(f"{SCENE}.zones.length")
    assert zones > 1
    page.evaluate("getElement(document.querySelector('.muster-map')).heard('choose', {what: 'zone', id: 0, corner: 0})")
    page.locator(".muster-map-host").focus()
    page.keyboard.down("Delete")
    page.keyboard.down("Delete")
    page.keyboard.up("Delete")
    page.keyboard.press("Delete")
    page.wait_for_function(f"{SCENE}.zones.length < {zones}")
    page.keyboard.press("Control+z")
    page.wait_for_function(f"{SCENE}.zones.length === {zones}")
    page.wait_for_selector("#undo[aria-disabled=true]")


def test_the_page_asks_before_one_leaves_it_right_after_an_edit(watched, page):
    plan_view(watched, "yard-test")
    choose_task(page, "1")
    asks = page.evaluate(
        """() => {
          const key = new KeyboardEvent("keydown", { key: "ArrowRight", altKey: true });
          document.querySelector(".muster-map-host").dispatchEvent(key);
          return window.musterUnsaved;
        }"""
    )
    assert asks
    page.get_by_text("version 7, changed").wait_for()
    page.keyboard.press("Control+z")
    page.wait_for_function("window.musterUnsaved === false")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of rover").wait_for()
    asks = page.evaluate(
        """() => {
          const field = document.querySelector("[aria-label='speed_mps of rover']");
          field.value = "fast";
          field.dispatchEvent(new Event("change"));
          return window.musterUnsaved;
        }"""
    )
    assert asks
    page.get_by_text("'fast'; expected a number").wait_for()
    page.wait_for_function("window.musterUnsaved === false")


def test_a_zone_that_is_drawn_and_not_added_leaves_nothing_to_save(watched, page):
    plan_view(watched, "yard-test")
    page.get_by_role("combobox", name="What a click on the map does").click()
    page.get_by_role("option", name="Draw zones").click()
    page.get_by_text("Click the corners of the zone").wait_for()
    page.locator(".muster-map-host").focus()
    for key in (" ", "ArrowRight", " ", "ArrowDown", " ", "Enter"):
        page.keyboard.press(key)
    assert page.evaluate("window.musterUnsaved")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("window.musterUnsaved === false")


HELD = """() => {
  const pass = socket.onevent;
  window.held = [];
  window.heldHas = (words) => held.some((packet) => JSON.stringify(packet.data).includes(words));
  window.release = () => { socket.onevent = pass; held.forEach((packet) => socket.onevent(packet)); };
  socket.onevent = (packet) => held.push(packet);
}"""  # what the server sends is on its way, as long as a test wants


def end_of_text(page):
    page.get_by_role("button", name="Text", exact=True).click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")


def test_what_is_typed_while_another_text_is_on_its_way_is_put_into_that(watched, page):
    plan_view(watched, "yard-test")
    before = text_of(page)
    end_of_text(page)
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text("# head ")
    page.get_by_text("version 7, changed").wait_for()
    page.evaluate(HELD)
    page.keyboard.press("Control+z")
    page.wait_for_function("heldHas('setEditorValueFromProps')")
    for key in ("Control+End", "ArrowUp", "End"):
        page.keyboard.press(key)
    page.keyboard.type(" # tail")
    page.evaluate("release()")
    page.wait_for_function("!document.querySelector('.cm-content').textContent.includes('# head')")
    page.wait_for_function("document.querySelector('.cm-content').textContent.endsWith(' # tail')")
    after = before.removesuffix("\n") + " # tail\n"
    assert text_of(page) == after
    page.keyboard.press("Control+s")
    page.get_by_text("version 8", exact=True).wait_for()
    plan_view(watched, "yard-test")
    assert text_of(page, " # tail") == after


def test_what_is_typed_while_a_mark_is_on_its_way_stays(watched, page):
    plan_view(watched, "yard-test")
    end_of_text(page)
    page.evaluate(HELD)
    page.keyboard.type("taskss: []")
    page.wait_for_function("heldHas('wrong-line')")
    page.keyboard.type(" # mo")
    page.evaluate("release()")
    page.wait_for_selector(".wrong-line")
    page.keyboard.type("re")
    assert text_of(page).endswith("taskss: [] # more")
    page.get_by_role("button", name="Form", exact=True).click()
    page.get_by_label("speed_mps of rover").wait_for()
    assert text_of(page, "# more").endswith("taskss: [] # more")


def test_what_cannot_be_put_into_another_text_is_told_and_gone_on_both_sides(watched, page):
    plan_view(watched, "yard-test")
    before = text_of(page)
    end_of_text(page)
    page.keyboard.insert_text("# last")
    page.get_by_text("version 8, changed").wait_for()
    page.evaluate(HELD)
    page.keyboard.press("Control+z")
    page.wait_for_function("heldHas('setEditorValueFromProps')")
    page.keyboard.press("ArrowLeft")
    page.keyboard.type("er")
    page.evaluate("release()")
    page.get_by_text("What you typed last is not in the text").wait_for()
    assert text_of(page) == before
    page.get_by_text("version 8", exact=True).wait_for()


def test_a_change_of_a_text_that_is_not_known_cuts_nothing(watched, page):
    plan_view(watched, "yard-test")
    before = text_of(page)
    change = "{ sections: [5, -1, 0, 1], inserted: [[], ['x']] }"
    page.evaluate(f"getElement(document.querySelector('.script')).$emit('update:value', {change})")
    page.get_by_text("What you typed last is not in the text").wait_for()
    assert text_of(page) == before
    page.get_by_text("version 8", exact=True).wait_for()
    end_of_text(page)
    page.keyboard.type("# still")
    page.get_by_text("version 8, changed").wait_for()
    page.keyboard.press("Control+s")
    page.get_by_text("version 9", exact=True).wait_for()
    plan_view(watched, "yard-test")
    assert text_of(page, "# still") == before + "# still"
