import pytest

from muster_control.store.store import Store


@pytest.fixture
def store(tmp_path):
    opened = Store.open(f"sqlite:///{tmp_path / 'muster.db'}")
    yield opened
    opened.close()
