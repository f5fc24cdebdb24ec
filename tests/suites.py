"""Suites of tests: which tests `make test`, `make test-all`, `make quick` and `.ci/run` choose.

A test that takes long is marked `long`. `@pytest.mark.long` leaves all of its cases out of the fast suite;
`@pytest.mark.long(keep=2)` keeps two of its parametrised cases there, always the same ones. Each long test belongs to
one of ten shares, by a checksum of its id, so that ten turns in a row of `.ci/run` execute every test that exists.
"""

from collections import defaultdict
from pathlib import Path
from random import Random
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


def chosen(items, suite, turn=0, only=None, also=None):
    """Reduce `items` in place to those of a suite, and return the items that were removed.

    `turn` selects a tenth of the long tests where `suite` is "share". `only` and `also` are paths of files that list
    test functions by their ids, and whole test files, one a line: the choice is restricted to `only`; a share has the
    long tests of `also` besides.
    """
    long = long_items(items) if suite != "all" else set()
    only, also = _listed(only), _listed(also)
    stories = {_story(item) for item in items if only is not None and _names(only, item)} - {None}

    def belongs(item):
        if only is not None and not _names(only, item) and _story(item) not in stories:
            return False
        if suite == "share":
            return item in long and (
                share_of(item.nodeid) == turn % SHARES or (also is not None and _names(also, item))
            )
        return suite == "all" or (item in long) == (suite == "long")

    kept, removed = [], []
    for item in items:
        (kept if belongs(item) else removed).append(item)
    items[:] = kept
    return removed


def shuffle(items, seed):
    """Put test files, and the tests of each file, in a random order; the stories of one group keep theirs."""
    order = Random(seed)  # equal in all processes
    files = defaultdict(list)
    for item in items:
        files[item.path].append(item)
    shuffled = list(files.values())
    order.shuffle(shuffled)
    for of_file in shuffled:
        if not any(item.get_closest_marker("xdist_group") for item in of_file):
            order.shuffle(of_file)
    items[:] = [item for of_file in shuffled for item in of_file]


def _listed(path):
    return set(Path(path).read_text(encoding="utf-8").splitlines()) if path else None


def _names(listed, item):
    """Return whether a list names a test, by its function or its file."""
    name = function_id(item.nodeid)
    return name in listed or name.partition("::")[0] in listed


def _story(item):
    """Return the file and group of a test that belongs to a group, the tests of which may need those before them."""
    group = item.get_closest_marker("xdist_group")
    return (item.path, group.args) if group else None


def _beyond_kept(cases):
    """Return the cases of one function that are long; the kept ones are the first by a checksum of their names."""
    keep = cases[0].get_closest_marker("long").kwargs.get("keep", 0)
    marked = sorted(cases, key=lambda item: crc32(item.name.partition("@")[0].encode()))
    return marked[keep:]
