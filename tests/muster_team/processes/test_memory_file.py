"""What a robot's process keeps is what it has when it starts again."""

import json
import string

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.muster_team.networks import line_mission

from muster.allocation.auctions.auction import Parameters
from muster.mission.errors import InputError
from muster.model.problem import Problem
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.messages import Claim, Fact
from muster_team.negotiators.participation import negotiator_of
from muster_team.processes.memory_file import Kept, kept_in

names = st.text(string.ascii_letters + '"\\ ä/', min_size=1, max_size=4)
claims = st.builds(Claim, names, st.floats(allow_nan=False), st.integers(0, 999), st.booleans())
facts = st.builds(Fact, names, names, st.sampled_from(["done", "begun", "added"]), st.integers(0, 99), st.binary())
memories = st.builds(
    Memory,
    claims=st.lists(claims, max_size=3).map(tuple),
    facts=st.lists(facts, max_size=3).map(tuple),
    epoch=st.integers(0, 2**40),
    knows=st.booleans(),
    refused=st.frozensets(names),
    reserved=st.lists(facts, max_size=3).map(tuple),
)


@given(memory=st.none() | memories, robot=names, incarnation=st.integers(0, 2**60))
def test_what_is_kept_comes_back(tmp_path_factory, memory, robot, incarnation):
    file = tmp_path_factory.mktemp("kept") / "memory"
    kept = Kept(auction="ab", robot=robot, incarnation=incarnation, memory=memory)
    kept.save(file)
    assert kept_in(file, "ab", robot) == kept
    assert [path.name for path in file.parent.iterdir()] == ["memory"]


def test_without_a_file_nothing_was_kept(tmp_path):
    assert kept_in(tmp_path / "memory", "ab", "r") == Kept(auction="ab", robot="r")


@pytest.mark.parametrize("text", ["", "[]", "{}", "\xff", '{"schema": "muster-memory/1", "memory": {"claims": 3}}'])
def test_other_content_is_refused(tmp_path, text):
    file = tmp_path / "memory"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match="memory: other content; expected what --memory has written"):
        kept_in(file, "ab", "r")


GOOD = {
    "claims": [{"task": "1", "price": 2.0, "round": 1, "begun": True}],
    "facts": [{"task": "2", "robot": "r_0", "kind": "done", "order": 1, "content": "", "proof": ""}],
    "epoch": 4,
    "knows": True,
    "refused": ["3"],
    "reserved": [],
}


@pytest.mark.parametrize(
    "bad",
    [
        {"claims": [*GOOD["claims"], {"task": "1"}, 7, None]},
        {"claims": [*GOOD["claims"], {"task": "zz", "price": "cheap", "round": -1, "begun": 3}]},
        {"claims": [*GOOD["claims"], GOOD["claims"][0] | {"surplus": 1}]},
        {"facts": [*GOOD["facts"], GOOD["facts"][0] | {"content": "no hex"}]},
        {"facts": [*GOOD["facts"], GOOD["facts"][0] | {"kind": "added", "content": b"no task".hex()}]},
        {"facts": [*GOOD["facts"], GOOD["facts"][0] | {"robot": "zz"}, GOOD["facts"][0] | {"order": 2**80}]},
        {"facts": [*GOOD["facts"], GOOD["facts"][0] | {"kind": "ready", "content": b"[1]".hex()}]},
        {"reserved": [{"task": "1", "robot": "r_0", "kind": "begun", "order": 2, "content": b"soon".hex()}]},
        {"refused": ["3", 4]},
        {"reserved": None},
        {"knows": "yes"},
    ],
)
def test_a_poisoned_memory_heals_and_its_robot_does_not_count_as_one_that_remembers_all(tmp_path, bad):
    file = tmp_path / "memory"
    kept = {"schema": "muster-memory/1", "auction": "ab", "robot": "r_0", "incarnation": 3, "memory": GOOD | bad}
    file.write_text(json.dumps(kept))
    found = kept_in(file, "ab", "r_0")
    assert found.incarnation == 3
    problem = Problem.compile(line_mission()).ready()
    node = negotiator_of(problem, Parameters(), "r_0", incarnation=4, remembered=found.memory)
    node.start(0.0)
    assert not node.knows
    assert {claim.task for claim in node.memory.claims if claim.begun} == {"1"}
    assert {fact.task for fact in node.facts} == {"2"}
    assert node.stage.epoch == 5


@pytest.mark.parametrize("memory", [3, "text", [], {"epoch": "four"}])
def test_a_memory_of_another_form_is_none(tmp_path, memory):
    file = tmp_path / "memory"
    kept = {"schema": "muster-memory/1", "auction": "ab", "robot": "r", "incarnation": -2, "memory": memory}
    file.write_text(json.dumps(kept))
    assert kept_in(file, "ab", "r") == Kept(auction="ab", robot="r", memory=Memory(knows=False))
