"""The page in a real browser without a window."""

import numpy as np
import pytest
from tests.report.page.conftest import MORE
from tests.report.page.test_page import recording
from tests.state.drawn_events import one_of_each, tied_site

from muster.mission.model import Event, Mission, Robot, Task
from muster.model.problem import Problem
from muster.report.page import write_page
from muster.report.record import RecordWriter, read_record
from muster.state.event import KINDS
from muster.state.words import ALARM, DETAIL
from muster_team.runs.team_log import TeamLog

pytest.importorskip("mcap")
pytest.importorskip("shapely")
pytestmark = pytest.mark.xdist_group("browser")

WIDE, NARROW = (1400, 900), (360, 740)


def seek(browser, time):
    browser.evaluate(f"""(() => {{
        const slider = document.getElementById("slider");
        slider.value = {time};
        slider.dispatchEvent(new Event("input"));
    }})()""")


def time_of(browser):
    return browser.evaluate("Number(document.getElementById('slider').value)")


def robots_of(browser):
    """Where the page says the robots are: metres."""
    return browser.evaluate(
        "Object.fromEntries([...document.querySelectorAll('#map .robot')]"
        ".map(mark => [mark.dataset.robot, [Number(mark.dataset.x), Number(mark.dataset.y)]]))"
    )


def task_states(browser):
    return browser.evaluate(
        "Object.fromEntries([...document.querySelectorAll('#map .task')]"
        ".filter(mark => mark.style.display !== 'none').map(mark => [mark.dataset.task, mark.dataset.state]))"
    )


@pytest.mark.parametrize(
    ("name", "size", "dark"),
    [
        *(("31T-6R", size, dark) for size in (WIDE, NARROW) for dark in (False, True)),
        pytest.param("floor", NARROW, False, marks=pytest.mark.long),
        ("yard", WIDE, True),
        pytest.param("depot", NARROW, True, marks=pytest.mark.long),
    ],
)
def test_it_loads_without_complaint_and_without_network(name, size, dark, browser, page):
    browser.open(page(name), *size, dark=dark)
    seek(browser, 20)
    assert browser.requests == []
    assert browser.complaints == []
    assert browser.evaluate("document.title") == name
    paper = browser.evaluate("getComputedStyle(document.body).backgroundColor")
    assert (paper == "rgb(255, 255, 255)") != dark
    assert browser.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert browser.evaluate("document.getElementById('heights').hidden") == (name not in ("yard", "depot"))
    assert browser.evaluate("document.querySelectorAll('#map image').length") == (name == "floor")


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_names_of_tasks_do_not_overprint_each_other(size, browser, page):
    browser.open(page("31T-6R", more=MORE), *size)
    for time in (0, 2, 20, 60):
        seek(browser, time)
        boxes = browser.evaluate(
            """[...document.querySelectorAll('#map .task text')].filter(text => text.getBoundingClientRect().width)
            .map(text => text.getBoundingClientRect()).map(box => [box.left, box.top + 2, box.right, box.bottom - 2])"""
        )
        assert len(boxes) > 15
        clashes = [
            (a, b)
            for k, a in enumerate(boxes)
            for b in boxes[:k]
            if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
        ]
        assert clashes == []


def test_tasks_at_one_place_lie_beside_each_other(browser, tmp_path):
    tasks = [Task(id=name, position=place) for name, place in (("a", (1, 2)), ("b", (1, 2)), ("c", (3, 4)))]
    mission = Mission(robots=[Robot(id="r", position=(0, 0))], tasks=tasks)
    write_page(tmp_path / "r.html", recording(mission, np.zeros((2, 1, 3))))
    browser.open(tmp_path / "r.html", *WIDE)
    spots = browser.evaluate("[...document.querySelectorAll('#map .task')].map(mark => mark.getAttribute('transform'))")
    assert len(set(spots)) == 3


