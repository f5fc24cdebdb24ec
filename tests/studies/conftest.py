"""One short run of the study for all tests that look at what it prints."""

import pytest

from muster_studies.effort import Effort
from muster_studies.registry import study_named


@pytest.fixture(scope="session")
def report():
    return study_named("thesis-3.3").run(Effort(seeds=2, iterations=300))


@pytest.fixture(scope="session")
def tables(report):
    return {table.number: table for table in report.tables}
