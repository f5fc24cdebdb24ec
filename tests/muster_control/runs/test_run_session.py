"""What may happen to a run between two moments: crashes, an end, a closing server, a database that refuses."""

import asyncio
import base64
import threading

import pytest
from sqlalchemy import event
from tests.muster_control.runs.played import PLAN, REPORT, entry, play
from tests.muster_control.runs.store import ADA, planned, settings_of

import muster
from muster.mission.errors import ParameterError
from muster_control.contract import Checkpoint, ConflictError, Entry, NotFoundError, StoreError
from muster_control.runs.log.checkpoints import packed_state, unpacked_state
from muster_control.services.runs import Runs


@pytest.fixture
def run(store):
    plan = store.plans.get(planned(store, muster.load("31T-6R50"), iterations=1))
    return store.runs.add(plan.mission, plan.mission_version, plan.id, "kinematic", {}, None, "ada").id


def logged(store, run, *said):
    store.log.append(run, 0.0, [Entry(run=run, **{k: s[k] for k in ("seq", "time_s", "kind", "data")}) for s in said])


def command(seq, action, verb="pause", **data):
    return entry(seq, "command", action=action, verb=verb, data=data, who="ada", outcome="done")


def carried(store, story):
    """Run a story with a server without faces."""

    async def whole():
        runs = Runs(store, settings_of(store))
        await runs.start_up()
        try:
            return await asyncio.wait_for(story(runs), 20)
        finally:
            await asyncio.wait_for(runs.close(), 20)

    return asyncio.run(whole())


async def gone(runs, run):
    while runs.subscribers(run) is not None:
        await asyncio.sleep(0.01)


async def stays(runner, begin):
    yield {"type": "mission", "mission": {}}
    if not begin["log"]:
        yield PLAN
    yield {"type": "going"}
    await runner.gone.wait()


async def ends(runner, begin):
    yield {"type": "mission", "mission": {}}
    yield PLAN
    yield entry(2, "report", **REPORT)


def refused(store, table, method, times):
    """The next so many calls are refused by the database."""
    kept, left = getattr(table, method), list(range(times))

    def refusing(*arguments, **named):
        if left:
            left.pop()
            raise StoreError("the database is gone; start it")
        return kept(*arguments, **named)

    object.__setattr__(table, method, refusing)


def test_actions_are_settled_by_a_log_that_was_whole_before_a_crash(store, run):
    obeyed, late = (store.actions.add(ADA, f"run.{verb}", {}, run=run) for verb in ("pause", "resume"))
    logged(store, run, PLAN, command(2, obeyed.id), entry(3, "report", **REPORT))
    carried(store, lambda runs: gone(runs, run))
    assert (store.runs.get(run).state, store.runs.get(run).ended_at) == ("ended", store.log.entries(run)[-1].at)
    outcomes = {action.id: action.outcome for action in store.actions.list(run=run)}
    assert outcomes == {obeyed.id: "done", late.id: "the run was over before"}


def test_who_asked_before_a_crash_is_obeyed_before_who_asks_after_it(store, run, monkeypatch):
    started = play(monkeypatch, stays)
    before = store.actions.add(ADA, "run.pause", {}, run=run)
    reading, unsettled = threading.Event(), store.actions.unsettled

    def slow(run):
        reading.wait(10)
        return unsettled(run)

    monkeypatch.setattr(store.actions, "unsettled", slow)

    async def story(runs):
        after = await runs.act(ADA, run, "resume")
        reading.set()
        while not started or started[0].told.qsize() < 2:
            await asyncio.sleep(0.01)
        assert [started[0].told.get_nowait()["id"] for _ in range(2)] == [before.id, after.id]

    carried(store, story)


def test_a_run_that_is_resumed_begins_where_watchers_have_seen_it(store, run, monkeypatch):
    begins = []

    async def seen(runner, begin):
        begins.append(begin)
        yield {"type": "mission", "mission": {}}
        if not begin["log"]:
            yield PLAN
            yield {"type": "states", "time_s": 5.5}
            return
        yield entry(2, "report", **REPORT)

    play(monkeypatch, seen)
    carried(store, lambda runs: gone(runs, run))
    assert [begin["until_s"] for begin in begins] == [0.0, 5.5]


