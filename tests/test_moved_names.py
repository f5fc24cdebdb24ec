"""Modules that have moved to other packages can still be imported by their old names."""

import importlib
import sys
import warnings

import pytest

import muster

MOVED = " has moved: import "


@pytest.fixture(autouse=True)
def forgotten():
    """Old names that a test imports are unknown to the next one, which sees their warnings, too."""
    yield
    for name in [
        name for name, module in sys.modules.items() if name.startswith("muster.") and module.__name__ != name
    ]:
        del sys.modules[name]


@pytest.mark.parametrize("old", muster._MOVED)
def test_an_old_name_gives_the_module_of_the_new_one(old):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the package's own
        importlib.import_module(old.rpartition(".")[0])
    with pytest.warns(DeprecationWarning, match=f"^{old} has moved: import {muster._MOVED[old]}$"):
        found = importlib.import_module(old)
    assert found is sys.modules[muster._MOVED[old]]
    assert found.__name__ == found.__spec__.name == muster._MOVED[old]


def test_what_is_in_a_package_that_has_moved_is_there_once():
    with pytest.warns(DeprecationWarning, match=MOVED):
        from muster.client.connection import Connection
    from muster_control.client import connection

    assert Connection is connection.Connection


def test_a_module_that_there_never_was_is_missed():
    with (
        pytest.warns(DeprecationWarning, match=MOVED),
        pytest.raises(ModuleNotFoundError, match=r"muster_control\.client\.nothing"),
    ):
        importlib.import_module("muster.client.nothing")
