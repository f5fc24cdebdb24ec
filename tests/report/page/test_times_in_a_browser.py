"""What a mission asks of time, as the page's time chart shows it."""

import pytest

pytest.importorskip("mcap")
pytest.importorskip("shapely")
pytestmark = pytest.mark.xdist_group("browser")

WIDE, NARROW = (1280, 900), (390, 844)


def boxes(browser, selector):
    """Left, right, top and bottom of shapes in the time chart, in pixels of it."""
    return browser.evaluate(
        f"""[...document.querySelectorAll('#gantt {selector}')].map(one => {{
          const [box, whole] = [one.getBoundingClientRect(), one.ownerSVGElement.getBoundingClientRect()];
          return [box.left - whole.left, box.right - whole.left, box.top - whole.top, box.bottom - whole.top];
        }})"""
    )


def fill(browser, selector, what="fill"):
    return browser.evaluate(f"getComputedStyle(document.querySelector('#gantt {selector}')).{what}")


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
def test_a_window_is_shaded_from_where_it_opens_to_the_end_of_the_chart(size, browser, timed_page):
    browser.open(timed_page, *size)
    ((left, right, top, bottom),) = boxes(browser, "rect.window[data-task=boiler]")
    ((begins, ends, high, low),) = boxes(browser, "rect.work[data-task=boiler]")
    assert (left, right) == pytest.approx((begins, ends), abs=1)  # it waits until 10:00, and is the last
    assert top < high < low < bottom  # so that it is seen beside the bar
    assert not boxes(browser, "[data-task=far]")


def test_lateness_is_red_from_the_due_time_to_the_end(browser, timed_page):
    browser.open(timed_page, *WIDE)
    ((left, right, *_),) = boxes(browser, "rect.late[data-task=boiler]")
    ((begins, ends, *_),) = boxes(browser, "rect.work[data-task=boiler]")
    assert (left, right) == pytest.approx(((begins + ends) / 2, ends), abs=1)
    assert fill(browser, "rect.late") == "rgb(176, 0, 32)"
    ((due, *_),) = boxes(browser, "line.due[data-task=boiler]")
    assert due == pytest.approx(left, abs=1.5)
    assert len(boxes(browser, "line.deadline")) == 2  # in the row of each robot of the team


def test_a_task_that_was_added_has_marks_too(browser, timed_page):
    browser.open(timed_page, *WIDE)
    ((begins, ends, *_),) = boxes(browser, "rect.work[data-task=new]")
    ((opens, closes, *_),) = boxes(browser, "rect.window[data-task=new]")
    assert opens < begins < ends < closes
    ((left, right, *_),) = boxes(browser, "rect.late[data-task=new]")
    assert (left, right) == pytest.approx((begins, ends), abs=1)


def test_the_bars_of_a_team_are_linked_where_it_begins(browser, timed_page):
    browser.open(timed_page, *WIDE)
    (first, second) = sorted(boxes(browser, "rect.work[data-task=beam]"), key=lambda box: box[2])
    ((left, right, top, bottom),) = boxes(browser, "g.team line")
    assert (left, right) == pytest.approx((first[0], second[0]), abs=1.5)
    assert top == pytest.approx((first[2] + first[3]) / 2, abs=1)
    assert bottom == pytest.approx((second[2] + second[3]) / 2, abs=1)
    told = browser.evaluate("document.querySelector('#gantt g.team title').textContent")
    assert told == "crawler and hauler do beam together"


def test_times_are_by_the_clock_and_the_legend_names_what_is_drawn(browser, timed_page, page):
    browser.open(timed_page, *WIDE)
    ticks = browser.evaluate("[...document.querySelectorAll('#gantt > text')].map(text => text.textContent)")
    assert [tick for tick in ticks if ":" in tick][:3] == ["09:58:00", "09:59:00", "10:00:00"]
    names = "[...document.querySelectorAll('#legend span')].map(one => one.textContent)"
    own = ["time window", "deadline", "due time", "late", "team"]
    assert browser.evaluate(names) == ["travel", "waiting", "work", *own]
    browser.open(page("31T-6R"), *WIDE)
    assert browser.evaluate(names) == ["travel", "waiting", "work"]


def test_no_label_of_the_axis_is_cut_off(browser, timed_page):
    for width, height in (WIDE, NARROW):
        browser.open(timed_page, width, height)
        whole = browser.evaluate("document.getElementById('gantt').getBoundingClientRect().width")
        assert all(right <= whole + 0.5 for _, right, *_ in boxes(browser, "text"))
