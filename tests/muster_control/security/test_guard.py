"""The guard: who is let in, from where, how often, with how much; and what every answer says."""

import asyncio
import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.websockets import WebSocketDisconnect
from tests.muster_control.security.shielded import (
    COMMANDER,
    FOREIGN,
    HOME,
    PROXY_SECRET,
    SHOWN,
    SOCKET,
    TOKENS,
    WATCHER,
    Shielded,
    WebSocketDenialResponse,
    asgi_answer,
    bearer,
    behind_proxy,
    settings_in,
)

from muster.mission.errors import ParameterError
from muster_control.security.guard import Guard
from muster_control.security.tokens import line_of


def test_alone_everybody_at_this_machine_may_command(tmp_path):
    with Shielded(settings_in(tmp_path)).client() as client:
        assert client.get("/who").json() == {"name": "local", "role": "command", "address": "127.0.0.1"}
        assert client.post("/who").status_code == 200


def test_alone_nobody_comes_through_a_proxy_unseen(tmp_path):
    with Shielded(settings_in(tmp_path)).client() as client:
        for name in ("X-Forwarded-For", "Forwarded", "X-Real-IP", "X-Forwarded-Host"):
            answer = client.get("/who", headers={name: "10.0.0.1"})
            assert answer.status_code == 403
            assert "came through a proxy" in answer.json()["error"]


def test_tokens_and_roles(tmp_path):
    with Shielded(settings_in(tmp_path, tokens=TOKENS)).client() as client:
        assert client.get("/who", headers=bearer(COMMANDER)).json()["role"] == "command"
        assert client.get("/who", headers=bearer(WATCHER)).json() == {
            "name": "wall",
            "role": "watch",
            "address": "127.0.0.1",
        }
        for headers in ({}, bearer("muster_x"), {"authorization": COMMANDER}, {"authorization": f"Basic {COMMANDER}"}):
            answer = client.get("/who", headers=headers)
            assert (answer.status_code, answer.headers["www-authenticate"]) == (401, "Bearer")
        assert client.get(f"/who?token={COMMANDER}").status_code == 401  # never in an address, which is logged


def test_what_is_open_to_all(tmp_path):
    with Shielded(settings_in(tmp_path, tokens=TOKENS)).client() as client:
        assert [client.get(path).status_code for path in ("/healthz", "/login")] == [200, 200]
        for path in (
            "/healthz/",
            "/login/",
            "//healthz",
            "/healthz/../who",
            "/healthz%2f..%2fwho",
            "/%68ealthz/x",
            "/LOGIN",
        ):
            assert client.get(path).status_code == 401


def test_a_browser_is_sent_to_the_login(tmp_path):
    with Shielded(settings_in(tmp_path, tokens=TOKENS)).client() as client:
        answer = client.get("/plan/31T-6R50", headers={"accept": "text/html,*/*"})
        assert (answer.status_code, answer.headers["location"]) == (303, "/login?next=/plan/31T-6R50")
        assert client.get("/api/v1/me", headers={"accept": "text/html"}).status_code == 401


@pytest.mark.parametrize("tokens", [None, TOKENS], ids=["without-tokens", "with-tokens"])
def test_other_names_and_origins(tmp_path, tokens):
    app = Shielded(settings_in(tmp_path, tokens=tokens))
    known = bearer(COMMANDER) if tokens else {}
    with app.client() as client:
        rebound = client.get("/who", headers={**known, "host": "evil.example"})
        assert rebound.status_code == 421
        for method in ("GET", "POST", "OPTIONS"):
            assert client.request(method, "/who", headers=known | FOREIGN).status_code == 403
        answer = client.options("/who", headers=known | FOREIGN | {"access-control-request-method": "POST"})
        assert not [name for name in answer.headers if name.startswith("access-control")]
        socket = client.get(
            "/_nicegui_ws/socket.io/?transport=polling", headers=known | {"sec-fetch-site": "same-site"}
        )
        assert socket.status_code == 403


