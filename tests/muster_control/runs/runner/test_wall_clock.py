"""A run of real robots that resumes after a crash: its clock is the wall clock, which went on."""

import pytest
from tests.running.run_log import Log
from tests.running.test_wall_time import ANY, DAY_S, SOON, Wall, mission

import muster
from muster.running.run_request import OPEN_FLEET, RunRequest
from muster.state.recovery import recovered_from
from muster_control.runs.runner.real_run import RealRun


@pytest.mark.parametrize("starts", ["given", "now"])
def test_a_deadline_passes_while_no_process_runs(starts):
    there, wall, log = mission(SOON, ANY), Wall(DAY_S if starts == "now" else 0.0), Log()
    plan, request = muster.solve(there, iterations=50), RunRequest(world=OPEN_FLEET, starts=starts)
    run = RealRun(there, plan, wall.fleet(there), log, request=request, wall=wall)
    for _ in range(5):
        run.go_on()
    before, lasted = list(log.entries), run.time_s
    wall.more_s += 40.0
    known = recovered_from(there, plan, before)
    again = RealRun(there, plan, wall.fleet(there), log, state=known, request=request, wall=wall)
    assert again.time_s == pytest.approx(lasted + 40.0, abs=0.5)
    assert again.starts_at == run.starts_at
    while not again.done:
        again.go_on()
        assert again.time_s < 200.0
    report = log.entries[-1]["data"]
    assert report["tasks_done"] == ["any"]
    assert report["mission_time_s"] > 40.0
