"""`muster ros` that was killed: what is refused, `--resume` and `--recover`, on a real ROS master."""

import json

import pytest
from tests.muster_robots.ros1.test_failures import FAR, QUICK


def driven_until(process, words):
    for line in process.stderr:
        if words in line:
            return
    raise AssertionError(words)


@pytest.mark.long
def test_a_mission_goes_on_and_robots_are_brought_home(ros):
    (ros.folder / "far.yaml").write_text(FAR, "utf-8")
    ros.robot("r_0", 0, 0)
    first = ros.muster("far.yaml", *QUICK)
    driven_until(first, "r_0 has done task t_1")
    first.kill()
    first.communicate(timeout=20)

    again = ros.muster("far.yaml", *QUICK)
    _, err = again.communicate(timeout=60)
    assert again.returncode == 2
    assert "did not end (1 task done), and has left r_0: stands; at (" in err
    assert "expected --resume, which goes on with it, or --recover" in err

    resumed = ros.muster("far.yaml", *QUICK, "--resume")
    out, err = resumed.communicate(timeout=60)
    assert resumed.returncode == 0, err
    assert json.loads(out)["tasks_done"] == ["t_1", "t_2"]
    assert "task t_1" not in err.replace("1 task done", "")

    home = ros.muster("far.yaml", *QUICK, "--recover")
    out, err = home.communicate(timeout=60)
    assert home.returncode == 0, err
    (row,) = json.loads(out)["robots"]
    assert row["state"].startswith("r_0: stands; at (0.")
