"""Tests that go on where the one before them ended (`xdist_group`) are run by one process, in their order."""

import os

import pytest

pytestmark = pytest.mark.xdist_group("together")
_RUN = []


@pytest.fixture
def needs_groups(request):
    if "PYTEST_XDIST_WORKER" in os.environ and request.config.workerinput["mainargv"].count("loadgroup") == 0:
        pytest.skip("run without --dist loadgroup")


@pytest.mark.parametrize("number", range(6))
def test_each_finds_those_before_it(number, needs_groups):
    assert list(range(number)) == _RUN
    _RUN.append(number)
