"""What a robot's process keeps is what it has when it starts again."""

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import InputError
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.messages import Claim, Fact
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
