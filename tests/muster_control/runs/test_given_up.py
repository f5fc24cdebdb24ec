"""A run whose log somebody else has gone on with is given up, and nothing more is written of it here."""

import asyncio

from tests.muster_control.runs.store import ADA, planned

import muster
from muster_control.contract import Entry
from muster_control.services.runs import Runs
from muster_control.settings import Settings
from muster_control.store import Store


def test_a_run_that_another_server_goes_on_with(tmp_path):
    settings = Settings(database=f"sqlite:///{tmp_path}/muster.db")
    store = Store.open(settings.database)

    async def told():
        runs = Runs(store, settings)
        run = (await runs.start(ADA, planned(store, muster.load("31T-6R50")))).id
        while (await runs.get(run)).state != "running":
            await asyncio.sleep(0.02)
        await runs.act(ADA, run, "pause")
        while (await runs.get(run)).state != "paused":
            await asyncio.sleep(0.02)
        await runs.kept(run)
        before = store.log.entries(run)
        theirs = Entry(run=run, seq=before[-1].seq + 1, time_s=before[-1].time_s, kind="resumed", data={})
        store.log.append(run, theirs.time_s, [theirs])
        subscribers = runs.subscribers(run)
        await runs.act(ADA, run, "resume")
        texts = [text async for text in subscribers.watch(theirs.seq)]
        await runs.close()
        assert any("given up here: run 1: entry" in text for text in texts)
        assert [entry.kind for entry in store.log.entries(run, before[-1].seq)] == ["resumed"]
        assert store.runs.get(run).state == "paused"

    asyncio.run(asyncio.wait_for(told(), 60))
    store.close()
