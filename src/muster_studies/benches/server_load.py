"""Clients of mission control for its bench, in a process of their own so that their processor time is apart.

`sockets ADDRESS RUN COUNT WINDOWS SECONDS` opens so many streams of a run, and prints for each window of time what came
over them as a line of JSON; `page ADDRESS RUN SECONDS` opens the page of the run in a browser, and prints how late what
it drew was.
"""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import sys
import time
from collections.abc import Sequence
from typing import Any

_CHROMIUM = ("--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update")

_NOTES_WHAT_IS_DRAWN = """
window.late_ms = [];
const Plain = window.WebSocket;
window.WebSocket = class extends Plain {
  constructor(...given) {
    super(...given);
    if (!String(given[0]).includes("/stream")) return;
    this.addEventListener("message", (event) => {
      const said = JSON.parse(event.data);
      if (said.type !== "states") return;
      requestAnimationFrame(() => requestAnimationFrame(() => window.late_ms.push(Date.now() - 1000 * said.sent_at)));
    });
  }
};
"""
"""The second frame after a message is drawn after what the page did with the message."""


class Watched:
    """How late states came, and how many, in the present window."""

    def __init__(self) -> None:
        self.late_s: list[float] = []

    async def watch(self, address: str) -> None:
        """Listen to one stream until it ends."""
        from websockets.asyncio.client import connect

        async with connect(address, max_size=None) as socket:
            async for text in socket:
                said = json.loads(text)
                if said["type"] == "states":
                    self.late_s.append(time.time() - said["sent_at"])

    def taken(self, window_s: float, count: int) -> dict[str, float]:
        """The figures of the window; then start a new one."""
        late, self.late_s = sorted(self.late_s), []
        return {
            "median_ms": 1000 * late[len(late) // 2],
            "p95_ms": 1000 * late[len(late) * 95 // 100],
            "slowest_ms": 1000 * late[-1],
            "states_hz": len(late) / window_s / count,
        }


async def sockets(address: str, run: int, count: int, windows: int, window_s: float) -> None:
    """Watch with many streams."""
    seen = Watched()
    url = f"{address.replace('http', 'ws', 1)}/api/v1/runs/{run}/stream"
    watching = [asyncio.create_task(seen.watch(url)) for _ in range(count)]
    await asyncio.sleep(3.0)  # all are there, and have been told the past
    for _ in range(windows):
        seen.late_s.clear()
        begun = time.monotonic()
        await asyncio.sleep(window_s)
        _say(seen.taken(time.monotonic() - begun, count))
    for task in watching:
        task.cancel()


def page(address: str, run: int, window_s: float) -> None:
    """Watch with a browser."""
    from playwright.sync_api import sync_playwright

    browser_path = os.environ.get("MUSTER_BROWSER") or shutil.which("chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_path, args=list(_CHROMIUM))
        seen = browser.new_page(viewport={"width": 1440, "height": 900})
        seen.add_init_script(_NOTES_WHAT_IS_DRAWN)
        seen.goto(f"{address}/live/{run}")
        seen.wait_for_function("window.late_ms.length > 20", timeout=60_000)
        seen.evaluate("window.late_ms.length = 0")
        time.sleep(window_s)
        late: list[float] = sorted(seen.evaluate("window.late_ms"))
        browser.close()
    _say({"median_ms": late[len(late) // 2], "p95_ms": late[len(late) * 95 // 100], "states_hz": len(late) / window_s})


def _say(found: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(found) + "\n")
    sys.stdout.flush()


def main(arguments: Sequence[str]) -> None:
    """Be the one or the other."""
    what, address, run, *numbers = arguments
    if what == "sockets":
        count, windows, window_s = numbers
        asyncio.run(sockets(address, int(run), int(count), int(windows), float(window_s)))
    else:
        page(address, int(run), float(numbers[0]))


if __name__ == "__main__":
    main(sys.argv[1:])
