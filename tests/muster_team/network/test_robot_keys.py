"""Keys of robots: whose statements they prove, and the roster of public ones."""

import json
from dataclasses import replace

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from muster.mission.errors import InputError
from muster_team.knowledge.messages import Birth, Declaration, Evidence, Fact, Message, RoundBids, Stage
from muster_team.knowledge.signatures import NO_KEYS, convicts, forged_in
from muster_team.network.codec import Codec
from muster_team.network.robot_keys import RobotKeys, public_key, read_roster

SECRETS = {robot: bytes([k]) * 32 for k, robot in enumerate("ab", 1)}
ROSTER = {robot: public_key(key) for robot, key in SECRETS.items()}
KEYS = {robot: RobotKeys(key, ROSTER, b"here") for robot, key in SECRETS.items()}
FACT = KEYS["a"].sign(Fact("1", "a", "done", 1))
BIDS = KEYS["a"].sign(RoundBids("a", 2, (("1", 3.0),)), b"base")
DECLARED = KEYS["a"].sign(Declaration("a", 1, 4, ("a",), facts=(FACT,), incarnations=(1,)))


def test_a_proof_holds_for_its_robot_its_statement_and_its_context_alone():
    other = KEYS["b"]
    assert all([other.holds(FACT), other.holds(BIDS, b"base"), other.holds(DECLARED), other.holds(FACT)])
    assert not other.holds(replace(FACT, robot="b"))
    assert not other.holds(replace(FACT, order=2))
    assert not other.holds(replace(FACT, proof=FACT.proof[::-1]))
    assert not other.holds(replace(FACT, robot="c"))
    assert not other.holds(BIDS, b"another base")
    assert not RobotKeys(SECRETS["b"], ROSTER, b"elsewhere").holds(FACT)


def test_in_a_message_every_part_that_a_robot_states_is_held_against_its_key():
    birth = KEYS["a"].sign(Birth("a", 3))
    said = Message("b", 1, 1, Stage(4, b"base"), (DECLARED,), (BIDS,), facts=(FACT,), births=(birth,))
    assert forged_in(said, KEYS["b"]) == ""
    wrong = replace(FACT, kind="cancelled")
    for parts in (
        {"facts": (wrong,)},
        {"declarations": (replace(DECLARED, facts=(wrong,)),)},
        {"declarations": (KEYS["a"].sign(replace(DECLARED, facts=(wrong,))),)},
        {"bids": (replace(BIDS, bids=()),)},
        {"births": (replace(birth, incarnation=4),)},
    ):
        assert forged_in(replace(said, **parts), KEYS["b"]) == "a"
        assert forged_in(replace(said, **parts), NO_KEYS) == ""


@pytest.mark.parametrize("first", [BIDS, DECLARED])
def test_two_statements_of_one_robot_for_one_occasion_convict_it(first):
    context = b"base" if first is BIDS else b""
    second = KEYS["a"].sign(replace(first, **({"bids": ()} if first is BIDS else {"rounds": 7})), context)
    assert convicts(Evidence(context, first, second), KEYS["b"])
    assert not convicts(Evidence(context, first, first), KEYS["b"])
    assert not convicts(Evidence(context, first, replace(second, proof=b"")), KEYS["b"])
    later = {"round": 3} if first is BIDS else {"epoch": 5}
    assert not convicts(Evidence(context, first, KEYS["a"].sign(replace(second, **later), context)), KEYS["b"])
    assert not convicts(Evidence(context, first, second), NO_KEYS)


def test_proofs_births_and_evidence_travel():
    codec = Codec(["a", "b"], ["1"])
    evidence = Evidence(b"base", BIDS, replace(BIDS, bids=())), Evidence(b"", DECLARED, DECLARED)
    said = Message(
        "b",
        1,
        1,
        Stage(4, b"base"),
        (DECLARED,),
        (BIDS,),
        facts=(FACT,),
        births=(Birth("a", 3, b"x"),),
        evidence=evidence,
    )
    assert codec.decode(codec.encode(said)) == said


def test_a_roster_holds_the_public_key_of_each_robot(tmp_path):
    file = tmp_path / "roster.json"
    file.write_text(json.dumps({robot: key.hex() for robot, key in ROSTER.items()}))
    assert read_roster(file, ["a", "b"]) == ROSTER
    with pytest.raises(InputError, match=r"roster.json: c: no key; expected for each robot its public key"):
        read_roster(file, ["a", "c"])


@pytest.mark.parametrize("text", ["", "[]", '{"a": 1}', '{"a": "zz"}'])
def test_a_file_that_is_no_roster_is_named(tmp_path, text):
    file = tmp_path / "roster.json"
    file.write_text(text)
    with pytest.raises(InputError, match=r"roster.json: roster: other content; expected"):
        read_roster(file, ["a"])
    with pytest.raises(InputError, match="No such file"):
        read_roster(tmp_path / "nowhere", ["a"])
