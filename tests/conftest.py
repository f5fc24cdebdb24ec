"""Hooks and fixtures of every test: suites, profiles of Hypothesis, names of parameters, skipped tests as failures."""

import gc
import logging
import os
import signal
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.cli.yard import MISSION, ROBOTS, TABLE, TASKS
from tests.suites import SUITES, chosen, function_id, shuffle

# The same examples at every run: a failure in CI is a failure everywhere. HYPOTHESIS_PROFILE=search looks for new ones.
settings.register_profile(
    "fixed", max_examples=25, derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("few", settings.get_profile("fixed"), max_examples=10)
settings.register_profile("search", deadline=None, max_examples=2000, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "fixed"))


def pytest_configure():
    """Hear Ctrl-C: a shell that runs this in the background ignores it, and programs that tests start inherit that."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect no garbage while tests are collected, and leave the tests out of every later collection of garbage.

    Later collections are rarer than Python's default: they cost a test run a few hundredths of its time.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(10_000, 20, 20)
        gc.enable()


def pytest_make_parametrize_id(val, argname):
    """A long text is named by its length: names go between all processes of xdist, and some had millions of letters."""
    if isinstance(val, str | bytes) and len(val) > 300:
        return f"{argname} of {len(val)}"
    return None


@pytest.hookimpl(tryfirst=True)  # before xdist, which reads the groups
def pytest_collection_modifyitems(config, items):
    """Deselect what the suite leaves out; pytest says how many tests that are."""
    given = {name: config.getoption(name) for name in ("suite", "turn", "only", "also")}
    left_out = chosen(items, **given)
    if left_out:
        config.hook.pytest_deselected(items=left_out)
    if config.getoption("functions"):
        names = sorted({function_id(item.nodeid) for item in items})
        Path(config.getoption("functions")).write_text("\n".join(names) + "\n", encoding="utf-8")
    if config.getoption("shuffle") is not None:
        shuffle(items, config.getoption("shuffle"))
    for item in items:  # what the tests of a file share is made by one process
        if not item.get_closest_marker("xdist_group"):
            item.add_marker(pytest.mark.xdist_group(item.nodeid.partition("::")[0]))


LOGGERS = [logging.getLogger(name) for name in (None, "muster", "muster_robots")]


@pytest.fixture(autouse=True)
def logs():
    """What `-q` of a verb, a node of ROS 1 or a library does to the logs of this process ends with the test."""
    keep_handlers({handler for logger in LOGGERS for handler in logger.handlers})
    before = [(logger, logger.level, set(logger.handlers)) for logger in LOGGERS]
    yield
    keep_handlers(set().union(*(handlers for _, _, handlers in before)))
    for logger, level, _ in before:
        logger.setLevel(level)


def keep_handlers(kept):
    """Leave these handlers and pytest's own; a stream that an earlier test has closed is written to no more."""
    for logger in LOGGERS:
        for handler in list(logger.handlers):
            if type(handler) is logging.StreamHandler and (handler not in kept or handler.stream.closed):
                logger.removeHandler(handler)


def pytest_addoption(parser):
    parser.addoption("--suite", choices=SUITES, default="all", help="which tests run (docs/tests.md); all by default")
    parser.addoption("--turn", type=int, default=0, help="the turn whose tenth of the long tests runs: --suite share")
    parser.addoption("--only", metavar="FILE", help="run the test functions alone that this file lists, an id a line")
    parser.addoption("--also", metavar="FILE", help="with --suite share: run the listed long tests besides the tenth")
    parser.addoption("--functions", metavar="FILE", help="write the ids of the chosen test functions to a file")
    parser.addoption("--shuffle", type=int, metavar="SEED", help="run the tests in a random order")
    parser.addoption("--no-skips", action="store_true", help="a skipped test is a failure, unless it needs hardware")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if not item.get_closest_marker("hardware") and not hasattr(report, "wasxfail"):
        _refuse_skip(report, item.config)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """Refuse modules, too, that are skipped as a whole while they are collected."""
    report = yield
    _refuse_skip(report, collector.config)
    return report


def _refuse_skip(report, config):
    if report.skipped and config.getoption("--no-skips"):
        report.outcome = "failed"
        report.longrepr = f"skipped, where nothing may be skipped: {report.longrepr}"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The test runs in a folder of its own with a mission in it."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("yard.yaml", MISSION), ("t.csv", TASKS), ("r.csv", ROBOTS), ("s.csv", TABLE)):
        Path(name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def muster(capsys):
    """Runs the command; gives its exit code, standard output and standard error."""

    def call(*arguments):
        from muster.cli.main import run

        code = run([str(argument) for argument in arguments])
        return (code, *capsys.readouterr())

    return call


@pytest.fixture
def plan(folder, muster):
    """A plan of the yard: `lift` is left out."""
    assert muster("solve", "yard.yaml", "--iterations", 20, "-o", "plan.json")[0] == 0
    return Path("plan.json")