def test_a_proxy_says_who_asks(tmp_path):
    tokens = f"{TOKENS}command bob@example.org -\n"
    settings = settings_in(tmp_path, tokens=tokens, **behind_proxy(tmp_path, "X-User", "10.1.0.0/16"))
    app = Shielded(settings)
    bob = {"x-user": "bob@example.org", "x-forwarded-for": "192.0.2.9, 10.1.0.7", **SHOWN}
    with app.client(peer="10.1.2.3") as client:
        assert client.get("/who", headers=bob).json() == {
            "name": "bob@example.org",
            "role": "command",
            "address": "192.0.2.9",
        }
        assert client.get("/who", headers={"x-user": "eve", **SHOWN}).status_code == 401
        assert client.get("/who", headers={"x-user": "wall", **SHOWN}).status_code == 401  # who has a token shows it
        assert client.get("/who", headers=[("x-user", "eve"), ("x-user", "bob@example.org")]).status_code == 400
    with app.client(peer="10.2.0.1") as client:
        assert client.get("/who", headers=bob).status_code == 401
        known = client.get("/who", headers=bob | bearer(WATCHER)).json()
        assert known == {"name": "wall", "role": "watch", "address": "10.2.0.1"}


def test_everybody_whom_the_proxy_lets_in(tmp_path):
    settings = settings_in(tmp_path, tokens="watch * -\n", **behind_proxy(tmp_path, "x-user", "127.0.0.1"))
    with Shielded(settings).client() as client:
        for name, shown in (("eve\u00e9", None), ("e" * 5000, 64)):
            known = client.get("/who", headers={"x-user": name.encode("latin-1"), **SHOWN}).json()
            assert known["role"] == "watch"
            assert shown is None or len(known["name"]) <= shown


@pytest.mark.parametrize(
    "shown", [{}, {"x-muster-proxy-secret": ""}, {"x-muster-proxy-secret": PROXY_SECRET[:-1]}, {"x-user-secret": "x"}]
)
def test_another_process_of_the_proxys_machine_names_nobody(tmp_path, shown):
    """Its address is the proxy's; it does not know the secret."""
    proxy = behind_proxy(tmp_path, "X-Forwarded-User", "127.0.0.1")
    settings = settings_in(tmp_path, tokens="command * -\n", public_origins=("https://control.example.org",), **proxy)
    someone = {"host": "control.example.org", "x-forwarded-user": "someone"}
    with Shielded(settings).client() as client:
        assert client.get("/who", headers=someone | shown).status_code == 401
        assert client.get("/who", headers=someone | SHOWN).json()["role"] == "command"
        twice = [*someone.items(), *SHOWN.items(), *SHOWN.items()]
        assert client.get("/who", headers=twice).status_code == 400


@pytest.mark.parametrize(
    ("content", "mode", "said"),
    [
        (b"short", 0o600, "5 bytes; expected one line of 16 to 1024 ASCII characters"),
        (b"x" * 32 + b"\n" + b"y" * 32, 0o600, "65 bytes; expected one line"),
        ("é".encode() * 32, 0o600, "64 bytes; expected one line"),
        (b"x" * 32, 0o644, "everybody may read or write it; expected chmod o-rw"),
    ],
)
def test_a_secret_of_the_proxy_that_is_none(tmp_path, content, mode, said):
    settings = settings_in(tmp_path, tokens=TOKENS, **behind_proxy(tmp_path, "x-user", "127.0.0.1"))
    settings.proxy_secret.write_bytes(content)
    settings.proxy_secret.chmod(mode)
    with pytest.raises(ParameterError, match=re.escape(said)):
        Shielded(settings)


@pytest.mark.parametrize("name", ["", " ", "*", " * "])
def test_a_header_that_names_nobody(tmp_path, name):
    """As of a proxy whose own login is switched off: it lets nobody in, not even as everybody else."""
    tokens = f"command * -\n{line_of('wall', 'watch', WATCHER)}\n"
    settings = settings_in(tmp_path, tokens=tokens, **behind_proxy(tmp_path, "X-User", "127.0.0.1"))
    headers = {"x-user": name, **SHOWN}
    with Shielded(settings).client() as client:
        assert client.get("/who", headers=headers).status_code == 401
        assert client.get("/who", headers=headers | bearer(WATCHER)).json()["name"] == "wall"


def test_too_many_requests(tmp_path):
    app = Shielded(settings_in(tmp_path, requests_per_s=0.2))
    with app.client() as client:
        assert [client.get("/who").status_code for _ in range(3)] == [200, 200, 429]
        assert int(client.get("/who").headers["retry-after"]) == 5
        assert client.get("/_nicegui/x.js").status_code == 404  # files of the page are not counted
    with app.client(peer="127.0.0.2") as client:
        assert client.get("/who").status_code == 200


def test_strangers_are_counted_at_the_files_of_the_page_too(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS, requests_per_s=0.2))
    with app.client() as client:
        assert [client.get("/_nicegui/x.js").status_code for _ in range(3)] == [401, 401, 429]


