"""Double faults: the database goes away, and then the server is killed. `make campaign-faults` runs a hundred."""

import pytest
from tests.muster_control.databases import postgresql_programs
from tests.muster_control.runs.double_faults import DoubleFaults


@pytest.mark.long
def test_no_order_is_lost_that_was_accepted_while_the_database_was_away(tmp_path, monkeypatch):
    if postgresql_programs() is None:
        pytest.skip("no PostgreSQL here; tools/test_packages.sh installs it")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    counted = DoubleFaults(2, seed=3, orders=20).go()
    assert (counted["stopped"], counted["frozen"]) == (1, 1)
    assert counted["orders while away"] >= 40
    assert all(journal.stat().st_size == 0 for journal in tmp_path.rglob("*.journal"))
