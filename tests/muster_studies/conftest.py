"""One short run of the study for all tests that look at what it prints."""

from pathlib import Path

import pytest

import muster
from muster_studies.effort import Effort
from muster_studies.registry import study_named
from muster_studies.repetition import Repetition


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """What the tests of a study share takes minutes: one process has them all, of both files of thesis-3.3 too."""
    for item in items:
        if item.path.parent == Path(__file__).parent and item.path.stem != "test_optional_parts":  # has its own ones
            group = item.path.stem.removesuffix("_greedy").removesuffix("_tables")
            item.add_marker(pytest.mark.xdist_group(group))


@pytest.fixture(scope="session")
def report():
    return study_named("thesis-3.3").run(Effort(seeds=2, iterations=100))


@pytest.fixture(scope="session")
def tables(report):
    return {table.number: table for table in report.tables}


@pytest.fixture
def asked_of_studies(monkeypatch):
    """The names and efforts of studies that are asked for; none is run: each refuses."""
    asked = []

    def run(self, effort, workers=1, on_done=None):
        asked.append((self.name, effort))
        raise muster.ParameterError("enough")

    monkeypatch.setattr(Repetition, "run", run)
    return asked
