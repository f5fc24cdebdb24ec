"""`muster auction --revoke`: the order of an operator, and robots that take it while they run."""

import json
import time
from pathlib import Path

import pytest
from tests.muster_team.cli.test_auction import GUARD_S, MISSION, ended, free_ports, robot

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

pytestmark = pytest.mark.usefixtures("folder")


@pytest.fixture
def team(muster):
    """A mission of three robots, keys of all, a roster, and words for the command of the operator."""
    Path("three.yaml").write_text(MISSION, encoding="utf-8")
    assert muster("auction", "--new-key", "key")[0] == 0
    roster = {}
    for name in ("a", "b", "c", "@operator"):
        code, out, _ = muster("auction", "--new-robot-key", f"{name}.key")
        assert code == 0
        roster[name] = out.strip()
    Path("roster.json").write_text(json.dumps(roster), encoding="utf-8")
    return "auction", "three.yaml", "--roster", "roster.json"


def test_the_order_is_a_line(muster, team):
    code, out, err = muster(*team, "--revoke", "c", "--robot-key", "@operator.key")
    assert (code, err) == (0, "")
    assert out.count("\n") == 1
    assert json.loads(out)["revoked"] == "c"
    assert muster(*team, "--revoke", "c", "--robot-key", "@operator.key")[1] == out
    assert muster(*team, "--revoke", "b", "--robot-key", "@operator.key")[1] != out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--revoke", "d", "--robot-key", "@operator.key"), "--revoke: d; expected one of a, b, c\n"),
        (("--revoke", "c"), "--robot-key and --roster: expected both with --revoke\n"),
        (("--revoke", "c", "--robot-key", "a.key"), "--robot-key: a.key; expected the key whose public one "),
        (("--revoke", "c", "--robot", "a"), "--robot and --revoke given; expected one of them\n"),
        (("--revoke", "c", "--revocations", "file"), "--revocations given; expected it together with --robot\n"),
        (("--robot-key", "a.key"), "--robot-key given; expected it together with --robot\n"),
    ],
)
def test_what_does_not_go_together_is_told(muster, team, options, message):
    code, out, err = muster(*team, *options)
    assert (code, out) == (2, "")
    assert err.startswith(message)
    assert err.count("\n") == 1


def test_orders_that_cannot_be_read_are_told(muster, team):
    key = ("--robot", "a", "--key-file", "key", "--robot-key", "a.key", "--connect", "127.0.0.1:9", "--wait", 1)
    code, _, err = muster(*team, *key, "--revocations", "nowhere")
    assert (code, err.splitlines()[-1].startswith("nowhere: revocations: No such file")) == (2, True)
    order = muster(*team, "--revoke", "c", "--robot-key", "@operator.key")[1]
    lines = order.replace('"c"', '"b"'), "\n", "{}\n", order
    Path("orders").write_text("".join(lines), encoding="utf-8")
    _, _, err = muster(*team, *key, "--revocations", "orders")
    assert 'orders:1: revocation: a statement that "@operator" has not made' not in err
    assert 'orders:1: revocation: a fact that "@operator" has not stated; expected one signed by the key of' in err
    assert "orders:3: other content; expected lines that `muster auction --revoke` prints\n" in err
    assert "going on without c for good, as an operator has revoked its key\n" in err


@pytest.mark.long
def test_a_team_that_runs_goes_on_without_the_robot(muster, team):
    Path("orders").touch()
    ports = dict(zip("abc", free_ports(3), strict=True))

    def run(name, *others):
        keys = ("--robot-key", f"{name}.key", "--roster", "roster.json", "--format", "json")
        return robot(name, ports, *keys, "--linger", 8, "--wait", 4, *others)

    processes = [run("a", "--revocations", "orders"), run("b"), run("c")]
    guard_s = time.monotonic() + GUARD_S
    for line in processes[0].stderr:
        if line.startswith("all 3 agree"):
            break
    assert time.monotonic() < guard_s
    order = muster(*team, "--revoke", "c", "--robot-key", "@operator.key")[1]
    Path("orders").write_text(order, encoding="utf-8")
    (a, _, told), (b, out, _), (c, nothing, why) = ended(*processes)
    assert (a, b, c, nothing) == (0, 0, 2, "")
    assert "going on without c for good, as an operator has revoked its key\n" in told
    assert why.endswith(
        "c: the team goes on without it, as an operator has revoked its key; expected a new key of it in every roster\n"
    )
    assert json.loads(out)["tasks_completed"] == 3
