"""Tests that go on where the one before them ended are run by one process: of an `xdist_group`, or of a file."""

import os

import pytest

_RUN, _RUN_OF_FILE = [], set()


@pytest.fixture
def needs_groups(request):
    if "PYTEST_XDIST_WORKER" in os.environ and request.config.workerinput["mainargv"].count("loadgroup") == 0:
        pytest.skip("run without --dist loadgroup")


@pytest.mark.xdist_group("together")
@pytest.mark.parametrize("number", range(6))
def test_each_finds_those_before_it(number, needs_groups):
    assert list(range(number)) == _RUN
    _RUN.append(number)


@pytest.mark.parametrize("number", range(6))
def test_so_do_those_of_a_file_without_a_group(number, needs_groups):
    _RUN_OF_FILE.add(number)
    assert number < 5 or len(_RUN_OF_FILE) == 6