@pytest.mark.parametrize("patience_s", [30.0, 0.5])
def test_who_asks_while_it_ends_is_told_so(store, run, monkeypatch, patience_s):
    """The database takes the action when the run is over: while it is waited for, or after that."""
    monkeypatch.setattr("muster_control.services.runs.PATIENCE_S", patience_s)
    started = play(monkeypatch, stays)
    keep, adding, over = store.actions.keep, threading.Event(), threading.Event()

    def slow(*arguments, **named):
        adding.set()
        over.wait(10)
        return keep(*arguments, **named)

    async def story(runs):
        monkeypatch.setattr(store.actions, "keep", slow)
        asking = asyncio.create_task(runs.act(ADA, run, "pause"))
        await asyncio.to_thread(adding.wait)
        while not started:
            await asyncio.sleep(0.01)
        runs._sessions[run]._reported = True
        started[0].gone.set()
        await gone(runs, run)
        if patience_s > 1.0:
            over.set()
        with pytest.raises(ConflictError, match="is over"):
            await asking
        over.set()

    carried(store, story)
    assert [action.outcome for action in store.actions.list(run=run)] == ["the run was over before"]


def test_a_runner_that_dies_each_time_it_has_gone_on_fails_the_run(store, run, monkeypatch):
    async def dies(runner, begin):
        yield {"type": "mission", "mission": {}}
        yield entry(len(begin["log"]) + 1, "resumed", how="") if begin["log"] else PLAN

    started = play(monkeypatch, dies)
    carried(store, lambda runs: gone(runs, run))
    assert len(started) == 3
    assert store.runs.get(run).state == "failed"


def test_a_server_that_closes_while_a_run_begins_does_not_wait_for_it(store, run, monkeypatch):
    started, reading, get = play(monkeypatch, stays), threading.Event(), store.plans.get

    def slow(plan):
        reading.wait(10)
        return get(plan)

    monkeypatch.setattr(store.plans, "get", slow)

    async def story(runs):
        closing = asyncio.create_task(runs.close())
        await asyncio.sleep(0.1)
        reading.set()
        await asyncio.wait_for(closing, 5)

    carried(store, story)
    assert all(runner.gone.is_set() for runner in started)
    assert store.runs.get(run).state == "starting"


@pytest.mark.long
def test_a_server_can_be_closed_while_the_database_refuses_the_end_of_a_run(store, run, monkeypatch):
    play(monkeypatch, ends)

    async def story(runs):
        refused(store, store.log, "append", 10**6)
        while (await runs.get(run)).state != "ended":
            await asyncio.sleep(0.01)
        await asyncio.wait_for(runs.close(), 10)

    carried(store, story)
    assert store.runs.get(run).state == "starting"


@pytest.mark.parametrize("what", ["log.entries", "actions.unsettled", "missions.get", "plans.get"])
def test_a_database_that_cannot_be_read_for_a_while_does_not_end_a_run(store, run, monkeypatch, what):
    started = play(monkeypatch, stays)
    asked = store.actions.add(ADA, "run.pause", {}, run=run)
    table, method = what.split(".")
    refused(store, getattr(store, table), method, 1)

    async def story(runs):
        while not started or not started[0].told.qsize():
            await asyncio.sleep(0.01)
        assert started[0].told.get_nowait()["id"] == asked.id

    carried(store, story)
    assert store.runs.get(run).state == "running"


def test_an_error_of_ours_ends_the_runner_too(store, run, monkeypatch):
    async def says_nonsense(runner, begin):
        yield {"type": "entry"}
        await runner.gone.wait()

    started = play(monkeypatch, says_nonsense)
    carried(store, lambda runs: gone(runs, run))
    assert started[0].gone.is_set()
    assert "an error of mission control: KeyError" in store.runs.get(run).remark


@pytest.mark.parametrize("error", [NotFoundError("no run"), RuntimeError("odd")])
def test_whatever_keeps_a_log_from_being_written_is_said_and_tried_again(store, run, monkeypatch, error):
    play(monkeypatch, stays)
    monkeypatch.setattr("muster_control.runs.log.writer.AGAIN_S", 0.1)
    append, broken = store.log.append, [True]

    def odd(*arguments):
        if broken:
            raise error
        return append(*arguments)

    monkeypatch.setattr(store.log, "append", odd)

    async def story(runs):
        while not (await runs.get(run)).remark:
            await asyncio.sleep(0.01)
        broken.clear()
        while (await runs.get(run)).remark:
            await asyncio.sleep(0.01)

    carried(store, story)
    assert len(store.log.entries(run)) == 1


