"""Each test has a data folder of its own: no journal of an interrupted run is in it."""

import pytest


@pytest.fixture(autouse=True)
def data_folder_of_its_own(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path_factory.mktemp("data")))
