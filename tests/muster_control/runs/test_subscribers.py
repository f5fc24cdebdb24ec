import asyncio
import json

from muster_control.runs.subscribers import Subscribers


def entry(seq):
    return seq, json.dumps({"type": "entry", "seq": seq, "padding": "x" * 1000})


def feed_of(count):
    log = []

    async def read(after):
        return [entry for entry in log if entry[0] > after][:100]

    subscribers = Subscribers(lambda: {"run": {}}, read)
    subscribers.ready()
    for seq in range(1, count + 1):
        log.append(entry(seq))
        subscribers.publish(log[-1:])
    return subscribers, log


def test_who_is_slow_misses_states_but_no_entry_and_takes_no_memory():
    async def story():
        subscribers, log = feed_of(10)
        watcher = subscribers.watch(3)
        told = [json.loads(await anext(watcher)) for _ in range(8)]
        for k in range(5000):
            subscribers.tell("states", json.dumps({"type": "states", "k": k}))
            log.append(entry(11 + k))
            subscribers.publish(log[-1:])
        subscribers.end()
        told += [json.loads(text) async for text in watcher]
        return subscribers, told

    subscribers, told = asyncio.run(story())
    assert told[0] == {"type": "hello", "run": {}, "seq": 10}
    assert [m["seq"] for m in told if m["type"] == "entry"] == list(range(4, 5011))
    assert [m["k"] for m in told if m["type"] == "states"] == [4999]
    assert sum(len(text) for _, text in subscribers._entries) <= 2 * 2**20
    assert subscribers.watchers == 0


def test_a_watcher_of_a_run_that_ended_waits_for_nothing_that_is_nowhere():
    """Entries that were told and then not written, as another server went on with the run."""

    async def story():
        subscribers, log = feed_of(5)
        subscribers._entries.clear()
        log.clear()
        subscribers.end()
        return [json.loads(text)["type"] async for text in subscribers.watch(1)]

    assert asyncio.run(asyncio.wait_for(story(), 30)) == ["hello"]


def test_a_watcher_wakes_for_each_thing_and_hears_the_end():
    async def story():
        subscribers, _ = feed_of(0)
        told = []

        async def watch():
            told.extend([json.loads(text)["type"] async for text in subscribers.watch()])

        task = asyncio.create_task(watch())
        for said in ("states", "status", "run", "states"):
            await asyncio.sleep(0)
            await asyncio.sleep(0)
            subscribers.tell(said, json.dumps({"type": said}))
            await asyncio.sleep(0.01)
        subscribers.publish_action({"id": 1, "outcome": "done"})
        subscribers.end()
        await task
        return told

    assert asyncio.run(story()) == ["hello", "states", "status", "run", "states", "action"]
