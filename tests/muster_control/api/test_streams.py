"""WebSockets: what they tell, when they end, whom they refuse."""

import json

import pytest
from websockets.exceptions import ConnectionClosedOK, InvalidStatus
from websockets.sync.client import connect


def told(url, path, token=None):
    """Every message of a stream."""
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    messages = []
    with connect(f"ws{url.removeprefix('http')}/api/v1{path}", additional_headers=headers, max_size=None) as socket:
        try:
            while True:
                messages.append(json.loads(socket.recv(timeout=60)))
        except ConnectionClosedOK:
            return messages


def test_a_job_is_told_until_it_is_over(url, http, yard):
    job = http.post(f"/missions/{yard}/plans", json={"time_limit": 0.5}).json()["id"]
    messages = told(url, f"/jobs/{job}/stream")
    assert {(message["type"], message["id"]) for message in messages} == {("job", job)}
    assert messages[0]["state"] in ("queued", "running")
    assert messages[-1] == {"type": "job", **http.get(f"/jobs/{job}").json()}
    assert told(url, f"/jobs/{job}/stream") == messages[-1:]


@pytest.mark.long
def test_a_run_is_told_while_it_goes_on_and_afterwards(url, http, plan):
    run = http.post("/runs", json={"plan": plan, "speed": None}).json()["id"]
    live, later = told(url, f"/runs/{run}/stream"), told(url, f"/runs/{run}/stream")
    log = http.get(f"/runs/{run}/events").json()
    for messages in (live, later):
        assert (messages[0]["type"], messages[0]["run"]["id"]) == ("hello", run)
        entries = [message for message in messages if message["type"] == "entry"]
        assert [(entry["seq"], entry["kind"]) for entry in entries] == [(entry["seq"], entry["kind"]) for entry in log]
        assert all(entry["line"] for entry in entries)
        states = [message.get("run", message)["state"] for message in messages if message["type"] in ("hello", "run")]
        assert states[-1] == "ended"
    rest = told(url, f"/runs/{run}/stream?after={len(log) - 1}")
    assert [message["seq"] for message in rest if message["type"] == "entry"] == [len(log)]


@pytest.mark.parametrize("path", ["/jobs/999/stream", "/runs/999/stream"])
def test_what_is_not_there_is_refused_as_over_http(url, path):
    with pytest.raises(InvalidStatus) as refused:
        told(url, path)
    assert refused.value.response.status_code == 404
    assert "999" in json.loads(refused.value.response.body)["error"]


def test_an_unknown_parameter_is_refused_as_over_http(url, http, plan):
    run = http.post("/runs", json={"plan": plan, "speed": None}).json()["id"]
    with pytest.raises(InvalidStatus) as refused:
        told(url, f"/runs/{run}/stream?afer=3")
    assert refused.value.response.status_code == 422
    assert "afer" in json.loads(refused.value.response.body)["error"]


def test_nobody_listens_without_a_token(guarded):
    url, tokens = guarded
    with pytest.raises(InvalidStatus) as refused:
        told(url, "/jobs/1/stream")
    assert refused.value.response.status_code == 401
    with pytest.raises(InvalidStatus) as refused:
        told(url, "/jobs/1/stream", tokens["watch"])
    assert refused.value.response.status_code == 404


@pytest.mark.long
def test_orders_are_taken_over_a_websocket_and_answered_each(url, http, plan):
    settings = {"stay": True, "until_s": 60.0}
    run = http.post("/runs", json={"plan": plan, "speed": 20.0, "settings": settings}).json()["id"]
    orders = [{"new_task": {"id": name, "type": "E", "position": [1, 1]}} for name in ("o1", "o2")]
    with connect(f"ws{url.removeprefix('http')}/api/v1/runs/{run}/orders") as socket:
        answers = []
        for text in (json.dumps(orders), json.dumps(orders[0]), '{"robot_fails": "r_0"}', "[", json.dumps([])):
            socket.send(text)
            answers.append(json.loads(socket.recv(timeout=60)))
    assert [answer["type"] for answer in answers] == ["action", "action", "refused", "refused", "refused"]
    assert answers[0]["data"] == {"orders": orders}
    assert "expected one of new_task, cancel_task" in answers[2]["error"]
    assert "is no JSON at character 1" in answers[3]["error"]
    told(url, f"/runs/{run}/stream")
    logged = http.get("/actions", params={"run": run}).json()  # a slow database gives them other ids
    outcomes = [next(each["outcome"] for each in logged if each["at"] == answer["at"]) for answer in answers[:2]]
    assert outcomes[0] == "done"
    assert "expected an id that no task has" in outcomes[1]
    assert http.get(f"/runs/{run}/report").json()["orders"]["taken"] == 2


@pytest.mark.long
def test_orders_to_a_run_that_is_over_or_not_there_are_refused_as_over_http(url, http, plan):
    run = http.post("/runs", json={"plan": plan, "speed": None}).json()["id"]
    told(url, f"/runs/{run}/stream")
    for path, code in ((f"/runs/{run}/orders", 409), ("/runs/999/orders", 404)):
        with pytest.raises(InvalidStatus) as refused:
            told(url, path)
        assert refused.value.response.status_code == code
    assert http.post(f"/runs/{run}/orders", json={"orders": [{"cancel_task": "1"}]}).status_code == 409
    assert http.post(f"/runs/{run}/orders", json={"orders": []}).status_code == 422
