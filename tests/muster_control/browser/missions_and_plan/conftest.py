"""One server and one page for all of these tests; each that edits has a mission of its own."""

import pytest
from tests.muster_control.browser.conftest import Watched, running_chromium, serving

from muster_control.client import Client

YARD = """\
schema: muster/1
name: small
rules: {objective: total+max}
robots:
  - {id: r_0, position: [0, 0], speed_mps: 1}
  - {id: r_1, position: [3, 0], speed_mps: 1}
tasks:
  - {id: 1, position: [5, 8]}
"""


@pytest.fixture(scope="package")
def served(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("served")) as origin:
        yield origin


@pytest.fixture(scope="package")
def chromium():
    with running_chromium() as browser:
        yield browser


@pytest.fixture(scope="package")
def watched(chromium, served):
    watched = Watched(chromium, served)
    yield watched
    watched.page.close()


@pytest.fixture
def page(watched):
    yield watched.page
    watched.require_clean()


@pytest.fixture
def yard(served, request):
    """The id of a mission of two robots and a task, in its first version."""
    with Client(served) as client:
        return client.missions.create(YARD, name=request.node.name).id
