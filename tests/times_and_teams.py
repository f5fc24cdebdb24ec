"""Tasks for three robots: one in a time window, then one for two robots, and one that begins with it."""

import pytest

from muster.mission.model import Task


def tasks_of(opens_s, side=1.0, height=()):
    """The first task waits for its window. `side` is about the distance of tasks, and `height` in the air: metres."""
    first, second, third = ((x * side, y * side, *height) for x, y in ((2.0, 0.0), (3.0, 0.6), (4.0, 1.2)))
    return (
        Task(id="look", position=first, duration_s=0.4 * side, window_s=((opens_s, None),)),
        Task(id="lift", position=second, duration_s=0.5 * side, robots_needed=2, prerequisites=("look",)),
        Task(id="watch", position=third, duration_s=0.5 * side, starts_with=("lift",)),
    )


def judge(report, opens_s):
    """All is done, in its window, by as many as needed, and together; of a report as plain data."""
    starts_s = report["starts_s"]
    assert set(report["tasks_done"]) == {"look", "lift", "watch"}
    assert starts_s["look"] == pytest.approx(opens_s, abs=1.0)
    assert starts_s["lift"] >= report["ends_s"]["look"]
    assert starts_s["watch"] == starts_s["lift"]
    (lift,) = [row for row in report["tasks"] if row["task"] == "lift"]
    assert len(lift["team"]) == 2
    assert report["waiting_by_cause_s"]["window"] > 0
