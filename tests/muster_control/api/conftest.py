"""What the tests of the API share: a server with a real services, and a mission on it."""

import httpx
import pytest
from tests.cli.yard import MISSION
from tests.muster_control.serving import plan_of, served

from muster_control.security.tokens import line_of, new_token


@pytest.fixture(scope="module")
def url(tmp_path_factory):
    """Of a server on loopback, where everybody may command."""
    with served(tmp_path_factory.mktemp("server")) as url:
        yield url


@pytest.fixture(scope="module")
def http(url):
    """Asks it."""
    with httpx.Client(base_url=f"{url}/api/v1", timeout=60) as http:
        yield http


@pytest.fixture(scope="module")
def yard(http):
    """The id of a mission there."""
    return http.post("/missions", json={"text": MISSION}).json()["id"]


@pytest.fixture(scope="module")
def plan(http, yard):
    """The id of a plan there."""
    return plan_of(http, yard)


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    """A server with tokens: its URL, and a token of each role."""
    folder = tmp_path_factory.mktemp("guarded")
    tokens = {role: new_token() for role in ("watch", "command")}
    lines = [line_of(f"a-{role}", role, token) for role, token in tokens.items()]
    (folder / "tokens").write_text("\n".join(lines) + "\n", encoding="utf-8")
    with served(folder, tokens=folder / "tokens") as url:
        yield url, tokens
