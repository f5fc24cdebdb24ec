"""`muster auction`: on this machine, one robot of a team, in a network in memory; and all that may be wrong."""

import json
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("folder")

MISSION = """\
schema: muster/1
name: three
robots:
  - {id: a, position: [0, 0]}
  - {id: b, position: [10, 0]}
  - {id: c, position: [5, 5]}
tasks:
  - {id: "1", position: [1, 1]}
  - {id: "2", position: [9, 1]}
  - {id: "3", position: [5, 4]}
"""
GUARD_S = 60


@pytest.fixture
def three(folder, muster):
    """A mission of three robots, and a key."""
    Path("three.yaml").write_text(MISSION, encoding="utf-8")
    assert muster("auction", "--new-key", "key")[0] == 0
    return Path("three.yaml")


def without_times(text):
    data = json.loads(text)
    del data["elapsed_s"]
    return data | {"history": [value for _, value in data["history"]]}


@pytest.mark.long
def test_plan_and_book_are_those_of_the_auction_in_one_process(muster):
    terms = ("--bid", "max", "--placement", "append", "--winner", "least-contested", "--ignore", "capacity")
    code, out, err = muster("auction", "yard.yaml", *terms, "--format", "json", "-q", "--book", "here.csv")
    assert (code, err) == (0, "")
    code, central, _ = muster("solve", "yard.yaml", "-a", "auction", *terms, "--format", "json", "--book", "there.csv")
    assert code == 0
    assert without_times(out) == without_times(central)
    assert Path("here.csv").read_bytes() == Path("there.csv").read_bytes()


@pytest.mark.long
def test_each_robot_writes_what_it_knows(muster, three):
    code, out, err = muster("auction", three, "--views", "views", "-o", "plan.json")
    assert code == 0
    assert err.startswith("3 robots agreed after ")
    assert "tasks completed   3 of 3" in out
    plan = json.loads(Path("plan.json").read_text())
    assert sorted(path.name for path in Path("views").iterdir()) == ["a.json", "b.json", "c.json"]
    for view in Path("views").iterdir():
        assert json.loads(view.read_text())["routes"] == plan["routes"]
        assert muster("verify", three, view)[0] == 0


@pytest.mark.long
def test_a_task_that_nobody_can_do_is_told(muster):
    assert muster("auction", "yard.yaml", "--require-complete", "-q")[0] == 3


@pytest.mark.long
def test_a_time_limit_ends_it_and_says_how_far_it_was(muster):
    code, out, err = muster("auction", "yard.yaml", "--time-limit", 0)
    assert (code, out) == (2, "")
    assert err == "no agreement within 0 s: not all processes had started\n"


def running(*arguments, **others):
    """A command in a process of its own."""
    command = [sys.executable, "-m", "muster.cli", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **others)


@pytest.mark.long
def test_ctrl_c_ends_it(three):
    tasks = "".join(f'  - {{id: "{k}", position: [{k}, {k % 7}]}}\n' for k in range(4, 2000))
    three.write_text(MISSION + tasks, encoding="utf-8")
    process = running("auction", three)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    guard_s = time.monotonic() + GUARD_S
    while not children.read_text():  # its robots' processes: it is under way
        assert time.monotonic() < guard_s
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=GUARD_S)
    assert (process.returncode, out, err.strip()) == (130, "", "interrupted")


# In a network in memory


def test_a_seed_gives_one_run(muster, three):
    faults = ("--loss", 0.3, "--delay", 0.05, "--jitter", 0.1, "--duplication", 0.2, "--crashes", 1, "--cut", 6)
    runs = [muster("auction", three, "--simulate-network", 5, *faults, "-v", "--format", "json") for _ in range(2)]
    assert runs[0] == runs[1]
    code, out, err = runs[0]
    assert code == 0
    assert " crashes\n" in err
    assert "the network is cut: " in err
    assert "the network is whole again\n" in err
    assert " wins 1 for " in err
    assert "all 2 agree" in err
    assert json.loads(out)["tasks_completed"] == 3
    assert muster("auction", three, "--simulate-network", 6, *faults, "-v", "--format", "json")[2] != err


