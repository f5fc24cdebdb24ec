"""The live page of a run whose robots have no map: the map that they build grows on it, and errors are none."""

import pytest

from muster_control.client import Client

pytestmark = pytest.mark.xdist_group("explored")

MISSION = "market-rescue-arena"
SHARE = """() => Math.max(...[...document.querySelectorAll("canvas")].map((canvas) => {
  const { width, height } = canvas;
  const pixels = width && height && canvas.getContext("2d")?.getImageData(0, 0, width, height);
  let dark = 0;
  for (let k = 0; pixels && k < pixels.data.length; k += 4) {
    const [red, green, blue, opacity] = pixels.data.slice(k, k + 4);
    dark += opacity > 180 && red + green + blue < 200;
  }
  return pixels ? dark / (width * height) : 0;
}))"""
"""Of the map that is nearly black: obstacles that were seen, and little else."""


@pytest.mark.long
def test_obstacles_appear_as_robots_see_them(watched, served):
    with Client(served) as client:
        plan = client.plan(MISSION, iterations=20).wait()
        shares = {}
        for unknown in (False, True):
            run = client.start(plan, unknown=unknown, speed=1.0)
            watched.open(f"/live/{run.id}")
            watched.page.locator(".run-state[data-state=running]").wait_for()
            watched.page.get_by_text("has done task survivor3").first.wait_for()
            client.run(run.id).act("pause")
            watched.page.locator(".run-state[data-state=paused]").wait_for()
            watched.shoot(f"unknown-{unknown}", settles_ms=1000)
            shares[unknown] = watched.page.evaluate(SHARE)
            client.run(run.id).cancel()
    watched.require_clean()
    assert shares[True] > shares[False] + 0.005