def test_actions_that_the_database_refused_have_numbers_of_their_own_after_a_crash(store, run, monkeypatch):
    play(monkeypatch, stays)
    numbers = []
    for _ in range(2):

        async def story(runs):
            refused(store, store.actions, "keep", 2)
            numbers.extend([(await runs.act(ADA, run, verb)).id for verb in ("pause", "resume")])

        carried(store, story)
    assert numbers == sorted(set(numbers))


def test_actions_that_the_database_refused_are_written_once_and_as_of_when_they_were_asked_for(store, run, monkeypatch):
    async def obeys(runner, begin):
        yield {"type": "mission", "mission": {}}
        yield PLAN
        asked = await runner.told.get()
        yield command(2, asked["id"], asked["verb"])
        yield entry(3, "report", **REPORT)

    play(monkeypatch, obeys)

    async def story(runs):
        refused(store, store.actions, "keep", 3)  # both, and the outcome of the first
        one, other = await runs.act(ADA, run, "pause"), await runs.act(ADA, run, "resume")
        await gone(runs, run)
        return one, other

    asked = carried(store, story)
    found = store.actions.list(run=run)[::-1]
    assert [(a.verb, a.at, a.outcome) for a in found] == [
        (asked[0].verb, asked[0].at, "done"),
        (asked[1].verb, asked[1].at, "the run was over before"),
    ]


def test_a_run_whose_start_cannot_be_written_down_is_not_there(store, run):
    plan = store.runs.get(run).plan
    store.runs.set(run, state="failed")

    @event.listens_for(store.database._engine, "before_cursor_execute")
    def refuse(connection, cursor, statement, *_):
        if statement.startswith("INSERT INTO actions"):
            cursor.execute("INSERT INTO no_such_table VALUES (1)")

    async def story(runs):
        with pytest.raises(StoreError):
            await runs.start(ADA, plan)

    carried(store, story)
    assert store.runs.unfinished() == []


def test_what_no_pipe_can_carry_is_refused(store, run, monkeypatch):
    play(monkeypatch, stays)

    async def story(runs):
        with pytest.raises(ParameterError, match="half a character"):
            await runs.act(ADA, run, "event", {"cancel_task": "\ud800"})
        with pytest.raises(ParameterError, match="not finite"):
            await runs.act(ADA, run, "event", {"delay_task": {"task": "3", "by_s": float("nan")}})

    carried(store, story)
    assert store.actions.list(run=run) == []


def packed(run, seq):
    return {"type": "checkpoint", "seq": seq, "data": base64.b64encode(packed_state({"of": seq})).decode()}


async def until(holds):
    while not holds():
        await asyncio.sleep(0.01)


def test_a_checkpoint_takes_the_place_of_the_entries_before_it(store, run, monkeypatch):
    begins = []

    async def dies(runner, begin):
        begins.append(begin)
        yield {"type": "mission", "mission": {}}
        if len(begins) == 1:
            yield PLAN
            yield {"type": "going"}
            yield command(2, store.actions.add(ADA, "run.pause", {}, run=run).id)
            yield packed(run, 2)
            yield entry(3, "arrives", 4.0, robot="r_0", task="7")
            yield {"type": "entry", "seq": 4, "time_s": 5.0, "kind": "starts", "data": {}, "line": "", "whole": False}
            return
        yield entry(begin["seq"] + 1, "resumed", 4.0, how="")
        await runner.gone.wait()

    play(monkeypatch, dies)

    async def once_more(runs):
        await until(lambda: len(begins) == 2 and runs.subscribers(run).seq == 4)

    carried(store, once_more)
    again, seen = begins[1], [(one["seq"], one["kind"]) for one in begins[1]["log"]]
    assert (again["seq"], seen, again["paused"]) == (3, [(3, "arrives")], True)  # what a crash cut short never was
    assert unpacked_state(base64.b64decode(again["checkpoint"])) == {"of": 2}
    carried(store, lambda runs: until(lambda: len(begins) == 3))  # of another server, from the database
    last = begins[2]
    assert (last["seq"], [one["seq"] for one in last["log"]], last["checkpoint"]) == (4, [3, 4], again["checkpoint"])
    assert last["paused"]
    assert store.runs.get(run).resumed == sum(one.kind == "resumed" for one in store.log.entries(run)) > 0