def test_more_crashes_than_robots_are_refused(muster, three):
    code, _, err = muster("auction", three, "--simulate-network", 1, "--crashes", 3)
    assert (code, err) == (2, "--crashes: 3; expected less than the 3 robots\n")


def test_a_network_that_loses_too_much_is_told(muster, three):
    code, _, err = muster("auction", three, "--simulate-network", 1, "--loss", 0.99, "--time-limit", 3, "-q")
    assert code == 2
    assert err.startswith("no agreement within 3 virtual s: ")


# One robot of a team


def free_ports(number):
    """Ports of this machine that are free at the moment."""
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in range(number)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


@pytest.fixture
def ports():
    return dict(zip("abc", free_ports(3), strict=True))


def of_robot(name, ports, *others, mission="three.yaml", key="key", named=True):
    """The words of its command."""
    peers = ",".join(f"{other}=" * named + f"127.0.0.1:{port}" for other, port in ports.items() if other != name)
    address = ("--listen", f"127.0.0.1:{ports[name]}", "--connect", peers)
    return "auction", mission, "--robot", name, "--key-file", key, *address, *others


def robot(name, ports, *others, **more):
    return running(*of_robot(name, ports, *others, **more))


def ended(*processes):
    """By process exit code, standard output and standard error."""
    told = [process.communicate(timeout=GUARD_S) for process in processes]
    return [(process.returncode, *words) for process, words in zip(processes, told, strict=True)]


@pytest.mark.long
def test_three_processes_agree_and_say_who_is_there(three, ports):
    """Whether or not they are told under which name they find each other."""
    own = {name: ("--linger", 1, "-o", f"{name}.json") for name in "abc"}
    processes = [robot("a", ports, *own["a"]), *(robot(name, ports, *own[name], named=False) for name in "bc")]
    for name, (code, _, err) in zip("abc", ended(*processes), strict=True):
        assert code == 0
        for other in set("abc") - {name}:
            assert f"{other} is there\n" in err
        assert "all 3 agree, in round 3 of epoch " in err
    plans = [json.loads(Path(f"{name}.json").read_text())["routes"] for name in "abc"]
    assert plans[0] == plans[1] == plans[2]
    assert sorted(task for route in plans[0] for task in route["tasks"]) == ["1", "2", "3"]


@pytest.mark.long
def test_without_the_third_the_others_go_on_when_they_have_waited(three, ports):
    processes = [robot(name, ports, "--wait", 4, "--linger", 1, "--format", "json") for name in "ab"]
    for code, out, err in ended(*processes):
        assert code == 0
        assert "all 2 agree" in err
        assert json.loads(out)["tasks_completed"] == 3


@pytest.mark.long
def test_with_its_memory_a_robot_that_starts_again_has_what_it_had(three, ports):
    first = [robot(name, ports, "--linger", 30, "--memory", f"{name}.memory", "--wait", 50) for name in "abc"]
    guard_s = time.monotonic() + GUARD_S
    while not all(Path(f"{name}.memory").exists() and owned(remembered(name)) for name in "abc"):
        assert time.monotonic() < guard_s
        time.sleep(0.05)
    before = remembered("b")
    first[1].send_signal(signal.SIGKILL)
    first[1].communicate()
    again = robot("b", ports, "--linger", 1, "--memory", "b.memory", "--wait", 50, "--format", "json")
    [(code, out, err)] = ended(again)
    assert (code, "all 3 agree" in err) == (0, True)
    after = remembered("b")
    assert after["incarnation"] > before["incarnation"]
    assert owned(after) == owned(before)
    assert json.loads(out)["tasks_completed"] == 3
    for process in (first[0], first[2]):
        process.send_signal(signal.SIGINT)
        assert ended(process)[0][0] == 130


