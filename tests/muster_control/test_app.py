"""The whole application: nothing answers without a token, and nobody comes in by another way."""

import re
import subprocess
import sys

import pytest
from fastapi.routing import APIRoute
from starlette.routing import Mount, Route, WebSocketRoute
from tests.muster_control.databases import *  # noqa: F403 - fixtures
from tests.muster_control.security.shielded import (
    COMMANDER,
    FOREIGN,
    TOKENS,
    WATCHER,
    WebSocketDenialResponse,
    bearer,
    settings_in,
)
from tests.muster_control.security.shielded import TestClient as Client

from muster.mission.errors import ParameterError
from muster_control.app import make_app
from muster_control.contract import ForbiddenError, User
from muster_control.settings import Settings

_OPEN = {"/healthz", "/login"}
_PEER = "10.0.0.9"
_METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE")


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    """As `muster serve --host 0.0.0.0 --tokens FILE --insecure-http`, on its way."""
    folder = tmp_path_factory.mktemp("served")
    (folder / "tiles" / "1" / "0").mkdir(parents=True)
    (folder / "tiles" / "1" / "0" / "1.png").write_bytes(b"a tile")
    settings = settings_in(
        folder,
        tiles=folder / "tiles",
        tokens=TOKENS,
        host="0.0.0.0",
        insecure_http=True,
        requests_per_s=1e6,
        trusted_proxies=(_PEER,),
    )
    return make_app(settings)


@pytest.fixture(scope="module")
def client(app):
    with Client(app, base_url="http://10.0.0.5:8117", client=(_PEER, 5), follow_redirects=False) as found:
        yield found


def _from(address):
    """Headers as if a proxy had passed a request on: of one address few refusals are noted."""
    return {"x-forwarded-for": address}


def _paths(routes, prefix=""):
    """Every path under routes and mounts, with something in place of its parameters."""
    for route in routes:
        path = prefix + re.sub(r"\{[^}]*\}", "1", getattr(route, "path", ""))
        if isinstance(route, Mount):
            yield path + "/", "http"
            yield path + "/x.js", "http"
            yield path + "/socket.io/?EIO=4&transport=polling", "http"
            yield path + "/socket.io/?EIO=4&transport=websocket", "websocket"
            yield from _paths(route.routes or [], path)
        elif isinstance(route, WebSocketRoute):
            yield path, "websocket"
        elif isinstance(route, Route | APIRoute):
            yield path, "http"
        elif hasattr(route, "original_router"):
            yield from _paths(route.original_router.routes, prefix)
        else:
            raise AssertionError(f"no way to look into {route!r}")


@pytest.mark.long
def test_nothing_answers_without_a_token(app, client):
    paths = sorted(set(_paths(app.routes)))
    assert len(paths) > 50
    assert {"/api/v1/missions", "/api/v1/openapi.json", "/metrics"} <= {path for path, _ in paths}
    for path, kind in paths:
        if kind == "websocket":
            with pytest.raises(WebSocketDenialResponse) as raised:
                client.websocket_connect(f"ws://10.0.0.5:8117{path}").__enter__()
            assert raised.value.status_code == 401, path
        elif path not in _OPEN:
            for method in _METHODS:
                assert client.request(method, path).status_code == 401, (method, path)


@pytest.mark.long
def test_a_session_is_no_way_past_the_origin(app, client):
    for path, kind in sorted(set(_paths(app.routes))):
        if kind == "websocket":
            with pytest.raises(WebSocketDenialResponse) as raised:
                client.websocket_connect(f"ws://10.0.0.5:8117{path}", headers=bearer(WATCHER) | FOREIGN).__enter__()
            assert raised.value.status_code == 403, path
        else:
            for method in ("GET", "POST", "DELETE"):
                assert client.request(method, path, headers=bearer(COMMANDER) | FOREIGN).status_code == 403, path


@pytest.mark.parametrize(
    "path",
    ["/healthz/", "/login/../metrics", "/login%2f..%2fmetrics", "/%2e%2e/metrics", "//metrics", "/_nicegui/../metrics",
     "/_nicegui/x/static/..%2f..%2f..%2fapp.py", "/login;/metrics", "/healthz%00", "/login?next=/metrics#", "/.env"],
)  # fmt: skip
def test_tricks_with_paths(client, path):
    answer = client.get(path)
    assert answer.status_code == 401 or (path.startswith("/login?") and "muster_" not in answer.text)


def test_the_page_and_its_files(client):
    page = client.get("/", headers=bearer(WATCHER))
    assert page.status_code == 200
    outside = re.findall(r"""(?:src|href)=["'](?:https?:)?//[^"']+""", page.text)
    assert outside == []
    (script, *_) = re.findall(r'src="(/_nicegui/[^"]+\.js)"', page.text)
    file = client.get(script, headers=bearer(WATCHER))
    assert (file.status_code, client.get(script).status_code) == (200, 401)
    assert "immutable" in file.headers["cache-control"]


def test_tiles(client):
    assert client.get("/tiles/1/0/1.png", headers=bearer(WATCHER)).content == b"a tile"
    assert client.get("/tiles/1/0/1.png").status_code == 401
    for path in ("/tiles/1/0/2.png", "/tiles/", "/tiles/%2e%2e/tokens.txt", "/tiles/..%2f..%2ftokens.txt"):
        assert client.get(path, headers=bearer(WATCHER)).status_code == 404