def test_no_element_reaches_out_of_a_narrow_window(browser, page):
    browser.open(page("31T-6R", more=MORE), *NARROW, mobile=True)
    out = browser.evaluate("""[...document.querySelectorAll("body *")].filter(element => {
        const box = element.getBoundingClientRect();
        return !element.ownerSVGElement && box.width > 0 && (box.right > innerWidth + 0.5 || box.left < -0.5);
    }).map(element => element.outerHTML.slice(0, 80))""")
    assert out == []


@pytest.mark.parametrize("name", ["31T-6R", "yard"])
def test_the_slider_moves_the_robots_to_where_they_were(name, browser, page, recorded):
    tracks = recorded(name).tracks
    browser.open(page(name), *WIDE)
    for moment in (0, 400, 123, -1):
        seek(browser, tracks.times_s[moment])
        seen = robots_of(browser)
        places = [seen[robot] for robot in tracks.robots]
        np.testing.assert_allclose(places, tracks.positions[moment, :, :2], atol=1.1e-3)


def test_between_two_moments_robots_are_between_two_places(browser, page, recorded):
    tracks = recorded("31T-6R").tracks
    browser.open(page("31T-6R"), *WIDE)
    seek(browser, (tracks.times_s[100] + tracks.times_s[101]) / 2)
    middle = (tracks.positions[100] + tracks.positions[101]) / 2
    np.testing.assert_allclose(list(robots_of(browser).values()), middle[:, :2], atol=1.6e-3)


def test_robots_are_drawn_where_they_are(browser, page):
    """Marks on the page are as far from each other, in pixels, as robots in metres: one scale for all."""
    browser.open(page("31T-6R"), *WIDE)
    seek(browser, 30)
    metres = np.array(list(robots_of(browser).values()))
    pixels = np.array(
        browser.evaluate(
            "[...document.querySelectorAll('#map .robot')].map(mark => {"
            "const {e, f} = mark.transform.baseVal.consolidate().matrix; return [e, -f]; })"
        )
    )
    ratios = (pixels[1:] - pixels[0]) / (metres[1:] - metres[0])
    assert ratios == pytest.approx(ratios.mean(), rel=1e-2)
    assert ratios.mean() > 10


def test_tasks_turn_done(browser, page, recorded):
    recording = recorded("31T-6R", more=MORE)
    browser.open(page("31T-6R", more=MORE), *WIDE)
    for time in (0.05, 61.3, 31.0, 19.9):  # backwards too
        seek(browser, time)
        states = task_states(browser)
        done = {event.data["task"] for event in recording.events if event.kind == "ends" and event.time_s <= time}
        assert {task for task, state in states.items() if state == "done"} >= done - {"22"}
        assert states.get("late <b>") == (None if time < 20 else "lost" if time >= 30 else "open")


def test_it_plays_pauses_and_ends(browser, page):
    browser.open(page("31T-6R"), *WIDE)
    assert time_of(browser) == 0
    browser.press(" ", code="Space")
    assert browser.evaluate("document.getElementById('play').getAttribute('aria-label')") == "Pause"
    browser.wait_for("Number(document.getElementById('slider').value) > 0.5")
    browser.press(" ", code="Space")
    paused = time_of(browser)
    frames = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
    assert browser.evaluate(frames)
    assert time_of(browser) == paused
    seek(browser, 61)
    browser.evaluate("document.getElementById('speed').value = 10")
    browser.evaluate("document.getElementById('play').click()")
    browser.wait_for("document.getElementById('play').getAttribute('aria-label') === 'Play'")
    assert time_of(browser) == pytest.approx(61.341)


def test_keys(browser, page):
    browser.open(page("31T-6R"), *WIDE)
    for key, shift, expected in (
        ("ArrowRight", 0, 1),
        ("ArrowRight", 8, 11),
        ("ArrowLeft", 0, 10),
        ("End", 0, 61.341),
        ("ArrowRight", 0, 61.341),
        ("Home", 0, 0),
        ("ArrowLeft", 0, 0),
    ):
        browser.press(key, modifiers=shift)
        assert time_of(browser) == pytest.approx(expected)


