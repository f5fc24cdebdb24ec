"""The page's login."""

import pytest
from tests.muster_control.security.shielded import (
    COMMANDER,
    FOREIGN,
    HOME,
    SOCKET,
    TOKENS,
    WATCHER,
    Shielded,
    settings_in,
)

_OWN = {"origin": HOME}


@pytest.fixture
def app(tmp_path):
    return Shielded(settings_in(tmp_path, tokens=TOKENS))


def test_login_and_logout(app):
    with app.client() as client:
        page = client.get("/login?next=/plan/x")
        assert 'name="next" type="hidden" value="/plan/x"' in page.text
        answer = client.post("/login", data={"token": f" {COMMANDER}\n", "next": "/plan/x"}, headers=_OWN)
        assert (answer.status_code, answer.headers["location"]) == (303, "/plan/x")
        cookie = answer.headers["set-cookie"]
        assert cookie.startswith("muster_session=")
        assert {"httponly", "samesite=strict", "path=/", "max-age=43200"} <= set(cookie.lower().split("; "))
        assert COMMANDER not in cookie
        assert client.get("/who").json()["name"] == "anna"
        stolen = dict(client.cookies)
        assert client.post("/logout", headers=_OWN).headers["location"] == "/login"
        assert client.get("/who").status_code == 401
        client.cookies.update(stolen)
        assert client.get("/who").status_code == 401
        verbs = [(name, verb) for name, verb, _ in app.noted_after(client)]
    assert verbs == [("anna", "login"), ("anna", "logout")]


def test_a_session_needs_an_origin_to_change_anything(app):
    with app.client() as client:
        client.post("/login", data={"token": COMMANDER}, headers=_OWN)
        assert client.post("/who", headers=_OWN).status_code == 200
        assert client.post("/who", headers={"sec-fetch-site": "same-origin"}).status_code == 200
        assert client.post("/who").status_code == 403
        assert client.post("/who", headers=FOREIGN).status_code == 403
        with client.websocket_connect(SOCKET, headers=_OWN) as socket:
            socket.send_text("hello")
            assert socket.receive_text() == "anna: hello"


def test_under_tls_the_cookie_is_for_this_host_alone(app):
    secure = {"origin": "https://localhost"}
    with app.client(base_url="https://localhost") as client:
        cookie = client.post("/login", data={"token": WATCHER}, headers=secure).headers["set-cookie"].lower()
        assert cookie.startswith("__host-muster_session=")
        assert {"secure", "httponly", "samesite=strict", "path=/"} <= set(cookie.split("; "))
        assert "domain=" not in cookie
        assert client.get("/who").json()["name"] == "wall"


def test_a_token_that_is_deleted_ends_its_sessions(tmp_path, app):
    with app.client() as client:
        client.post("/login", data={"token": COMMANDER}, headers=_OWN)
        (tmp_path / "tokens.txt").write_text("watch anna -\n")
        app.guard_state.authenticator.tokens._looked_at = float("-inf")
        assert client.get("/who").status_code == 401


def test_a_wrong_token(app):
    with app.client() as client:
        answer = client.post("/login", data={"token": "<b>wrong</b>"}, headers=_OWN)
        assert answer.status_code == 403
        assert "Nobody has this token." in answer.text
        assert "<b>" not in answer.text
        assert "set-cookie" not in answer.headers
        ((_, verb, data),) = app.noted_after(client)
    assert verb == "refused"
    assert "wrong" not in str(data).replace("wrong token", "")


def test_trying_is_slowed_down(app):
    with app.client() as client:
        codes = [client.post("/login", data={"token": "x"}, headers=_OWN).status_code for _ in range(11)]
        assert codes == [403] * 10 + [429]
        assert client.post("/login", data={"token": COMMANDER}, headers=_OWN).status_code == 303
        assert client.post("/login", data={"token": "x"}, headers=_OWN).status_code == 429


def test_nobody_is_logged_in_by_another_site(app):
    with app.client() as client:
        assert client.post("/login", data={"token": COMMANDER}, headers=FOREIGN).status_code == 403


@pytest.mark.parametrize(
    "following", ["//evil.example", "https://evil.example", "/\\evil", "", "/a\r\nSet-Cookie: x", "/login"]
)
def test_it_leads_nowhere_else(app, following):
    with app.client() as client:
        answer = client.post("/login", data={"token": COMMANDER, "next": following}, headers=_OWN)
        assert answer.headers["location"] == "/"


def test_the_form_shows_what_it_is_given_as_text(app):
    with app.client() as client:
        assert "<script>" not in client.get('/login?next=/"><script>').text


@pytest.mark.parametrize(
    ("content", "status"),
    [(b"x" * 5000, 413), (b"token=\xff", 400), (b"&".join([b"a=1"] * 20), 400), (b"", 403), (b"token", 403)],
)
def test_hostile_forms(app, content, status):
    with app.client() as client:
        assert client.post("/login", content=content, headers=_OWN).status_code == status


def test_where_no_token_is_asked_for(tmp_path):
    with Shielded(settings_in(tmp_path)).client() as client:
        assert client.get("/login").headers["location"] == "/"
        assert client.post("/login", data={"token": "x"}).headers["location"] == "/"