def remembered(name):
    return json.loads(Path(f"{name}.memory").read_text())


def owned(kept):
    return [claim["task"] for claim in kept["memory"]["claims"]]


@pytest.mark.long
def test_of_two_processes_of_one_robot_the_first_ends_and_says_why(three, ports):
    (spare,) = free_ports(1)
    first = robot("a", ports, "--wait", 50)
    second = robot("b", ports | {"a again": spare}, "--wait", 50, "--linger", 1, named=False)
    for line in second.stderr:
        if line == "a is there\n":
            break
    third = robot("a", ports | {"a": spare}, "--wait", 50, "--linger", 1)  # not at the port that the first has
    [(code, out, err)] = ended(first)
    assert (code, out) == (2, "")
    assert err.endswith("a: another process has started under this name; expected one for each robot, this one ends\n")
    last = robot("c", ports | {"a": spare}, "--linger", 1)  # for whom the others wait
    assert [code for code, *_ in ended(second, third, last)] == [0, 0, 0]


@pytest.mark.parametrize("options", [(), ("--simulate-network", 5)])
def test_without_a_mission_something_is_missing(muster, options):
    code, out, err = muster("auction", *options)
    assert (code, out) == (2, "")
    assert err.endswith("Error: Missing argument 'MISSION'.\n")


@pytest.mark.long
def test_another_key_and_another_mission_are_told(muster, three, ports):
    """The first two robots have the same key, the third and the first the same mission."""
    assert muster("auction", "--new-key", "other")[0] == 0
    Path("other.yaml").write_text(MISSION.replace("[1, 1]", "[1, 2]"), encoding="utf-8")
    others = {"a": {}, "b": {"mission": "other.yaml"}, "c": {"key": "other"}}
    told = ended(*(robot(name, ports, "--wait", 6, **more) for name, more in others.items()))
    assert [(code, out) for code, out, _ in told] == [(2, "")] * 3
    by_mission, by_key = [err for *_, err in told[:2]], told[2][2]
    assert any(
        "hold another auction; expected everywhere the same mission and terms, and the same roster\n" in err
        for err in by_mission
    )
    *_, last = by_key.splitlines()  # it may have said before that it is alone
    assert last.startswith("c: ")
    assert last.endswith(" messages, none made with this key; expected the same key everywhere")


def test_nobody_there_is_told(muster, three, ports):
    code, out, err = muster(*of_robot("a", ports, "--wait", 1))
    assert (code, out, err) == (2, "", "a: nobody there for 1 s; expected to hear one of b, c\n")


def test_a_port_in_use_is_told(muster, three, ports):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", ports["a"]))
        code, out, err = muster(*of_robot("b", ports | {"b": ports["a"]}))
    assert (code, out) == (2, "")
    assert err.startswith(f"127.0.0.1:{ports['a']}: Address already in use; expected ")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--robot", "d"), "--robot: d; expected one of a, b, c\n"),
        (("--robot", "a"), "--key-file missing; expected with --robot (`muster auction --new-key FILE` makes one)\n"),
        (("--robot", "a", "--key-file", "nowhere"), "nowhere: key: No such file or directory; expected "),
        (("--robot", "a", "--key-file", "three.yaml"), "three.yaml: key: "),
        (("--robot", "a", "--key-file", "key"), "--connect or --multicast: expected one of them with --robot\n"),
        (("--robot", "a", "--key-file", "key", "--connect", "b"), "--connect: b; expected HOST:PORT\n"),
        (("--robot", "a", "--key-file", "key", "--connect", "z=h:1"), "--connect: robot z is not in the mission; "),
        (("--robot", "a", "--key-file", "key", "--multicast", "h"), "--multicast: h; expected HOST:PORT\n"),
        (("--robot", "a", "--key-file", "key", "--multicast", "10.0.0.1:7"), "group: 10.0.0.1; expected 224.0.0.0 "),
        (("--connect", "h:1"), "--connect given; expected it together with --robot\n"),
        (("--loss", "0.1"), "--loss given; expected it together with --simulate-network\n"),
        (("--robot", "a", "--simulate-network", "1"), "--robot and --simulate-network given; expected one of them\n"),
        (("--method", "dance"), "method: dance; expected auction or consensus-bundle\n"),
        (("--set", "speed=3"), "auction has no parameter speed"),
        (("--bid", "max", "--set", "bid=max"), "--set: bid given twice; expected it once, as --bid\n"),
        (("--book", "book.txt"), "--book: book.txt; expected a file that ends in .csv\n"),
        (("--views", "three.yaml"), "--views: three.yaml is a file; expected a folder"),
    ],
)
def test_what_does_not_go_together_is_told(muster, three, options, message):
    code, out, err = muster("auction", three, *options)
    assert (code, out) == (2, "")
    assert err.startswith(message)
    assert err.count("\n") == 1


