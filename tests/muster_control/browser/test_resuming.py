"""The live page of a run that goes on after a crash, and of one whose plans come as differences."""

import pytest
from tests.muster_control.browser.conftest import Watched

from muster_control.client import Client

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("resuming")]

TAKE = """message => {
  const { view } = getElement(Number(document.querySelector('.muster-live-frame').id.slice(1)));
  view.take(message);
  view.showPanels();
  const { routes, state: { leftOut }, hopeless } = view.team;
  return { routes: Object.fromEntries(routes), leftOut: Object.fromEntries(leftOut), hopeless };
}"""


@pytest.fixture(scope="module")
def page(chromium, served):
    """The page of a run that is paused at its beginning."""
    with Client(served) as client:
        run = client.start(client.plan("6T-2R", iterations=20).wait(), speed=0.1)
        run.pause()
    watched = Watched(chromium, served)
    watched.open(f"/live/{run.id}")
    watched.page.locator(".run-state[data-state=paused]").wait_for()
    yield watched
    watched.require_clean()
    watched.page.close()


def take(page, kind, /, **what):
    return page.page.evaluate(TAKE, {"type": kind} | what)


def test_how_far_a_run_is_with_going_on_is_shown(page):
    run = {"speed": 1.0, "time_s": 0.0, "remark": ""}
    take(page, "run", state="resuming", share=0.42, **run)
    assert page.page.locator(".run-state").inner_text().endswith("resuming 42 %")
    assert page.page.locator(".run-state").get_attribute("data-state") == "resuming"
    assert page.page.get_by_role("button", name="Pause").is_disabled()
    assert page.page.locator("button.add").is_enabled()  # what is asked for waits
    take(page, "run", state="paused", share=None, **run)
    assert page.page.locator(".run-state").inner_text().endswith("paused")


def test_a_later_plan_changes_what_it_says_and_nothing_else(page):
    def plan(seq, **data):
        return take(page, "entry", seq=seq, time_s=1.0, kind="plan", data=data, line="plan")

    reasons = [{"robot": "r_1", "reason": "skill", "detail": "no gripper"}]
    whole = {"routes": [], "unassigned": [{"task": "1", "reasons": reasons}]}
    lines = {"r_0": [[0, 0], [1, 1]], "r_1": [[5, 5], [6, 6]]}
    assert plan(900, plan=whole, lines=lines)["leftOut"] == {"1": "skill: no gripper (r_1)"}
    told = plan(901, routes={"r_0": ["2"]}, stops={}, lines={"r_0": [[0, 0], [3, 3]]}, left_out={"3": "no way"})
    assert told["routes"] == {"r_0": [[0, 0, 0], [3, 3, 0]], "r_1": [[5, 5, 0], [6, 6, 0]]}
    assert told["leftOut"] == {"1": "skill: no gripper (r_1)", "3": "no way"}
    told = plan(902, routes={"r_1": []}, stops={}, lines={"r_1": []}, left_out={"1": None})
    assert told["routes"]["r_1"] == []
    assert told["leftOut"] == {"3": "no way"}