def test_pointing_into_a_chart_goes_there(browser, page):
    browser.open(page("31T-6R"), *WIDE)
    box = browser.evaluate("document.getElementById('gantt').getBoundingClientRect().toJSON()")
    browser.click(box["x"] + 64 + (box["width"] - 74) / 2, box["y"] + 20)
    assert time_of(browser) == pytest.approx(61.341 / 2, abs=0.1)
    line = browser.evaluate("Number(document.querySelector('#gantt .cursor').getAttribute('x1'))")
    assert line == pytest.approx(64 + (box["width"] - 74) / 2, abs=1)


def test_the_time_chart_has_a_bar_for_each_span(browser, page, recorded):
    from muster.report.time_charts.activity_spans import spans

    recording = recorded("31T-6R", more=MORE)
    browser.open(page("31T-6R", more=MORE), *WIDE)
    expected = spans(recording.events, recording.duration_s)
    for kind in ("travel", "waiting", "work"):
        seen = browser.evaluate(f"[...document.querySelectorAll('#gantt rect.{kind}')].map(bar => bar.dataset.task)")
        assert sorted(seen) == sorted(span.task for span in expected if span.kind == kind)
    fills = browser.evaluate("[...document.querySelectorAll('#gantt rect.waiting')].map(b => b.getAttribute('fill'))")
    assert fills
    assert all(fill.startswith("url(#hatch-") for fill in fills)


def test_events_are_listed_and_lead_to_their_time(browser, page, recorded):
    events = recorded("31T-6R", more=MORE).events
    browser.open(page("31T-6R", more=MORE), *WIDE)
    assert browser.evaluate("document.querySelectorAll('#events li').length") == len(events)
    alarms = browser.evaluate("[...document.querySelectorAll('#events .alarm')].map(e => e.textContent)")
    assert alarms == [
        "r_5 is out",
        "task late <b> is lost: capacity",
        "traffic jam: r_0, r_1 hold each other up at 1.00, 2.00 since 40.00 s",
    ]
    browser.evaluate("document.querySelector('#events .alarm').closest('button').click()")
    assert time_of(browser) == 20
    assert browser.evaluate("document.querySelector('#robots [data-robot=r_5]').textContent") == "r_5 is out: failed"
    assert browser.evaluate("document.querySelector('#map [data-robot=r_5]').classList.contains('gone')")


def test_what_a_killed_process_left_is_shown_as_such(browser, page):
    browser.open(page("31T-6R", until=20.0), *WIDE)
    warning = browser.evaluate("document.getElementById('warning').textContent")
    assert warning == "The mission did not come to its end."
    assert browser.evaluate("document.getElementById('warning').hidden") is False


def test_everything_to_be_used_has_a_name(browser, page):
    """What a screen reader says of each control and picture."""
    browser.open(page("yard"), *WIDE)
    nodes = browser("Accessibility.getFullAXTree")["nodes"]
    named = {
        (node["role"]["value"], node["name"]["value"])
        for node in nodes
        if not node["ignored"] and node["role"]["value"] in ("button", "slider", "combobox", "image")
    }
    assert all(name for _, name in named)
    assert {("button", "Play"), ("slider", "Time"), ("combobox", "Speed")} <= named
    assert {name.split()[0] for role, name in named if role == "image"} >= {"Map", "Time", "Distance", "Height"}
    seek(browser, 12)
    assert browser.evaluate("document.getElementById('slider').getAttribute('aria-valuetext')") == "12.0 s"


def test_a_window_that_changes(browser, page):
    browser.open(page("31T-6R"), *WIDE)
    seek(browser, 30)
    browser("Emulation.setDeviceMetricsOverride", width=500, height=700, deviceScaleFactor=2, mobile=False)
    browser.wait_for("document.getElementById('map').viewBox.baseVal.width < 500")
    assert time_of(browser) == 30
    boxes = browser.evaluate(
        "[...document.querySelectorAll('#map .robot .body')].map(mark => mark.getBoundingClientRect().right)"
    )
    assert max(boxes) < 500


