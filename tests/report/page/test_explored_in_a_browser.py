"""The map that robots have built, as the page of a record draws it: as it was at the time that is shown."""

import numpy as np
import pytest
from tests.report.page.test_page import recording
from tests.report.page.test_page_in_a_browser import NARROW, WIDE, seek

from muster.mission.model import Map, Mission, Robot, Task
from muster.report.page import write_page
from muster.state import event_of

pytest.importorskip("mcap")
pytest.importorskip("shapely")
pytestmark = pytest.mark.xdist_group("browser")

CORNERS = ((0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0))
OPACITY = """(async (x, y) => {
  const part = document.querySelector("#map image.explored");
  if (!part) return null;
  const picture = new Image();
  picture.src = part.getAttribute("href");
  await picture.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [picture.width, picture.height];
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  const corner = document.querySelector("#map .boundary").points;
  const scale = Math.hypot(corner[1].x - corner[0].x, corner[1].y - corner[0].y) / 8;
  const spot = new DOMPoint(corner[0].x + scale * x, corner[0].y - scale * y);
  const cell = spot.matrixTransform(part.transform.baseVal.consolidate().matrix.inverse());
  return context.getImageData(Math.floor(cell.x), Math.floor(cell.y), 1, 1).data[3];
})"""
"""Of what is drawn over a place in metres; null where there is no map."""


def grows(at, *runs, origin=(0.0, 0.0, 0.0)):
    data = {"cell_m": 1.0, "origin": list(origin), "size": [3, 4], "runs": [list(run) for run in runs]}
    return event_of(at, "map_grows", data)


def page_of(folder, *events):
    mission = Mission(
        map=Map(boundary=CORNERS), robots=[Robot(id="r", position=(1, 1))], tasks=[Task(id="t", position=(2, 1))]
    )
    there = np.ones((11, 1, 3))
    file = folder / "r.html"
    write_page(file, recording(mission, there, times=np.arange(11.0), events=events))
    return file


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_the_map_is_shown_as_it_was_at_each_time_both_ways(size, browser, tmp_path):
    file = page_of(tmp_path, grows(2.0, (0, 0, 2, 1), (2, 3, 1, 2)), grows(6.0, (0, 1, 1, 2), (1, 0, 4, 1)))
    browser.open(file, *size)
    at = lambda x, y: browser.evaluate(f"{OPACITY}({x}, {y})")  # noqa: E731
    assert at(0.5, 0.5) is None
    seen = {}
    for time in (2, 6, 5.9, 10, 3):
        seek(browser, time)
        seen[time] = [at(*place) for place in ((0.5, 0.5), (1.5, 0.5), (3.5, 2.5), (3.5, 1.5))]
    first, (free, obstacle, other, freed) = seen[2], seen[6]
    assert first[:2] == [0, 0]
    assert 0 < first[3] < first[2] == other == obstacle
    assert (free, freed) == (0, 0)
    assert seen[5.9] == seen[3] == first
    assert seen[10] == seen[6]
    seek(browser, 0)
    assert at(0.5, 0.5) is None
    assert browser.complaints == []


def test_a_map_that_is_turned_lies_where_its_cells_are(browser, tmp_path):
    browser.open(page_of(tmp_path, grows(1.0, (0, 0, 4, 1), (2, 3, 1, 2), origin=(5.0, 1.0, np.pi / 2))), *WIDE)
    seek(browser, 1)
    free, obstacle, unseen = (browser.evaluate(f"{OPACITY}({x}, {y})") for x, y in ((4.5, 4.5), (2.5, 4.5), (2.5, 1.5)))
    assert free == 0 < unseen < obstacle


def test_a_run_that_begins_without_a_map_once_more_has_none(browser, tmp_path):
    again = event_of(4.0, "ground_unknown", {"cell_m": 1.0})
    browser.open(page_of(tmp_path, grows(1.0, (0, 0, 4, 1)), again, grows(6.0, (1, 0, 4, 1))), *WIDE)
    seen = []
    for time in (1, 4, 6):
        seek(browser, time)
        seen.append([browser.evaluate(f"{OPACITY}({x}, {y})") for x, y in ((0.5, 0.5), (0.5, 1.5))])
    assert seen[0][0] == 0 < seen[0][1]
    assert seen[1] == [None, None]
    assert seen[2][1] == 0 < seen[2][0]


def test_the_key_names_what_the_map_shows_and_only_where_there_is_one(browser, tmp_path):
    words = "[...document.querySelectorAll('#key li')].map(item => item.textContent)"
    browser.open(page_of(tmp_path, grows(1.0, (0, 0, 4, 1))), *WIDE)
    assert browser.evaluate(words)[-2:] == ["not seen", "obstacle that was seen"]
    browser.open(page_of(tmp_path), *WIDE)
    assert "not seen" not in browser.evaluate(words)
