"""The pool: answers whole, work in order, limits kept, and nothing left of what was stopped."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from muster_control.contract import BusyError, NotFoundError
from muster_control.work import OutOfMemory, Pool, StopRequest, TimedOut, WorkerDied, WorkError

PROGRAM = (sys.executable, str(Path(__file__).with_name("odd_worker.py")))


@asynccontextmanager
async def pool_of(workers=1, **how):
    pool = Pool(workers=workers, **{"memory_mb": 1024, "program": PROGRAM, **how})
    try:
        yield pool
    finally:
        await pool.close()


def in_pool(story, workers=1, **how):
    """Run `story(pool)` to its end."""

    async def whole():
        async with pool_of(workers, **how) as pool:
            return await story(pool)

    return asyncio.run(whole())


def is_there(pid):
    """Whether a process lives; one that has ended and was not asked for its code does not."""
    try:
        return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except (FileNotFoundError, ProcessLookupError):  # the latter if it ends between opening and reading
        return False


async def until(condition, seconds=10.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        await asyncio.sleep(0.01)


async def sleeping(pool, **how):
    """A piece of work that sleeps, its processes and its folder."""
    heard = asyncio.Queue()
    work = asyncio.create_task(pool.run("sleeps", {}, on_progress=heard.put_nowait, **how))
    begun = asyncio.create_task(heard.get())
    await asyncio.wait({work, begun}, return_when=asyncio.FIRST_COMPLETED)
    if not begun.done():
        begun.cancel()
        await work  # which says why it has not begun
    said = begun.result()
    return work, said["pids"], Path(said["folder"])


def test_large_requests_and_answers_pass_whole():
    large = {"text": "é" * 3_000_000, "lines": ["x\n" * 10] * 1000}

    async def story(pool):
        assert await pool.run("echo", large) == large

    in_pool(story)


def test_a_slow_listener_gets_all_progress_in_order():
    async def story(pool):
        heard = []
        await pool.run("counts", {"times": 200, "size": 100_000}, on_progress=lambda p: heard.append(p["k"]))
        assert heard == list(range(200))

    in_pool(story)


def test_what_libraries_print_is_no_answer():
    async def story(pool):
        assert await pool.run("prints", {}) == {"done": "true answer"}
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story)


def test_a_process_is_used_again():
    async def story(pool):
        return [(await pool.run("pid", {}))["pid"] for _ in range(3)]

    assert len(set(in_pool(story))) == 1


def test_an_idle_process_ends_after_a_while():
    async def story(pool):
        pid = (await pool.run("pid", {}))["pid"]
        await until(lambda: not is_there(pid))
        assert (await pool.run("pid", {}))["pid"] != pid

    in_pool(story, idle_s=0.05)


def test_no_more_than_so_many_at_once_and_the_others_in_order():
    async def story(pool):
        most, done = 0, []

        async def one(k):
            nonlocal most
            await pool.run("echo", {"k": k}, on_progress=None)
            done.append(k)

        tasks = [asyncio.create_task(one(k)) for k in range(20)]
        while not all(task.done() for task in tasks):
            most = max(most, pool.busy)
            await asyncio.sleep(0)
        assert most == 1
        assert (pool.busy, pool.waiting) == (0, 0)
        return done

    assert in_pool(story) == list(range(20))


def test_arguments_are_read_when_the_turn_has_come():
    async def story(pool):
        read = []

        def reading():
            read.append(threading.current_thread() is threading.main_thread())
            return {"a": 1}

        work, _, _ = await sleeping(pool)
        asked = asyncio.create_task(pool.run("echo", reading))
        await until(lambda: pool.waiting == 1)
        assert read == []
        work.cancel()
        assert await asked == {"a": 1}
        assert read == [False]

    in_pool(story)


def test_arguments_that_cannot_be_read_keep_no_place():
    async def story(pool):
        def broken():
            raise NotFoundError("no plan 9")

        with pytest.raises(NotFoundError, match="no plan 9"):
            await pool.run("echo", broken)
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story)


def test_only_so_much_short_work_waits(monkeypatch):
    from muster_control.work import pool as module
    from muster_control.work.tasks import Task

    monkeypatch.setattr(module, "MOST_WAITING", 3)
    monkeypatch.setattr(module, "MOST_WAITING_OF_ONE", 2)
    monkeypatch.setattr(module, "TASKS", {"counts": Task("", None, long=True)})

    async def story(pool):
        work, _, _ = await sleeping(pool)
        waiting = [asyncio.create_task(pool.run("echo", {"k": k})) for k in range(2)]
        await until(lambda: pool.waiting == 2)
        with pytest.raises(BusyError, match=r"^2 requests of one user wait, the most that may; expected [^\n]*$"):
            await pool.run("echo", {})
        assert await pool.run("counts", {"times": 0}) == {}  # long work waits elsewhere
        work.cancel()
        assert await asyncio.gather(*waiting) == [{"k": 0}, {"k": 1}]
        assert await pool.run("echo", {"k": 2}) == {"k": 2}

    in_pool(story)


def test_long_work_does_not_keep_short_work_waiting(monkeypatch):
    from muster_control.work import pool as module
    from muster_control.work.tasks import Task

    monkeypatch.setattr(module, "TASKS", {"sleeps": Task("", None, long=True)})

    async def story(pool):
        work, _, _ = await sleeping(pool)
        assert await pool.run("echo", {"a": 1}) == {"a": 1}
        work.cancel()

    in_pool(story)


def test_cancelled_work_is_killed_within_a_second():
    async def story(pool):
        work, pids, folder = await sleeping(pool)
        assert folder.is_dir()
        work.cancel()
        await asyncio.wait({work}, timeout=1.0)
        assert work.cancelled()
        await until(lambda: not any(map(is_there, pids)))  # when processes that give way to others get to their end
        assert (await pool.run("pid", {}))["pid"] not in pids
        await until(lambda: not folder.exists())

    in_pool(story)


@pytest.mark.long
def test_work_that_takes_too_long_is_stopped():
    async def story(pool):
        await pool.run("echo", {})  # a process that has begun, so that it is the work that takes so long
        work, pids, _ = await sleeping(pool, limit_s=4.0)
        with pytest.raises(TimedOut, match=r"^it took longer than 4 s, and was stopped$"):
            await work
        await until(lambda: not any(map(is_there, pids)))

    in_pool(story)


@pytest.mark.long
@pytest.mark.parametrize("task", ["hoards", "hoards_small_things"])
def test_work_that_needs_too_much_memory_is_refused(task):
    async def story(pool):
        with pytest.raises(OutOfMemory, match=r"^it needs more than 200 MB of memory; expected [^\n]*$"):
            await pool.run(task, {})
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story, memory_mb=200)


def test_a_process_that_has_held_much_is_not_used_again():
    large = b"x" * 250_000_000  # what this process holds is not the workers' fault

    async def story(pool):
        first = await pool.run("grows", {"bytes": 10})
        second = await pool.run("grows", {"bytes": 250_000_000})
        third = await pool.run("grows", {"bytes": 10})
        assert first["pid"] == second["pid"] != third["pid"]
        assert len(large) == 250_000_000

    in_pool(story, memory_mb=400)


@pytest.mark.parametrize(("task", "how"), [("dies", "SIGKILL"), ("crashes", "SIGSEGV")])
def test_a_worker_that_dies_is_one_line_and_the_next_lives(task, how):
    async def story(pool):
        with pytest.raises(WorkerDied, match=f"^the process that worked on it ended with {how}$"):
            await pool.run(task, {})
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story)


def test_an_idle_worker_that_was_killed_is_replaced():
    async def story(pool):
        pid = (await pool.run("pid", {}))["pid"]
        os.kill(pid, signal.SIGKILL)
        await until(lambda: not pool._idle[0].alive)  # the loop has heard of it
        assert (await pool.run("pid", {}))["pid"] != pid

    in_pool(story)


@pytest.mark.parametrize(
    ("task", "line"), [("fails", "internal error: KeyError: 'absent'"), ("recurses", "nested too deep; expected .*")]
)
def test_a_fault_in_a_task_is_one_line(task, line):
    async def story(pool):
        with pytest.raises(WorkError, match=f"^{line}$"):
            await pool.run(task, {})
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story)


@pytest.mark.parametrize("times", [1, 2])
def test_work_is_told_to_stop_before_and_while_it_is_done(times):
    async def story(pool):
        stop_request = StopRequest()
        stop_request.ask()  # before there is a process
        work = pool.run(
            "goes_on",
            {"times": times},
            on_progress=lambda _: times > 1 and stop_request.ask(),
            stop_request=stop_request,
        )
        assert await asyncio.wait_for(work, 20) == {"hurried": times > 1}

    in_pool(story)


def test_a_late_stop_never_hits_the_next_piece_of_work():
    async def story(pool):
        for _ in range(50):
            stop_request = StopRequest()
            work = asyncio.create_task(pool.run("counts", {"times": 1, "size": 1}, stop_request=stop_request))
            while not work.done():
                stop_request.ask()
                await asyncio.sleep(0.001)
            stop_request.ask()
            assert await pool.run("stopped", {}) == {"stopped": False}

    in_pool(story)


def test_a_listener_that_raises_stops_the_work():
    async def story(pool):
        def listener(progress):
            raise RuntimeError("deaf")

        with pytest.raises(RuntimeError, match="deaf"):
            await pool.run("counts", {"times": 5, "size": 1}, on_progress=listener)
        assert await pool.run("echo", {"a": 1}) == {"a": 1}

    in_pool(story)


def test_nothing_is_left_of_a_pool_that_was_closed(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    async def story(pool):
        idle = (await pool.run("pid", {}))["pid"]
        work, pids, _ = await sleeping(pool)
        await pool.close()
        with pytest.raises(WorkerDied):
            await work
        with pytest.raises(WorkError, match=r"^the server is closing;"):
            await pool.run("echo", {})
        assert not any(map(is_there, [idle, *pids]))

    in_pool(story, workers=2)
    assert list(tmp_path.iterdir()) == []


def test_folders_of_servers_that_were_killed_are_removed(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    (tmp_path / f"muster-work-{gone.pid}-x" / "deep").mkdir(parents=True)
    (tmp_path / f"muster-work-{os.getpid()}-mine").mkdir()
    (tmp_path / "other").mkdir()
    in_pool(lambda pool: pool.run("echo", {}))
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"muster-work-{os.getpid()}-mine", "other"]


SERVER = """
import asyncio, sys
from muster_control.work import Pool
async def main():
    pool = Pool(workers=2, memory_mb=500, program=sys.argv[1:])
    await pool.run("echo", {})
    await pool.run("sleeps", {}, on_progress=lambda said: print(*said["pids"][:1], flush=True))
asyncio.run(main())
"""


def test_workers_end_with_the_server_that_was_killed():
    with subprocess.Popen([sys.executable, "-c", SERVER, *PROGRAM], stdout=subprocess.PIPE) as server:
        pid = int(server.stdout.readline())
        assert is_there(pid)
        server.kill()
    asyncio.run(until(lambda: not is_there(pid)))


def test_the_server_loads_nothing_heavy():
    code = """
import sys
import muster_control.work, muster_control.contract, muster_control.settings
heavy = ("numpy", "scipy", "shapely", "matplotlib", "muster.allocation", "muster.simulation", "muster.verification")
print([name for name in sys.modules if name.startswith(heavy)])
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout == "[]\n"
