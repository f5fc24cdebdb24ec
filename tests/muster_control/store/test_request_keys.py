"""Keys of requests: what was made once is not made again. Each test runs on SQLite and on PostgreSQL."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import func, select, update

from muster_control.contract import ConflictError, StoreError
from muster_control.store import Store
from muster_control.store.request_keys import KEPT, RepeatedRequestError, RequestKey
from muster_control.store.schema import request_keys, runs

REQUEST = RequestKey("ann", "k-1", "abc")


def start(filled, request):
    return filled.store.runs.add(filled.mission, 1, filled.plan, "kinematic", {}, 1.0, "ann", request=request)


def counted(store, table):
    with store.database.reading() as connection:
        return connection.execute(select(func.count()).select_from(table)).scalar_one()


def test_a_repeated_request_makes_nothing_also_after_a_restart(filled, database_url):
    run = start(filled, REQUEST)
    again = Store.open(database_url)
    for store in (filled.store, again):
        with pytest.raises(RepeatedRequestError) as repeated:
            store.request_keys.require_new(REQUEST)
        assert repeated.value.made == run.id
    again.close()
    with pytest.raises(RepeatedRequestError):
        start(filled, REQUEST)
    assert counted(filled.store, runs) == 2  # that of `filled`, and this one


def test_a_key_is_of_one_user_and_one_request(filled):
    run = start(filled, REQUEST)
    with pytest.raises(ConflictError, match=r"^Idempotency-Key k-1 was sent with another request; expected a new key$"):
        start(filled, replace(REQUEST, digest="xyz"))
    assert start(filled, replace(REQUEST, user="bob")).id > run.id
    assert start(filled, replace(REQUEST, key="k-2")).id > run.id
    assert start(filled, None).id > run.id
    job = filled.store.jobs.add("plan", filled.mission, 1, {}, "ann", RequestKey("ann", "k-3", "abc"))
    with pytest.raises(RepeatedRequestError) as repeated:
        filled.store.request_keys.require_new(RequestKey("ann", "k-3", "abc"))
    assert repeated.value.made == job.id


def test_what_fails_takes_no_key(filled):
    with pytest.raises(StoreError):
        filled.store.runs.add(filled.mission, 1, 999, "kinematic", {}, 1.0, "ann", request=REQUEST)
    filled.store.request_keys.require_new(REQUEST)
    start(filled, REQUEST)


def test_many_at_once_make_one(filled):
    def one(_):
        try:
            return start(filled, REQUEST).id
        except RepeatedRequestError as repeated:
            return repeated.made

    with ThreadPoolExecutor(6) as threads:
        assert len(set(threads.map(one, range(12)))) == 1
    assert counted(filled.store, runs) == 2


def test_keys_are_forgotten_after_a_while(filled):
    start(filled, REQUEST)
    old = datetime.now(UTC) - KEPT - timedelta(seconds=1)
    with filled.store.database.writing() as connection:
        connection.execute(update(request_keys).values(at=old))
    start(filled, replace(REQUEST, key="k-2"))
    assert counted(filled.store, request_keys) == 1
