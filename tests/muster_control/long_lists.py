"""`python -m tests.muster_control.long_lists [ROWS]`: how long a server with long lists takes for its pages and lists.

While each is asked for, `/healthz` is asked for all the time: what it waits for the event loop is what a command to a
robot would wait. `fill` makes a database with so many rows of each kind, for tests, too.
"""

import argparse
import sys
import tempfile
import threading
import time
from datetime import UTC, datetime
from pathlib import Path

import httpx
from sqlalchemy import insert
from tests.muster_control.runs.process import serving

from muster_control.store import schema
from muster_control.store.missions import words_of
from muster_control.store.store import Store

PAGES = ("/", "/?search=yard", "/records", "/records/1", "/live", "/plan", "/plan/yard-1")
LISTS = ("/missions", "/missions/yard-1/versions", "/plans", "/jobs", "/runs", "/records", "/runs/1/events", "/actions")
TIMES = 5
TEXT = "schema: muster/1\nname: yard\nrobots: [{id: r_0, position: [0, 0]}]\ntasks: [{id: gate, position: [4, 3]}]\n"
HEAD = {"schema": "muster-plan/1", "mission": "yard", "allocator": "greedy", "tasks_total": 1, "tasks_completed": 1}


def fill(store, rows):
    """So many missions, and versions, plans, jobs and runs of the first, entries and actions of its first run."""
    at = datetime.now(UTC)
    by = {"author": "ann", "at": at}
    numbers = range(1, rows + 1)
    names = [f"yard-{k}" for k in numbers]
    summary = {"robots": 1, "tasks": 1, "dimensions": 2}
    of = {"mission": names[0], "mission_version": 1}
    version = {"text": TEXT, "note": "", **by}
    kept = {"missions": [_mission(name, at, rows if name == names[0] else 1) for name in names]}
    kept["mission_versions"] = [
        *({"mission": name, "version": 1, "summary": {"name": name, **summary}, **version} for name in names),
        *(
            {"mission": names[0], "version": k, "summary": {"name": names[0], **summary}, **version}
            for k in numbers[1:]
        ),
    ]
    body = {"routes": [{"robot": "r_0", "tasks": ["gate"]}]}
    kept["plans"] = [{"version": k, "origin": "planned", "head": HEAD, "body": body, **of, **by} for k in numbers]
    job = {"kind": "plan", "state": "done", "arguments": {}, "author": "ann", "asked_at": at, "error": "", **of}
    kept["jobs"] = [{"result": {"plan": k}, **job} for k in numbers]
    run = {"plan": 1, "world": "kinematic", "settings": {}, "speed": 1.0, "state": "ended", "time_s": 1.0, **of, **by}
    kept["runs"] = [{"ended_at": at, "resumed": 0, "remark": "", **run} for _ in numbers]
    told = {"kind": "starts", "data": {"robot": "r_0", "task": "gate"}, "at": at}
    kept["entries"] = [{"run": 1, "seq": k, "time_s": float(k), **told} for k in numbers]
    action = {"who": "ann", "role": "command", "address": "", "verb": "run.pause", "data": {}, "run": 1, "at": at}
    kept["actions"] = [{"id": k, "outcome": "done", **action} for k in numbers]
    with store.database.writing() as connection:
        for table, values in kept.items():
            connection.execute(insert(getattr(schema, table)), values)


def _mission(name, at, newest):
    words = words_of(name, name)
    return {"id": name, "newest": newest, "shipped": False, "hidden": False, "words": words, "changed_at": at}


def measured(url, path):
    """Seconds that each of some requests takes, and the longest that `/healthz` takes meanwhile."""
    waits, done = [], threading.Event()

    def ask_all_the_time():
        with httpx.Client(timeout=60) as http:
            while not done.is_set():
                waits.append(_seconds(http, f"{url}/healthz"))
                time.sleep(0.04)  # within the requests a second that one address has

    asking = threading.Thread(target=ask_all_the_time)
    asking.start()
    try:
        with httpx.Client(timeout=300) as http:
            took = []
            for _ in range(TIMES):
                took.append(_seconds(http, url + path))
                time.sleep(0.2)
    finally:
        done.set()
        asking.join()
    return took, max(waits)


def _seconds(http, address):
    begun = time.perf_counter()
    http.get(address).raise_for_status()
    return time.perf_counter() - begun


def main():
    parser = argparse.ArgumentParser(prog="tests.muster_control.long_lists", description=__doc__)
    parser.add_argument("rows", nargs="?", type=int, default=5000)
    rows = parser.parse_args().rows
    with tempfile.TemporaryDirectory() as folder:
        database = f"sqlite:///{Path(folder) / 'muster.db'}"
        store = Store.open(database)
        fill(store, rows)
        store.close()
        with serving(database) as server:
            sys.stdout.write(
                f"{rows} rows of each kind; seconds: the first answer, the median, /healthz meanwhile at most\n"
            )
            for path in (*PAGES, *(f"/api/v1{path}?limit=500" for path in LISTS)):
                (first, *rest), health = measured(server.url, path)
                middle = sorted(rest)[len(rest) // 2]
                sys.stdout.write(f"{path:45} {first:7.3f} {middle:7.3f} {health:7.3f}\n")
            server.end()


if __name__ == "__main__":
    main()
