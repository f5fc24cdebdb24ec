"""Robots without tasks, where they are many, are counted and not named."""

import pytest

import muster

pytest.importorskip("matplotlib")


@pytest.mark.parametrize(("robots", "named"), [(5, True), (6, False)])
def test_many_idle_robots_are_counted(robots, named):
    mission = muster.Mission(
        robots=tuple(muster.Robot(id=f"r_{k}", position=(k, 0)) for k in range(robots)),
        tasks=(muster.Task(id="t", position=(0, 1)),),
    )
    plan = muster.solve(mission, "greedy")
    ax = muster.plot(mission, plan)
    texts = [text.get_text() for text in ax.figure.findobj(lambda artist: hasattr(artist, "get_text"))]
    assert any(text == "r_0" for text in texts)
    assert any(text == "r_3" for text in texts) == named
    assert any(text == "5 robots without tasks" for text in texts) != named