def test_what_is_no_number_is_refused(muster, three):
    code, _, err = muster("auction", three, "--simulate-network", 1, "--cut", "nan")
    assert code == 2
    assert "nan is not in the range" in err


def test_a_key_is_not_overwritten_and_is_its_owners_alone(muster, three):
    assert Path("key").stat().st_mode & 0o777 == 0o600
    code, _, err = muster("auction", "--new-key", "key")
    assert (code, err.startswith("key: ")) == (2, True)


def test_a_memory_of_something_else_is_refused(muster, three):
    options = ("--robot", "a", "--key-file", "key", "--connect", "127.0.0.1:9", "--memory", "memory")
    Path("memory").write_text("{}", encoding="utf-8")
    assert muster("auction", three, *options)[2] == "memory: other content; expected what --memory has written\n"
    other = {"schema": "muster-memory/1", "auction": "00", "robot": "a", "incarnation": 1, "memory": None}
    Path("memory").write_text(json.dumps(other), encoding="utf-8")
    assert "memory: auction: of another mission or other terms; expected " in muster("auction", three, *options)[2]
    Path("memory").write_text(json.dumps(other | {"robot": "b"}), encoding="utf-8")
    assert "memory: robot: b; expected a, or a new file\n" in muster("auction", three, *options)[2]


TIMED = MISSION.replace("position: [9, 1]", "position: [9, 1], window_s: [5, 60], robots_needed: 2")


@pytest.mark.parametrize("where", [(), ("--robot", "a"), ("--simulate-network", "1")])
def test_a_mission_on_which_they_cannot_agree_is_refused_by_name(where, muster):
    Path("timed.yaml").write_text(TIMED, encoding="utf-8")
    code, out, err = muster("auction", "timed.yaml", *where, "--method", "consensus-bundle", "-o", "plan.json")
    assert (code, out) == (2, "")
    assert "task 2: window_s (window)" in err
    assert "task 2: robots_needed (team)" in err
    assert not Path("plan.json").exists()


def test_rules_that_are_ignored_do_not_stand_in_the_way(muster):
    Path("timed.yaml").write_text(TIMED, encoding="utf-8")
    rules = ("--ignore", "window,team")
    assert muster("auction", "timed.yaml", *rules, "--simulate-network", "1")[0] == 0


def test_simulate_negotiate_refuses_it_before_a_record_is_begun(muster):
    once = TIMED.replace("robots_needed: 2", "robots_needed: 2, across_partition: at-most-once")
    Path("timed.yaml").write_text(once, encoding="utf-8")
    code, _, err = muster("simulate", "timed.yaml", "--negotiate", "--record", "run.mcap", "--html", "run.html")
    assert code == 2
    assert "across_partition: at-most-once of 2; expected at-least-once for tasks that several robots begin" in err
    assert not list(Path().glob("run.*"))
