"""Nobody presses the buttons of another's page, nor of their own in a role that they have no more."""

import json
import re
import time
from dataclasses import dataclass

import httpx
import pytest
from tests.muster_control.security.shielded import COMMANDER, TOKENS, WATCHER, bearer
from tests.muster_control.serving import served
from websockets.sync.client import connect

from muster_control.security.tokens import line_of, new_token

_PATIENCE_S = 60
_YARD = {"act": "duplicate", "mission": "yard", "name": "yard"}
_CHIEF = new_token()  # who is in command until the file of tokens says otherwise


@dataclass(frozen=True)
class Site:
    url: str
    tokens: object


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("served")
    tokens = folder / "tokens"
    tokens.write_text(TOKENS + line_of("chief", "command", _CHIEF) + "\n")
    tokens.chmod(0o600)
    with served(folder, tokens=tokens) as url:
        yield Site(url, tokens)


class Page:
    """The list of missions, as one opens it."""

    def __init__(self, site, token, path="/"):
        html = httpx.get(site.url + path, headers=bearer(token), timeout=_PATIENCE_S).text
        self._site = site
        self.client = re.search(r"'client_id': '([^']+)'", html)[1]
        found = re.search(r'"listener_id":"([^"]+)","type":"click"[^}]*closest\(\\"button\[data-act', html)
        self.listener = found and found[1]
        self.list = found and re.findall(r'"(\d+)":\{"', html[: found.start()])[-1]

    def pressed(self, token):
        """Press "Duplicate" over a socket of whoever has the token; how many copies there are afterwards."""
        address = self._site.url.replace("http", "ws", 1) + "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
        said = {"client_id": self.client, "tab_id": "1", "document_id": "1", "next_message_id": 0}
        click = {
            "id": int(self.list),
            "client_id": self.client,
            "listener_id": self.listener,
            "args": [json.dumps(_YARD)],
        }
        with connect(address, additional_headers=bearer(token)) as socket:
            assert socket.recv().startswith("0")
            socket.send("40")
            assert socket.recv().startswith("40")
            socket.send("421" + json.dumps(["handshake", said]))
            while not (answer := socket.recv()).startswith("431"):
                pass
            socket.send("422" + json.dumps(["event", click]))
            while not socket.recv().startswith("432"):
                pass
        return json.loads(answer.removeprefix("431"))[0]

    def copies(self):
        listed = httpx.get(f"{self._site.url}/api/v1/missions", headers=bearer(COMMANDER), timeout=_PATIENCE_S)
        return sum(entry["name"].startswith("yard copy") for entry in listed.json())


def _role_of(site, token):
    return httpx.get(f"{site.url}/api/v1/me", headers=bearer(token), timeout=_PATIENCE_S).json()["role"]


def _wait_for(condition):
    until = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.05)


@pytest.mark.long
def test_who_opened_a_page_presses_its_buttons(site):
    page = Page(site, COMMANDER)
    before = page.copies()
    assert page.pressed(COMMANDER) is True
    _wait_for(lambda: page.copies() == before + 1)


def test_nobody_else_does(site):
    page = Page(site, COMMANDER)
    before = page.copies()
    assert page.pressed(WATCHER) is False
    assert page.pressed(COMMANDER) is True  # which would come second
    _wait_for(lambda: page.copies() > before)
    assert page.copies() == before + 1


@pytest.mark.long
def test_a_role_that_was_taken_away_is_gone_from_open_pages(site):
    page = Page(site, _CHIEF)
    before = page.copies()
    site.tokens.write_text(TOKENS + line_of("chief", "watch", _CHIEF) + "\n")
    _wait_for(lambda: _role_of(site, _CHIEF) == "watch")
    assert page.pressed(_CHIEF) is False
    other = Page(site, COMMANDER)
    assert other.pressed(COMMANDER) is True
    _wait_for(lambda: page.copies() > before)
    assert page.copies() == before + 1


def test_who_only_watches_has_no_button_and_may_not_send_files_to_another_s_page(site):
    assert Page(site, WATCHER).list is None
    page = Page(site, COMMANDER)
    for token, status in ((WATCHER, 404), (COMMANDER, 404)):  # of the latter's page, that it takes no file
        where = f"{site.url}/_nicegui/client/{page.client}/upload/9"
        answer = httpx.post(where, headers=bearer(token), files={"file": b"1"}, timeout=_PATIENCE_S)
        assert answer.status_code == status
        assert ("of yours" in answer.text) == (token == WATCHER)