def test_health_and_metrics(client):
    assert client.get("/healthz").json() == {"status": "ok"}
    text = client.get("/metrics", headers=bearer(WATCHER)).text
    for name in (
        'muster_request_seconds_count{method="GET",route="/healthz",status="2xx"}',
        'muster_jobs{state="queued"}',
        'muster_runs{state="running"}',
        "muster_log_append_seconds_count",
        "muster_store_failures_total",
        "muster_memory_bytes",
    ):
        assert name in text
    assert "/metrics;" not in text


def test_strangers_make_no_metrics(client):
    for number in range(20):
        client.get(f"/stranger/{number}")
        client.request(f"METHOD{number}", "/")
    text = client.get("/metrics", headers=bearer(WATCHER)).text
    assert "stranger" not in text
    assert "METHOD" not in text


def test_health_without_a_database(app, client, monkeypatch):
    from muster_control.contract import StoreError

    def fails():
        raise StoreError("/data/muster.db: full; expected room")

    services = app.state.services
    monkeypatch.setattr("muster_control.health._HOLDS_S", -1.0)
    monkeypatch.setattr(type(services.store), "check", lambda _: fails())
    stranger, known = client.get("/healthz"), client.get("/healthz", headers=bearer(WATCHER))
    assert (stranger.status_code, stranger.json()) == (503, {"status": "not ok"})
    assert known.json()["reasons"] == ["database: /data/muster.db: full; expected room"]


@pytest.mark.parametrize("request_of", [{"method": "GET"}, {"method": "POST", "json": {"text": "robots: []"}}])
def test_who_asks_a_server_that_is_ending_is_told_so(request_of):
    ended = Client(make_app(Settings()), base_url="http://localhost")
    answer = ended.request(url="/api/v1/missions", **request_of)
    assert answer.status_code == 503
    assert answer.json()["error"] == "the server is ending; ask again when it has started anew"


def test_logins_and_refusals_are_in_the_audit_log(app, client):
    client.post("/login", data={"token": COMMANDER}, headers={"origin": "http://10.0.0.5:8117"})
    client.cookies.clear()
    assert client.get("/api/v1/me", headers=bearer(WATCHER) | FOREIGN | _from("10.0.1.1")).status_code == 403
    client.portal.call(app.state.guard_state.audit.settle)
    actions = client.get("/api/v1/actions", headers=bearer(WATCHER)).json()
    assert ("anna", "login") in {(action["who"], action["verb"]) for action in actions}
    assert ("10.0.1.1", "refused") in {(action["address"], action["verb"]) for action in actions}
    assert COMMANDER not in str(actions)


@pytest.mark.parametrize("more", [{"host": "0.0.0.0"}, {"user_header": "x"}, {"certificate": "x"}])
def test_it_is_not_even_made_where_that_is_not_safe(more):
    with pytest.raises(ParameterError):
        make_app(Settings(**more))


@pytest.mark.long
def test_a_second_application_in_one_process_on_postgresql(postgresql_url):
    with Client(make_app(Settings(database=postgresql_url)), base_url="http://localhost") as client:
        assert client.get("/healthz").status_code == 200
        assert client.get("/api/v1/me").json()["name"] == "local"


@pytest.mark.long
def test_the_server_is_made_without_what_makes_it_large():
    """Planning, simulation and drawing are work of other processes; NumPy alone would be 13 MB and 0.2 s."""
    program = (
        "import sys; from muster_control.app import make_app; from muster_control.settings import Settings;"
        "make_app(Settings());"
        "print([name for name in sys.argv[1:] if name in sys.modules])"
    )
    large = ("numpy", "scipy", "shapely", "matplotlib", "alembic", "aiohttp", "requests", "muster.core")
    large += ("muster.simulation", "muster.model.problem", "muster.verification", "muster.execution")
    found = subprocess.run([sys.executable, "-c", program, *large], capture_output=True, text=True, check=True)
    assert found.stdout == "[]\n"


def test_who_tries_to_command_without_the_role_is_in_the_audit_log(app, client):
    text = "robots: [{id: r, position: [0, 0]}]"
    refused = client.post("/api/v1/missions", json={"text": text}, headers=bearer(WATCHER) | _from("10.0.2.1"))
    assert refused.status_code == 403
    client.portal.call(app.state.guard_state.audit.settle)
    noted = client.get("/api/v1/actions", headers=bearer(COMMANDER)).json()
    (action,) = (a for a in noted if (a["who"], a["verb"], a["address"]) == ("wall", "refused", "10.0.2.1"))
    action["data"].pop("left_out", None)  # how many refusals of tests before this one were not written
    assert action["data"] == {"why": "wall may only watch; expected the role command", "command": "mission.create"}


def test_so_is_who_does_so_by_a_page_which_asks_no_route(app, client):
    wall, runs = User("wall", "watch", "10.0.3.1"), app.state.services.runs
    for _ in range(3):
        with pytest.raises(ForbiddenError):
            client.portal.call(runs.act, wall, 1, "pause")
    client.portal.call(app.state.guard_state.audit.settle)
    noted = client.get("/api/v1/actions", headers=bearer(COMMANDER)).json()
    (action,) = (a for a in noted if a["address"] == "10.0.3.1")  # of one address, once in a while
    assert (action["verb"], action["data"]["command"]) == ("refused", "run.pause")
