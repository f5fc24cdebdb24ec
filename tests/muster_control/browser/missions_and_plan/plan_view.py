"""What one does on the page Plan, for all tests of it."""

import re

from playwright.sync_api import expect

from muster_control.client import Client

SLOW_MS = 90_000
SCENE = "getElement(document.querySelector('.muster-map')).stage.scene"


def plan_view(watched, mission):
    """Open a mission and wait until it is on the map and may be planned."""
    watched.open(f"/plan/{mission}")
    watched.page.wait_for_function("document.querySelectorAll('.muster-map table tr').length > 1", timeout=SLOW_MS)
    watched.page.wait_for_function("document.querySelector('#plan:not([disabled])')")


def task_place(page, task):
    """Where a task's mark is on the screen, as the map's own scripts know it, and its place in metres."""
    return page.evaluate(
        """task => {
          const map = document.querySelector('.muster-map');
          const { stage } = getElement(map);
          const { x, y } = stage.places.tasks.get(task);
          const [right, down] = stage.spot({ id: task, x, y });
          const box = map.getBoundingClientRect();
          return { px: box.left + right, py: box.top + down, x, y };
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
