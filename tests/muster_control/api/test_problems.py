"""Errors: always problem JSON, whatever is sent; in bounded time and memory."""

import contextlib
import json
import re

import httpx
import pytest

JSON = {"content-type": "application/json"}
LONG = 17 * 2**20


def require_problem(answer, status):
    assert answer.status_code == status, answer.text[:300]
    assert answer.headers["content-type"] == "application/problem+json"
    found = answer.json()
    assert set(found) == {"type", "title", "status", "error", "findings"}
    assert found["status"] == status
    assert re.fullmatch(r"urn:muster:problem:[a-z-]+", found["type"])
    assert found["title"][0].isupper()
    return found


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", "/missions/none", 404),
        ("GET", "/missions/31T-6R50?version=7", 404),
        ("GET", "/plans/999", 404),
        ("GET", "/plans/999/verdict", 404),
        ("GET", "/jobs/999", 404),
        ("DELETE", "/jobs/999", 404),
        ("POST", "/jobs/999/stop", 404),
        ("GET", "/runs/999", 404),
        ("GET", "/runs/999/events", 404),
        ("GET", "/records/999/page.html", 404),
        ("DELETE", "/missions/31T-6R50", 409),
        ("PATCH", "/missions", 405),
        ("GET", "/plans/0", 422),
        ("GET", "/plans/99999999999", 422),
        ("GET", "/plans/one", 422),
        ("GET", "/missions/%00", 422),
        ("GET", "/missions/..%2f..%2fetc", 404),
        ("GET", "/missions/31T-6R50/files/.x", 422),
        ("GET", "/runs?limit=1001", 422),
        ("GET", "/actions?before=0", 422),
        ("GET", "/plans?mission=%00", 422),
        ("GET", "/plans?mision=a", 422),
        ("GET", "/me?a", 422),
        ("DELETE", "/jobs/999?now=1", 422),
        ("POST", "/missions/31T-6R50/plans?seed=1", 422),
    ],
)
def test_paths_and_parameters(http, method, path, status):
    require_problem(http.request(method, path), status)


def test_an_unknown_parameter_names_the_known_ones(http):
    found = require_problem(http.get("/jobs?misson=a&limit=1"), 422)
    (finding,) = found["findings"]
    assert (finding["file"], finding["field"], finding["value"]) == ("query", "misson", '"a"')
    assert finding["expected"].startswith("one of state, mission, before, limit")
    assert "did you mean 'mission'?" in finding["expected"]


def test_an_unknown_field_of_an_upload_is_refused(http):
    files = {"file": ("a.yaml", b"schema: muster/1"), "fiel": ("b.yaml", b"")}
    found = require_problem(http.post("/missions/upload", files=files), 422)
    assert [finding["field"] for finding in found["findings"]] == ["fiel"]


def test_405_says_what_is_allowed(http):
    assert http.patch("/missions").headers["allow"] == "GET, POST"


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b"", 422),
        (b"{", 400),
        (b"\xff", 400),
        (b"[" * 1_000_000, 413),
        (b"[" * 100_000, 400),
        (b'{"a":' * 100 + b"1" + b"}" * 100, 400),
        (b"[" + b"[]," * 1_000_000 + b"1]", 413),
        (b'{"text": "' + b"x" * LONG + b'"}', 413),
        (b'{"text": NaN}', 400),
        (b'{"text": 1e999}', 400),
        (b'{"text": ' + b"1" * 10_000 + b"}", 400),
        (b'{"text": "\\ud800"}', 400),
        (b'{"text": "\\u0000"}', 400),
        (b'{"text": "a\\\\u0000"}', 400),  # no NUL, but no mission either
        (b'{"text": 1}', 422),
        (b'{"text": "a", "more": 1}', 422),
        (b'{"text": "a", "files": {"../x": ""}}', 422),
        (b'{"text": "a", "files": {"x": "no base64!"}}', 422),
        (b'{"text": "a: &a [*a, *a]"}', 400),
    ],
)
def test_bodies(http, body, status):
    found = require_problem(http.post("/missions", content=body, headers=JSON), status)
    assert len(found["error"]) < 1000
    assert http.get("/me").status_code == 200


