"""The study of rotors: within 10 % of published parameters and of the published equations solved apart."""

from importlib.util import find_spec

import numpy as np
import pytest

from muster_studies.effort import Effort
from muster_studies.registry import study_named
from muster_studies.rotors.study import Response
from muster_studies.tables import CHECK_MARK

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)


@pytest.mark.long
def test_all_figures_are_within_ten_per_cent():
    report = study_named("rotors").run(Effort())
    assert [table.number for table in report.tables] == ["hover", "steps"]
    for table in report.tables:
        for record in table.records():
            assert record["mark"] == CHECK_MARK, record
            assert abs(record["%"]) <= 10
    figures = {record["figure"]: record["own"] for record in report.tables[0].records()}
    assert figures["speed of rotors hovering, rad/s"] == pytest.approx(547.59, abs=0.01)


def test_a_response_of_second_order_has_the_figures_of_the_textbook():
    """Damping 0.5 and 1 rad/s: overshoot exp(-pi z / sqrt(1 - z^2)) = 16.3 %, rise 1.64 s, settled after 8.08 s."""
    times, z = np.linspace(0.0, 20.0, 20001), 0.5
    damped = np.sqrt(1 - z * z)
    shares = 1 - np.exp(-z * times) * (np.cos(damped * times) + z / damped * np.sin(damped * times))
    found = Response.of(times, shares)
    assert found.overshoot == pytest.approx(100 * np.exp(-np.pi * z / damped), abs=0.01)
    assert found.rise_s == pytest.approx(1.64, abs=0.01)
    assert found.settled_s == pytest.approx(8.08, abs=0.02)
