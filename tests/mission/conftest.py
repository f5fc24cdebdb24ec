"""What the tests of the formats share."""

import pytest


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One folder for all examples of a property; each writes its files anew."""
    return tmp_path_factory.mktemp("formats")
