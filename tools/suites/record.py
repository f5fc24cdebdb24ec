"""Pytest plugin (`-p tools.suites.record`) that records the sources and CPU seconds of each test function.

Coverage traces the process of the tests: a source counts where a line within one of its functions was executed, since
module-level lines run at the first import, whichever test comes first. What a fixture of a wider scope than one test
executes counts for every test that uses the fixture. Of child processes that are Python, the imported modules count.
"""

import ast
import json
import os
import sysconfig
from collections import defaultdict
from functools import cache
from pathlib import Path

import coverage
import pytest
from tests.suites import function_id

from tools.suites.change import ROOT

RECORDS = ROOT / "build" / "executed"
PACKAGES = sorted(str(path.parent) for path in ROOT.glob("src/*/__init__.py"))
_HOOK = Path(sysconfig.get_path("purelib")) / "muster_executed.pth"
_CHILD = (
    "import os; os.environ.get('MUSTER_EXECUTED') and __import__('runpy').run_path(os.environ['MUSTER_EXECUTED'])\n"
)


def pytest_configure(config):
    """Prepare the folder of records in the process that starts the others, and trace where tests run."""
    if not hasattr(config, "workerinput"):
        RECORDS.mkdir(parents=True, exist_ok=True)
        for old in RECORDS.glob("*.json"):
            old.unlink()
        _HOOK.write_text(_CHILD, encoding="utf-8")
        config.add_cleanup(lambda: _HOOK.unlink(missing_ok=True))
        if config.getoption("numprocesses", None):
            return
    os.environ["MUSTER_EXECUTED"] = str(Path(__file__).with_name("record_child.py"))
    config.pluginmanager.register(Recorder())


class Recorder:
    """Trace of one process that runs tests."""

    def __init__(self):
        self._coverage = coverage.Coverage(data_file=None, source=PACKAGES, config_file=False, messages=False)
        self._coverage.set_option("run:disable_warnings", ["no-data-collected"])  # tests may execute no source
        self._seconds = defaultdict(float)
        self._fixtures = defaultdict(set)
        self._test = ""

    def pytest_sessionstart(self):
        self._coverage.start()

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(self, item):
        """Trace one test in a context of its own, and add up the CPU seconds of the process and its ended children."""
        self._test = name = function_id(item.nodeid)
        self._coverage.switch_context(name)
        before = sum(os.times()[:4])
        try:
            return (yield)
        finally:
            self._seconds[name] += sum(os.times()[:4]) - before
            self._coverage.switch_context("")

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        """Trace a fixture that several tests share in a context of its own."""
        if fixturedef.scope == "function":
            return (yield)
        self._coverage.switch_context(_fixture_context(fixturedef))
        try:
            return (yield)
        finally:
            self._coverage.switch_context(self._test)

    def pytest_runtest_teardown(self, item):
        """Note the shared fixtures of a test."""
        known = item._fixtureinfo.name2fixturedefs
        shared = (one for defs in known.values() for one in defs if one.scope != "function")
        self._fixtures[function_id(item.nodeid)].update(map(_fixture_context, shared))

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self):
        """Write what was executed: for each test function its CPU seconds and its sources."""
        self._coverage.stop()
        of_context = _sources_by_context(self._coverage.get_data())
        found = {
            name: {
                "cpu_s": seconds,
                "sources": sorted(of_context[name].union(*(of_context[one] for one in self._fixtures[name]))),
            }
            for name, seconds in self._seconds.items()
        }
        (RECORDS / f"{os.getpid()}.json").write_text(json.dumps(found), encoding="utf-8")


def _fixture_context(fixturedef):
    return f"fixture {fixturedef.baseid} {fixturedef.argname}"


def _sources_by_context(data):
    """Return for each context the sources of which it executed a line within a function, relative to the repository."""
    sources = defaultdict(set)
    for file in data.measured_files():
        inside = lines_in_functions(Path(file))
        for line, contexts in data.contexts_by_lineno(file).items():
            if line in inside:
                for context in contexts:
                    sources[context].add(Path(file).relative_to(ROOT).as_posix())
    return sources


@cache
def lines_in_functions(path):
    """Return the numbers of all lines of a Python file that lie within the body of a function."""
    functions = (ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, functions)]
    return {line for node in nodes for line in range(node.body[0].lineno, node.end_lineno + 1)}
