"""Suites of tests: which tests `make test`, `make test-all`, `make quick` and `.ci/run` choose.

A test that takes long is marked `long`. `@pytest.mark.long` leaves all of its cases out of the fast suite;
`@pytest.mark.long(keep=2)` keeps two of its parametrised cases there, always the same ones. Each long test belongs to one of ten
shares, by a checksum of its id, so that ten turns in a row of `.ci/run` execute every test that exists.
"""

from collections import defaultdict
from pathlib import Path
from zlib import crc32

SUITES = ("all", "fast", "long", "share")
SHARES = 10


def function_id(nodeid):
    """Return the id of a test function, without the parameters of the case and the group that pytest-xdist appends."""
    path, _, name = nodeid.partition("::")
    return f"{path}::{name.partition('[')[0].partition('@')[0]}"


def share_of(nodeid):
    """Return the share, 0 to 9, to which a long test belongs."""
    return crc32(function_id(nodeid).encode()) % SHARES


def long_items(items):
    """Return the subset of `items` that the fast suite leaves out."""
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("long"):
            cases[function_id(item.nodeid)].append(item)
    return {item for of_one in cases.values() for item in _beyond_kept(of_one)}


def chosen(items, suite, turn=0, only=None):
    """Reduce `items` in place to those of a suite, and return the items that were removed.

    `turn` selects a tenth of the long tests where `suite` is "share". `only` is the path of a file with ids of test functions,
    one a line, to which the choice is restricted.
    """
    long = long_items(items) if suite != "all" else set()
    listed = set(Path(only).read_text(encoding="utf-8").splitlines()) if only else None

    def belongs(item):
        if listed is not None and function_id(item.nodeid) not in listed:
            return False
        if suite == "share":
            return item in long and share_of(item.nodeid) == turn % SHARES
        return suite == "all" or (item in long) == (suite == "long")

    kept, removed = [], []
    for item in items:
        (kept if belongs(item) else removed).append(item)
    items[:] = kept
    return removed


def _beyond_kept(cases):
    """Return the cases of one function that are long; the kept ones are the first by a checksum of their ids."""
    keep = cases[0].get_closest_marker("long").kwargs.get("keep", 0)
    marked = sorted(cases, key=lambda item: crc32(item.nodeid.encode()))
    return marked[keep:]
