"""The campaign of kills, a short one; `make campaign-server` runs the long one."""

import pytest
from tests.muster_control.runs.campaign import Campaign


@pytest.mark.long
def test_what_is_killed_at_random_moments_goes_on(tmp_path):
    counted = Campaign(3, 4, f"sqlite:///{tmp_path / 'muster.db'}").go()
    assert counted["servers"] + counted["runners"] + counted["workers"] == 3
    assert min(counted["servers"], counted["actions"], counted["jobs"]) > 0
