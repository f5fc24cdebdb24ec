"""Modules that have moved to other packages can still be imported by their old names."""

import importlib
import sys

import pytest

import muster

MOVED = " has moved: import "


@pytest.mark.parametrize("old", muster._MOVED)
def test_an_old_name_gives_the_module_of_the_new_one(old):
    with pytest.warns(DeprecationWarning, match=f"^{old} has moved: import {muster._MOVED[old]}$"):
        found = importlib.import_module(old)
    assert found is sys.modules[muster._MOVED[old]]
    assert found.__name__ == found.__spec__.name == muster._MOVED[old]
    del sys.modules[old]


def test_what_is_in_a_package_that_has_moved_is_there_once():
    with pytest.warns(DeprecationWarning, match=MOVED):
        from muster.client.connection import Connection
    from muster_control.client import connection

    assert Connection is connection.Connection
    for name in [name for name in sys.modules if name.startswith("muster.client")]:
        del sys.modules[name]


def test_a_module_that_there_never_was_is_missed():
    with (
        pytest.warns(DeprecationWarning, match=MOVED),
        pytest.raises(ModuleNotFoundError, match=r"muster_control\.client\.nothing"),
    ):
        importlib.import_module("muster.client.nothing")
