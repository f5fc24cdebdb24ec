"""The log of a run: idempotent, without gaps, and nothing of it ever changes."""

from dataclasses import replace
from threading import Thread

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import text

from muster.mission.errors import ParameterError
from muster_control.contract import ConflictError, StoreError


@pytest.fixture
def log(filled):
    filled.store.log.append(filled.run, 1.5, [filled.entry(1), filled.entry(2)], [filled.stretch(1)])
    return filled.store.log


def test_what_is_there_is_left_out(filled, log):
    before = log.entries(filled.run)
    again = [filled.entry(1), filled.entry(2), filled.entry(3, new=True)]
    assert log.append(filled.run, 2.0, again, [filled.stretch(1, b"other"), filled.stretch(2)]) == 1
    assert log.append(filled.run, 2.0, again, [filled.stretch(1), filled.stretch(2)]) == 0
    assert log.entries(filled.run)[:2] == before
    assert [entry.data for entry in log.entries(filled.run, after=2)] == [{"new": True}]
    assert [stretch.data for stretch in log.stretches(filled.run)] == [b"\x00\xff", b"\x00\xff"]
    assert (len(log.entries(filled.run)), log.last_stretch(filled.run)) == (3, 2)
    assert [entry.seq for entry in log.entries(filled.run, after=1, limit=1)] == [2]


def test_another_entry_in_the_place_of_one_that_is_there_is_refused(filled, log):
    log.append(filled.run, 2.0, [filled.entry(3, route=("1", "2"), at=0.1)])
    assert log.append(filled.run, 2.0, [filled.entry(3, route=("1", "2"), at=0.1)]) == 0
    for other in (filled.entry(2, other=True), filled.entry(2, "starts"), replace(filled.entry(2), time_s=7.0)):
        with pytest.raises(ConflictError, match=f"run {filled.run}: entry 2 is arrives at 1 s, not .*one server alone"):
            log.append(filled.run, 9.0, [filled.entry(1), other, filled.entry(3), filled.entry(4)])
    assert len(log.entries(filled.run)) == 3


def test_a_gap_is_refused_and_nothing_of_the_batch_is_kept(filled, log):
    with pytest.raises(ConflictError, match=f"run {filled.run}: entry 5 does not follow 3; expected 4"):
        log.append(filled.run, 9.0, [filled.entry(3), filled.entry(5)])
    with pytest.raises(ConflictError, match="stretch 3 does not follow 1; expected 2"):
        log.append(filled.run, 9.0, [filled.entry(3)], [filled.stretch(3)])
    assert len(log.entries(filled.run)) == 2
    assert filled.store.runs.get(filled.run).time_s == 1.5
    with pytest.raises(ParameterError, match="entry 0"):
        log.append(filled.run, 9.0, [filled.entry(0)])


def test_the_run_knows_its_time_and_its_report(filled, log):
    log.append(filled.run, 1.0, [filled.entry(3, "report", done=["1"])])
    run = filled.store.runs.get(filled.run)
    assert (run.time_s, run.report) == (1.5, {"done": ["1"]})


def test_many_stretches_are_read_in_portions(filled):
    filled.store.log.append(filled.run, 1.0, [], [filled.stretch(k, b"%d" % k) for k in range(1, 151)])
    assert [stretch.seq for stretch in filled.store.log.stretches(filled.run)] == list(range(1, 151))


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(st.lists(st.tuples(st.integers(1, 12), st.integers(1, 12)), max_size=8))
def test_whatever_is_written_again_the_log_is_one_sequence(filled, spans):
    """A model: a batch from `a` to `b` is taken where it joins the log, and refused where it does not."""
    run = filled.store.runs.add(filled.mission, 1, filled.plan, "kinematic", {}, 1.0, "ann").id
    filled.run, last = run, 0
    for a, b in spans:
        batch = [filled.entry(seq) for seq in range(a, b + 1)]
        if batch and a > last + 1:
            with pytest.raises(ConflictError):
                filled.store.log.append(run, 0.0, batch)
        else:
            assert filled.store.log.append(run, 0.0, batch) == max(0, b - last if batch else 0)
            last = max(last, b if batch else 0)
        assert [entry.seq for entry in filled.store.log.entries(run)] == list(range(1, last + 1))


REFUSED = (
    "UPDATE {log} SET seq = seq + 10",
    "DELETE FROM {log}",
    "DELETE FROM {log} WHERE seq = 1",
    "INSERT INTO {log} SELECT * FROM {log} WHERE seq = 1",
    "INSERT INTO {log} SELECT {gap} FROM {log} WHERE seq = 1",
)
COLUMNS = {
    "entries": "run, 99 AS seq, time_s, kind, data, at",
    "stretches": "run, 99 AS seq, from_s, until_s, data",
}


@pytest.mark.long(keep=8)
@pytest.mark.parametrize("table", COLUMNS)
@pytest.mark.parametrize("statement", REFUSED)
def test_the_database_itself_refuses_changes(filled, log, table, statement):
    before = (log.entries(filled.run), list(log.stretches(filled.run)))
    with pytest.raises(StoreError), filled.store.database.writing() as connection:
        connection.execute(text(statement.format(log=table, gap=COLUMNS[table])))
    assert (log.entries(filled.run), list(log.stretches(filled.run))) == before


def test_each_database_has_ways_of_its_own_which_are_refused_too(filled, log):
    if filled.store.database.is_sqlite:
        statement = "INSERT OR REPLACE INTO entries SELECT run, 1, 7.0, kind, data, at FROM entries WHERE seq = 2"
    else:
        statement = "TRUNCATE entries"
    with pytest.raises(StoreError, match="only grows"), filled.store.database.writing() as connection:
        connection.execute(text(statement))
    assert [entry.time_s for entry in log.entries(filled.run)] == [0.5, 1.0]


def test_writers_at_once(filled):
    """Four threads write the same entries in batches of their own: each entry is there once."""
    new = []

    def write(size):
        seq = 1
        while seq <= 40:
            batch = [filled.entry(k) for k in range(seq, min(41, seq + size))]
            new.append(filled.store.log.append(filled.run, float(seq), batch))
            seq += size

    threads = [Thread(target=write, args=(size,)) for size in (1, 3, 4, 7)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sum(new) == 40
    assert [entry.seq for entry in filled.store.log.entries(filled.run)] == list(range(1, 41))
