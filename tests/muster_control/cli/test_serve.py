"""`muster serve`: a real process, from its first line to its end; and what it refuses to begin with."""

import json
import os
import re
import signal
import socket
import stat
import subprocess
import sys
from contextlib import contextmanager

import httpx
import pytest
from tests.cli.yard import MISSION

from muster_control.security.tokens import read_holders

_PATIENCE_S = 60


def got(url, **how):
    """What is answered there."""
    return httpx.get(url, timeout=_PATIENCE_S, **how)


class Served:
    """A server that runs: its address, and its process."""

    def __init__(self, process):
        self.process = process
        self.line = process.stdout.readline()
        self.address = self.line.partition(": ")[2].strip().rstrip("/")

    def end(self, number=signal.SIGTERM):
        """End it; its exit code, and what it said on standard error."""
        self.process.send_signal(number)
        _, said = self.process.communicate(timeout=_PATIENCE_S)
        return self.process.returncode, said


@contextmanager
def served(folder, *words):
    environment = {**os.environ, "XDG_DATA_HOME": str(folder), "MUSTER_DB": f"sqlite:///{folder}/muster.db"}
    process = subprocess.Popen(
        [sys.executable, "-m", "muster.cli", "serve", "--port", "0", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        cwd=folder,
    )
    try:
        yield Served(process)
    finally:
        process.kill()
        process.communicate()


@pytest.mark.long
def test_from_start_to_end(tmp_path):
    with served(tmp_path, "6T-2R") as server:
        (root,) = re.fullmatch(r"mission control: (http://127\.0\.0\.1:\d+)/plan/6T-2R\n", server.line).groups()
        for page in (got(f"{root}/"), got(server.address)):
            assert page.status_code == 200
            assert "<title>" in page.text
        assert got(f"{root}/healthz").json() == {"status": "ok"}
        with served(tmp_path) as second:  # one server a database
            assert second.line == ""
            _, said = second.process.communicate(timeout=_PATIENCE_S)
            expected = f"{tmp_path}/muster.db: in use by process {server.process.pid}; expected one server a database"
            assert said.startswith(expected)
            assert (second.process.returncode, said.count("\n")) == (2, 1)
        assert server.end(signal.SIGINT) == (0, "ended\n")
    assert stat.S_IMODE((tmp_path / "muster.db.lock").stat().st_mode) == 0o600


@pytest.mark.long
def test_a_mission_file_is_uploaded_once(tmp_path):
    (tmp_path / "yard.yaml").write_text(MISSION.replace("name: yard", "name: court"), encoding="utf-8")
    for _ in range(2):
        with served(tmp_path, "yard.yaml") as again:
            assert again.address.endswith("/plan/court")
            assert got(again.address).status_code == 200


@pytest.mark.long
def test_for_others(tmp_path):
    """With tokens beyond loopback: who has none gets nothing; logs have no secrets; slow and large headers end."""
    from muster.cli.main import run

    assert run(["serve", "--new-token", "anna", "--role", "command", "--tokens", str(tmp_path / "tokens")]) == 0
    (holder,) = read_holders(tmp_path / "tokens")
    assert (holder.name, holder.role) == ("anna", "command")
    words = ("--host", "0.0.0.0", "--tokens", str(tmp_path / "tokens"), "--insecure-http", "--log-format", "json")
    with served(tmp_path, *words) as server:
        token = "muster_" + "x" * 43
        answer = got(f"{server.address}/api/v1/me", headers={"authorization": f"Bearer {token}"})
        assert answer.status_code == 401
        assert got(f"{server.address}/metrics?token={token}").status_code == 401
        assert got(f"{server.address}/", headers={"accept": "text/html"}).status_code == 303
        with socket.create_connection(("127.0.0.1", int(server.address.rpartition(":")[2]))) as flood:
            _flood(flood)
        code, said = server.end()
    assert code == 0
    assert token not in said
    events = [json.loads(line) for line in said.splitlines() if line != "ended"]
    assert all({"time", "level", "event", "logger"} <= event.keys() for event in events)
    asked = [event for event in events if event["logger"] == "muster.requests"]
    assert {"request", "user", "address", "ms"} <= asked[0].keys()


def _flood(connection):
    """Send headers without end, until the server has had enough of them."""
    connection.settimeout(_PATIENCE_S)
    connection.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n")
    more = b"".join(b"X-%d: " % number + b"x" * 4096 + b"\r\n" for number in range(10_000))
    with pytest.raises(OSError, match=r"reset|pipe"):
        connection.sendall(more)


@pytest.fixture
def asked(muster, tmp_path, monkeypatch):
    """`muster serve` with these words in this process: exit code and what it says."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)

    def ask(*words):
        code, out, err = muster("serve", *words)
        assert out == ""
        return code, err

    return ask


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--host", "0.0.0.0"), "--host 0.0.0.0 reaches beyond this machine; expected --tokens FILE"),
        (("--host", "0.0.0.0", "--tokens", "tokens"), "--host 0.0.0.0 reaches beyond this machine without TLS; "),
        (("--tokens", "nowhere"), "nowhere: No such file or directory; expected a file that can be read"),
        (("--tokens", "broken"), "broken:1: 1 words; expected ROLE NAME DIGEST"),
        (("--tls-cert", "tokens"), "--tls-cert and --tls-key: one of them given; expected both"),
        (("--tls-cert", "tokens", "--tls-key", "tokens"), "--tls-cert tokens --tls-key tokens: "),
        (("--tls-cert", "nowhere", "--tls-key", "tokens"), "nowhere: No such file or directory"),
        (("--user-header", "X-User"), "--user-header given without --tokens FILE"),
        (("--user-header", "X-User", "--tokens", "tokens"), "--user-header X-User given without --trusted-proxy"),
        (
            ("--user-header", "X-User", "--tokens", "tokens", "--trusted-proxy", "::1"),
            "--user-header X-User given without --proxy-secret FILE, as any process of that machine could send",
        ),
        (("--proxy-secret", "tokens"), "--proxy-secret given without --tokens FILE"),
        (("--proxy-secret", "tokens", "--tokens", "tokens"), "--proxy-secret tokens given without --user-header"),
        (("--trusted-proxy", "127.0.0.1"), "--trusted-proxy given without --tokens FILE"),
        (("--trusted-proxy", "x", "--tokens", "tokens"), "--trusted-proxy: 'x'; expected an IP address or network"),
        (("--public-origin", "https://a.b"), "--public-origin given without --tokens FILE"),
        (("--public-origin", "a.b", "--tokens", "tokens"), "--public-origin: 'a.b'; expected such as https://"),
        (("--tiles", "nowhere"), "--tiles nowhere: no folder; expected one with Z/X/Y.png in it"),
        (("--role", "watch"), "--role watch given without --new-token NAME; expected both"),
        (("--new-token", "a b"), "--new-token: name: 'a b'; expected up to 64 of letters"),
        (("--new-token", "wall", "--tokens", "tokens"), "tokens: wall has a token; expected another name"),
        (("--db", "mysql://pa55word@host/x"), "--db: mysql://...; expected sqlite:///FILE or postgresql://"),
        (("--db", "postgresql://u:pa55word@localhost:1/x"), "PostgreSQL x at localhost:1: "),
        (("--db", "sqlite:////proc/x/muster.db"), "/proc/x/muster.db.lock: "),
        (("--db", "sqlite:///tokens"), "tokens: "),
        (("nowhere.yaml",), "nowhere.yaml: no file, and no mission of that name"),
    ],
)  # fmt: skip
def test_what_it_refuses(asked, tmp_path, words, said):
    (tmp_path / "tokens").write_text("watch wall -\n")
    (tmp_path / "broken").write_text("nonsense\n")
    words = words if "--host" in words or "--port" in words else ("--port", "0", *words)
    code, err = asked(*words)
    *_, last = err.splitlines()
    assert last.startswith(said)
    assert code == 2
    assert "pa55word" not in err
    assert "Traceback" not in err


def _people(file):
    return [(holder.role, holder.name) for holder in read_holders(file)]


def test_a_token_is_added_behind_what_stands_in_the_file(muster, tmp_path):
    """Also behind a last line without an end, and in a file that is empty; the file keeps its mode."""
    for before, expected in (
        ("", []),
        ("\n", []),
        ("# the team", []),
        ("watch wall -", [("watch", "wall")]),
        ("watch wall -\n", [("watch", "wall")]),
    ):
        file = tmp_path / "tokens"
        file.write_text(before)
        file.chmod(0o600)
        for name in ("anna", "bob"):
            code, _, err = muster("serve", "--new-token", name, "--tokens", file)
            assert (code, err) == (0, f"added to {file}: watch {name}\n")
        assert _people(file) == [*expected, ("watch", "anna"), ("watch", "bob")]
        assert file.read_text().startswith(before)
        assert stat.S_IMODE(file.stat().st_mode) == 0o600


def test_a_new_file_of_tokens_can_be_read_by_a_service(muster, tmp_path):
    before = os.umask(0o077)
    try:
        code, _, _ = muster("serve", "--new-token", "anna", "--tokens", tmp_path / "tokens")
    finally:
        os.umask(before)
    assert (code, _people(tmp_path / "tokens")) == (0, [("watch", "anna")])
    assert stat.S_IMODE((tmp_path / "tokens").stat().st_mode) == 0o644


@pytest.mark.long
def test_tokens_that_are_added_at_once_have_a_line_each(tmp_path):
    (tmp_path / "tokens").write_text("watch wall -")
    names = [f"n{k}" for k in range(4)]
    command = [sys.executable, "-m", "muster.cli", "serve", "--tokens", str(tmp_path / "tokens"), "--new-token"]
    adding = [subprocess.Popen([*command, name], stdout=subprocess.PIPE, stderr=subprocess.PIPE) for name in names]
    for each in adding:
        each.communicate(timeout=_PATIENCE_S)
    assert sorted(name for _, name in _people(tmp_path / "tokens")) == sorted([*names, "wall"])


def test_a_port_that_is_taken(asked):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        code, err = asked("--port", port)
    assert (code, err) == (2, f"127.0.0.1 port {port}: Address already in use; expected a free one (--port; 0: any)\n")


def test_a_host_of_another_machine(asked, tmp_path):
    (tmp_path / "tokens").write_text("watch wall -\n")
    for host, said in (("192.0.2.1", "Cannot assign requested address"), ("no.such.invalid", "")):
        code, err = asked("--host", host, "--tokens", "tokens", "--insecure-http")
        assert code == 2
        assert said in err
        assert len(err.splitlines()) == 1


def test_without_the_extra(asked, monkeypatch):
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    code, err = asked()
    assert (code, err) == (2, "mission control needs an optional part: pip install 'muster-robotics[web]'\n")