def test_a_user_is_counted_whatever_the_address(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS, requests_per_s=0.2))
    codes = []
    for number in range(4):
        with app.client(peer=f"10.0.0.{number}") as client:
            codes.append(client.get("/who", headers=bearer(WATCHER)).status_code)
    assert codes == [200, 200, 429, 429]


def test_trying_tokens_is_slowed_down(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS))
    with app.client() as client:
        codes = [client.get("/who", headers=bearer(f"muster_{number}")).status_code for number in range(12)]
        assert codes == [401] * 10 + [429] * 2
        assert client.get("/who", headers=bearer(COMMANDER)).status_code == 200  # whatever others there tried
    with app.client(peer="10.0.0.1") as client:
        assert client.get("/who", headers=bearer(COMMANDER)).status_code == 200


def test_a_flood_of_refusals_fills_no_audit_log(tmp_path):
    app = Shielded(settings_in(tmp_path))
    for number in range(150):
        with_this = {"client": (f"10.0.{number}.1", 1), "headers": [("host", "evil.example")]}
        assert asgi_answer(app.app, **with_this)[0] == 421
    with app.client() as client:
        noted = app.noted_after(client)
    assert 0 < len(noted) <= 100
    assert all(verb == "refused" for _, verb, _ in noted)


def test_one_address_is_noted_once_in_a_while(tmp_path):
    app = Shielded(settings_in(tmp_path))
    with app.client() as client:
        for _ in range(5):
            client.get("/who", headers=FOREIGN)
        ((name, verb, data),) = app.noted_after(client)
    assert (name, verb, data["status"], data["path"]) == ("local", "refused", 403, "/who") or name == ""


def test_large_bodies(tmp_path):
    app = Shielded(settings_in(tmp_path, upload_bytes=1000))
    with app.client() as client:
        assert client.post("/api/body", content=b"x" * 1000).json() == 1000
        assert client.post("/api/body", content=b"x" * 1001).status_code == 413
        streamed = client.post("/api/body", content=(b"x" * 100 for _ in range(11)))
        assert streamed.status_code == 413
        assert streamed.json()["error"] == "the body is too large; expected at most 1000 bytes"


def test_no_more_is_read_than_may_be(tmp_path):
    read = []
    app = Shielded(settings_in(tmp_path, upload_bytes=1000))
    status, _, _ = asgi_answer(
        app.app,
        method="POST",
        path="/api/body",
        headers=[("host", "localhost")],
        pieces=[b"x" * 500] * 1000,
        before_piece=lambda: read.append(1),
    )
    assert (status, len(read)) == (413, 3)


def test_what_every_answer_says(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS, certificate=tmp_path, key=tmp_path))
    with app.client(base_url="https://localhost") as client:
        for path in ("/who", "/login", "/fails", "/nowhere", "/api/body"):
            headers = client.get(path, headers=bearer(COMMANDER)).headers
            assert headers["x-content-type-options"] == "nosniff"
            assert headers["x-frame-options"] == "SAMEORIGIN"
            assert headers["referrer-policy"] == "same-origin"
            assert headers["cache-control"] == "no-store"
            assert "max-age" in headers["strict-transport-security"]
            policy = headers["content-security-policy"]
            assert "frame-ancestors 'self'" in policy
            assert not [word for word in policy.split() if "//" in word or word in ("*", "http:", "https:")]
            assert ("sandbox" in policy) == path.startswith("/api/")
            assert len(headers["x-request-id"]) == 12


def test_a_failure_says_nothing_of_itself(tmp_path, caplog):
    with Shielded(settings_in(tmp_path)).client() as client:
        answer = client.get("/fails")
    assert answer.status_code == 500
    assert "1234" not in answer.text
    assert answer.headers["x-request-id"] in answer.json()["error"]
    assert "RuntimeError" in caplog.text


def test_sockets(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS))
    with app.client() as client:
        with client.websocket_connect(SOCKET, headers=bearer(WATCHER)) as socket:
            socket.send_text("hello")
            assert socket.receive_text() == "wall: hello"
        for headers in ({}, bearer("muster_x"), bearer(WATCHER) | FOREIGN, bearer(WATCHER) | {"host": "evil.example"}):
            with pytest.raises(WebSocketDenialResponse) as raised, client.websocket_connect(SOCKET, headers=headers):
                pass
            assert raised.value.status_code in (401, 403, 421)