def test_where_the_last_checkpoint_is_damaged_the_one_before_is_used(store, run, monkeypatch, caplog):
    logged(store, run, PLAN, entry(2, "arrives"), entry(3, "starts"))
    facts = {"state": "running", "speed": None, "resumed": 0}
    whole = packed_state({"of": 1})
    for seq, data in ((1, whole), (3, whole[:-3])):
        store.log.add_checkpoint(Checkpoint(run=run, seq=seq, data=data, facts=facts))
    begins = []

    async def begin_only(runner, begin):
        begins.append(begin)
        yield {"type": "mission", "mission": {}}
        await runner.gone.wait()

    play(monkeypatch, begin_only)
    carried(store, lambda runs: until(lambda: begins))
    assert [one["seq"] for one in begins[0]["log"]] == [2, 3]
    assert "its checkpoint of entry 3 is damaged" in caplog.text


def test_while_the_database_is_away_the_newest_checkpoint_waits_alone(store, run, monkeypatch):
    monkeypatch.setattr("muster_control.runs.log.writer.AGAIN_S", 0.05)
    begins, add, written = [], store.log.add_checkpoint, []

    async def goes_on(runner, begin):
        begins.append(begin)
        yield {"type": "mission", "mission": {}}
        if len(begins) == 1:
            for seq in range(1, 40):
                yield PLAN if seq == 1 else entry(seq, "arrives", seq / 10)
                if seq % 10 == 0:
                    yield packed(run, seq)
            return
        await runner.gone.wait()

    def kept(checkpoint):
        written.append(checkpoint.seq)
        add(checkpoint)

    monkeypatch.setattr(store.log, "add_checkpoint", kept)
    play(monkeypatch, goes_on)

    async def story(runs):
        refused(store, store.log, "append", 10)
        await until(lambda: len(begins) == 2)
        await until(lambda: not runs.troubles and store.log.checkpoints(run))

    carried(store, story)
    assert [one["seq"] for one in begins[1]["log"]] == list(range(31, 40))
    assert written == [30]


def test_a_run_that_goes_on_is_resuming_and_what_it_is_asked_waits_in_order(store, run, monkeypatch):
    logged(store, run, PLAN, entry(2, "arrives"))
    store.runs.set(run, state="running")
    going = asyncio.Event()

    async def slow(runner, begin):
        yield {"type": "mission", "mission": {}}
        yield {"type": "resuming", "share": 0.6}
        await going.wait()
        yield {"type": "going"}
        for seq in (3, 4):
            asked = await runner.told.get()
            yield command(seq, asked["id"], asked["verb"], **asked["data"])
        await runner.gone.wait()

    play(monkeypatch, slow)

    async def story(runs):
        while (await runs.get(run)).share != 0.6:
            await asyncio.sleep(0.01)
        seen = await runs.get(run)
        assert (seen.state, [one.state for one in runs.present()]) == ("resuming", ["resuming"])
        assert '"state":"resuming"' in runs.subscribers(run).newest("run")
        orders = [{"new_task": {"id": name, "position": [0, 0]}} for name in ("a", "b")]
        asked = [await runs.act(ADA, run, "orders", {"orders": [one]}) for one in orders]
        assert (await runs.get(run)).state == "resuming"
        going.set()
        await until(lambda: runs.subscribers(run).seq == 4)
        now = await runs.get(run)
        assert (now.state, now.share) == ("running", None)
        return asked

    asked = carried(store, story)
    commands = [one.data["action"] for one in store.log.entries(run) if one.kind == "command"]
    assert commands == [action.id for action in asked]


def test_what_a_run_was_asked_that_cannot_go_on_is_refused_with_the_reason(store, run, monkeypatch):
    logged(store, run, PLAN)
    asking = asyncio.Event()

    async def fails(runner, begin):
        yield {"type": "mission", "mission": {}}
        asking.set()
        await runner.told.get()
        yield {"type": "failed", "reason": "world odd: it cannot be resumed"}

    play(monkeypatch, fails)

    async def story(runs):
        await asking.wait()
        assert (await runs.get(run)).state == "resuming"
        await runs.act(ADA, run, "pause")
        await gone(runs, run)

    carried(store, story)
    found = store.runs.get(run)
    assert (found.state, found.remark) == ("failed", "world odd: it cannot be resumed")
    assert [action.outcome for action in store.actions.list(run=run)] == ["the run was over before"]
