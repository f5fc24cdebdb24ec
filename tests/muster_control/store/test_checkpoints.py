"""Checkpoints of runs: the last two are kept, each is whole or not there, and they go with their run."""

import pytest
from sqlalchemy import event

from muster_control.contract import Checkpoint, ConflictError
from muster_control.store.prune import prune

FACTS = {"state": "paused", "speed": None, "resumed": 2}


def checkpoint(run, seq, data=b"\x00\xff"):
    return Checkpoint(run=run, seq=seq, data=data, facts=FACTS)


@pytest.fixture
def log(filled):
    filled.store.log.append(filled.run, 1.5, [filled.entry(k) for k in range(1, 6)])
    return filled.store.log


@pytest.mark.long(keep=1)
def test_the_last_two_are_kept_the_newest_first(filled, log):
    made = [checkpoint(filled.run, seq) for seq in (1, 2, 5)]
    for one in made:
        log.add_checkpoint(one)
    assert log.checkpoints(filled.run) == made[:0:-1]


@pytest.mark.parametrize("seq", [6, 3, 2])
def test_one_that_the_log_does_not_reach_or_that_is_late_is_refused(filled, log, seq):
    log.add_checkpoint(checkpoint(filled.run, 3))
    with pytest.raises(ConflictError, match=f"a checkpoint of entry {seq}; expected one after entry 3 up to 5"):
        log.add_checkpoint(checkpoint(filled.run, seq))
    assert [one.seq for one in log.checkpoints(filled.run)] == [3]


@pytest.mark.parametrize("word", ["INSERT INTO checkpoints", "DELETE FROM checkpoints"])
def test_a_write_that_is_cut_short_leaves_those_before(filled, log, word):
    kept = [checkpoint(filled.run, seq) for seq in (3, 2)]
    for one in reversed(kept):
        log.add_checkpoint(one)

    def cut(connection, cursor, statement, *_):
        if statement.startswith(word):
            raise KeyboardInterrupt

    engine = filled.store.database._engine
    event.listen(engine, "after_cursor_execute", cut)
    with pytest.raises(KeyboardInterrupt):
        log.add_checkpoint(checkpoint(filled.run, 5))
    event.remove(engine, "after_cursor_execute", cut)
    assert log.checkpoints(filled.run) == kept
    log.add_checkpoint(checkpoint(filled.run, 5))
    assert [one.seq for one in log.checkpoints(filled.run)] == [5, 3]


def test_bodies_are_those_of_the_last_entries_that_were_written(filled, log):
    assert log.bodies(filled.run) is None
    log.append(filled.run, 3.0, [filled.entry(6)], bodies={"time_s": 3.0})
    log.append(filled.run, 4.0, [filled.entry(7)])
    with pytest.raises(ConflictError):
        log.append(filled.run, 5.0, [filled.entry(9)], bodies={"time_s": 5.0})
    assert log.bodies(filled.run) == {"time_s": 3.0}


def test_they_go_with_their_run(filled, log, database_url):
    log.append(filled.run, 3.0, [filled.entry(6)], bodies={"time_s": 3.0})
    log.add_checkpoint(checkpoint(filled.run, 5))
    filled.store.runs.set(filled.run, state="ended")
    assert prune(database_url, -1.0).runs == 1
    assert (log.checkpoints(filled.run), log.bodies(filled.run)) == ([], None)