def test_alone_sockets_of_other_sites_are_refused(tmp_path):
    with Shielded(settings_in(tmp_path)).client() as client:
        with client.websocket_connect(SOCKET, headers={"origin": HOME}) as socket:
            socket.send_text("hello")
            assert socket.receive_text() == "local: hello"
        for origin in ("https://evil.example", "null", "http://localhost:3000"):
            with (
                pytest.raises(WebSocketDenialResponse),
                client.websocket_connect(SOCKET, headers={"origin": origin}),
            ):
                pass


def test_how_many_sockets(tmp_path):
    app = Shielded(settings_in(tmp_path, sockets_per_address=1))
    with app.client() as client:
        with client.websocket_connect(SOCKET), pytest.raises(WebSocketDenialResponse) as raised:
            client.websocket_connect(SOCKET).__enter__()
        assert raised.value.status_code == 429
        with client.websocket_connect(SOCKET):
            assert app.guard_state.sockets.taken == 1
    assert app.guard_state.sockets.taken == 0


def test_a_socket_ends_with_its_token(tmp_path):
    settings = settings_in(tmp_path, tokens=TOKENS)
    app = Shielded(settings)
    with app.client() as client, client.websocket_connect(SOCKET, headers=bearer(COMMANDER)) as socket:
        settings.tokens.write_text("watch bob -\n", encoding="utf-8")
        app.guard_state.authenticator.tokens._looked_at = float("-inf")
        socket.send_text("hello")
        with pytest.raises(WebSocketDisconnect) as raised:
            socket.receive_text()
        assert raised.value.code == 1008


@given(
    st.lists(
        st.tuples(
            st.sampled_from(
                [
                    "host",
                    "origin",
                    "authorization",
                    "cookie",
                    "content-length",
                    "x-forwarded-for",
                    "x-user",
                    "x-muster-proxy-secret",
                ]
            ),
            st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=40),
        ),
        max_size=6,
    ),
    st.text(st.characters(min_codepoint=1), max_size=20),
)
def test_hostile_headers_never_get_in_and_never_crash(tmp_path_factory, headers, path):
    global _hostile
    if _hostile is None:
        folder = tmp_path_factory.mktemp("hostile")
        _hostile = Shielded(
            settings_in(folder, tokens=TOKENS, requests_per_s=1e9, **behind_proxy(folder, "x-user", "127.0.0.1"))
        )
    status, answer_headers, body = asgi_answer(_hostile.app, path=f"/{path}", headers=headers)
    public = path in ("healthz", "login")
    assert status in ({200, 307} if public else set()) | {303, 400, 401, 413, 421, 429, 403}
    assert b"x-content-type-options" in answer_headers
    if status >= 400:
        assert set(json.loads(body)) == {"type", "title", "status", "error", "findings"}
        assert json.loads(body)["status"] == status
        assert json.loads(body)["error"].isprintable()


_hostile = None


def test_pages_are_dearer_than_other_requests(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS))
    with app.client() as client:
        pages = [client.get("/who", headers=bearer(WATCHER)).status_code for _ in range(60)]
        assert 40 <= pages.count(200) < 60
        assert set(pages) == {200, 429}
        assert client.post("/api/body", headers=bearer(WATCHER)).status_code == 200
        assert client.get("/who", headers=bearer(COMMANDER)).status_code == 200  # whom a flood of others is nothing to


def test_strangers_ask_what_is_open_in_the_usual_ways_alone(tmp_path):
    app = Shielded(settings_in(tmp_path, tokens=TOKENS))
    with app.client() as client:
        for method, path in (("POST", "/healthz"), ("PUT", "/login"), ("OPTIONS", "/login"), ("PROPFIND", "/healthz")):
            assert client.request(method, path).status_code == 401, (method, path)


@pytest.mark.parametrize(("gone", "failures"), [(True, 0), (False, 1)])
def test_that_nobody_listens_any_more_is_no_failure_of_the_server(tmp_path, caplog, gone, failures):
    shielded = Shielded(settings_in(tmp_path))

    async def tells(scope, receive, send):
        await send({"type": "websocket.accept"})
        if not gone:
            raise OSError("of the application")
        await send({"type": "websocket.send", "text": "still there?"})

    async def send(message):
        if message["type"] == "websocket.send":
            raise OSError("the client is gone")

    headers = [(b"host", b"localhost"), (b"origin", b"http://localhost")]
    scope = {"type": "websocket", "scheme": "ws", "path": "/told", "headers": headers, "client": ("127.0.0.1", 9)}
    asyncio.run(Guard(tells, shielded.guard_state)(scope, None, send))
    assert [record.name for record in caplog.records if record.levelname == "ERROR"] == ["muster.security"] * failures