def test_a_body_that_is_no_json_by_its_type(http):
    require_problem(http.post("/missions", content=b'{"text": "a"}', headers={"content-type": "text/plain"}), 422)


def test_a_long_body_without_a_length_is_not_read_to_its_end(http):
    sent = 0

    def pieces():
        nonlocal sent
        while sent < 40 * LONG:
            yield b" " * 2**16
            sent += 2**16

    with contextlib.suppress(httpx.TransportError):  # the connection may be closed under it
        require_problem(http.post("/missions", content=pieces(), headers=JSON), 413)
    assert sent < 4 * LONG  # what may be sent, what is thrown away, and what is on its way
    assert http.get("/me").status_code == 200


def test_a_long_upload(http):
    require_problem(http.post("/missions/upload", files={"file": ("a.yaml", b" " * LONG)}), 413)


@pytest.mark.parametrize(
    "name", ["a.exe", "a", "../../a.csv", "a\0.yaml", "\ud800.yaml".encode("utf-8", "replace").decode()]
)
def test_odd_uploads(http, name):
    require_problem(http.post("/missions/upload", files={"file": (name, b"\xff\x00")}), 400)


def test_what_is_wrong_with_a_mission_comes_with_lines(http):
    found = require_problem(http.post("/missions", json={"text": "schema: muster/1\nrobots: []\ntasks: 7\n"}), 400)
    assert {finding["line"] for finding in found["findings"]} == {2, 3}


def test_what_is_wrong_with_a_plan_says_where(http, yard):
    found = require_problem(http.post(f"/missions/{yard}/plans/upload", json={"schema": "muster-plan/1"}), 400)
    assert [finding["field"] for finding in found["findings"]] == ["routes"]


@pytest.mark.parametrize(
    ("asked", "status", "said"),
    [
        ({"allocator": "serach"}, 400, "did you mean 'search'?"),
        ({"parameters": {"treads": 2}}, 400, "did you mean 'threads'?"),
        ({"objective": "totl"}, 400, "did you mean 'total'?"),
        ({"bound": "exat"}, 400, "did you mean 'exact'?"),
        ({"ignore": ["capacty"]}, 400, "did you mean 'capacity'?"),
        ({"allocater": "search"}, 422, "allocater"),
    ],
)
def test_a_request_that_nothing_can_meet_is_refused_at_once(http, yard, asked, status, said):
    before = len(http.get("/jobs").json())
    found = require_problem(http.post(f"/missions/{yard}/plans", json=asked), status)
    assert said in found["error"]
    assert len(http.get("/jobs").json()) == before


@pytest.mark.long
def test_watchers_change_nothing(guarded, http):
    """Every route that changes something, asked with a body that its description gives as an example."""
    url, tokens = guarded
    described = http.get("/openapi.json").json()
    bodies = {
        "/missions/{mission}/plans/upload": {"schema": "muster-plan/1", "routes": []},
        "/runs": {"plan": 1},
        "/runs/{run}/actions": {"verb": "pause"},
        "/runs/{run}/orders": {"orders": [{"cancel_task": "1"}]},
    }
    asked = 0
    who = {"authorization": f"Bearer {tokens['watch']}"}
    with httpx.Client(base_url=f"{url}/api/v1", headers=who, timeout=60) as watcher:
        for path, methods in described["paths"].items():
            for method in set(methods) - {"get"}:
                if path == "/missions/check":
                    continue
                how = {"json": bodies.get(path, {"text": "a"} if "plans" not in path else {})}
                if path == "/missions/upload":
                    how = {"files": {"file": ("a.yaml", b"a")}}
                if method == "delete":
                    how = {}
                if "files" in path:
                    how = {"content": b"a"}
                where = path.format(mission="31T-6R50", name="a", job=1, run=1)
                answer = watcher.request(method, where, headers={"if-match": '"0"'}, **how)
                require_problem(answer, 403)
                asked += 1
        assert asked >= 9
        assert watcher.get("/missions").status_code == 200
    assert httpx.get(f"{url}/api/v1/missions", timeout=60).status_code == 401


def test_messages_fit_into_a_line_each(http):
    found = require_problem(http.post("/missions", content=json.dumps({"text": ["\n" * 500]}), headers=JSON), 422)
    assert "\n" not in found["error"]