def page_of(events, folder):
    """The page of a record that has these events alone, and the record."""
    with RecordWriter(folder / "record.mcap", tied_site()) as writer:
        for entry in events:
            writer.on_event(entry["time_s"], entry["kind"], entry["data"])
    found = read_record(folder / "record.mcap")
    write_page(folder / "page.html", found)
    return folder / "page.html", found


def test_a_station_and_a_door_are_marked_while_they_serve_nobody_and_are_open(browser, tmp_path):
    happens = [(10.0, "station_fails", {"station": "rack"}), (10.0, "door_closes", {"door": "a"})]
    happens += [(20.0, "station_returns", {"station": "rack"}), (20.0, "door_opens", {"door": "a"})]
    happens += [
        (30.0, "station_unreachable", {"station": "rack", "robot": "r_0"}),
        (40.0, "robot_returns", {"robot": "r_0"}),
    ]
    events = [{"time_s": at_s, "kind": kind, "data": data} for at_s, kind, data in happens]
    browser.open(page_of(events, tmp_path)[0], *WIDE)
    seen = {}
    for at_s in (0, 11, 21, 31, 40):
        seek(browser, at_s)
        marks = ('[data-station="[rack]"]', ".zone")
        words = [browser.evaluate(f"document.querySelector('#map {mark} title').textContent") for mark in marks]
        seen[at_s] = [browser.evaluate(f"document.querySelector('#map {marks[0]}').classList.contains('away')"), *words]
    unload = "station rack: unload"
    assert seen == {
        0: [False, unload, "door a, open"],
        11: [True, f"{unload}; failed, serves nobody", "door a, closed: ground, air"],
        21: [False, unload, "door a, open"],
        31: [True, f"{unload}; cut off, serves nobody", "door a, open"],
        40: [False, unload, "door a, open"],
    }


def test_each_kind_of_event_is_listed_in_words_and_where_somebody_should_look_marked(browser, tmp_path):
    file, found = page_of(one_of_each(), tmp_path)
    assert {event.kind for event in found.events} == set(KINDS)
    browser.open(file, *WIDE)
    seen = browser.evaluate(
        "[...document.querySelectorAll('#events li span')].map(e => [e.textContent, e.className === 'alarm'])"
    )
    assert seen == [[event.line, event.mark == ALARM] for event in found.events if event.mark != DETAIL]
    assert browser.complaints == []


def test_the_log_of_a_team_without_a_centre_is_shown_in_the_same_words(browser, tmp_path):
    with RecordWriter(tmp_path / "record.mcap", tied_site()) as writer:
        log = TeamLog(Problem.compile(tied_site()), writer, lambda event: None)
        log.take_event(Event(at_s=1, station_fails="rack"), 1.0)
        log.take("r_0", 2.0, "task_refused", {"task": "t_1", "robot": "r_0", "reason": "skill: lift"}, used=0.0)
        for robot in ("r_0", "r_1"):
            log.take(robot, 3.0, "starts", {"task": "t_2", "robot": robot}, used=0.0)
        for robot in ("r_0", "r_1"):
            told = {"task": "pair", "robot": robot, "team": ["r_0", "r_1"], "usage": [1.0, 1.0]}
            log.take(robot, 4.0, "ends", told, used=0.0)
        log.take_event(Event(at_s=5, station_returns="rack"), 5.0)
    write_page(tmp_path / "page.html", read_record(tmp_path / "record.mcap"))
    browser.open(tmp_path / "page.html", *WIDE)
    assert browser.evaluate("[...document.querySelectorAll('#events li span')].map(e => e.textContent)") == [
        "station rack fails",
        "r_0 cannot do task t_1: skill: lift",
        "r_0 begins task t_2",
        "r_0, r_1 have both begun task t_2: they could not hear each other",
        "r_1 begins task t_2",
        "r_0 has done task pair",
        "station rack serves again",
    ]
    assert log.events[-2].kind == "part_ends"
