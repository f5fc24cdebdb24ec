"""The file of tokens: what it says, what is wrong with it, and that changes count at once."""

from hashlib import sha256
from pathlib import Path

import pytest
from tests.muster_control.security.shielded import COMMANDER, TOKENS, WATCHER

from muster.mission.errors import InputError
from muster_control.security.tokens import Holder, Tokens, line_of, new_token, read_holders


def _file(folder, text):
    file = Path(folder) / "tokens.txt"
    file.write_text(text, encoding="utf-8")
    file.chmod(0o600)
    return file


def test_a_line_holds_no_secret():
    token = new_token()
    assert line_of("anna", "watch", token) == f"watch anna {sha256(token.encode()).hexdigest()}"
    assert len({new_token() for _ in range(100)}) == 100
    assert all(len(new_token()) >= len("muster_") + 43 for _ in range(100))  # 256 bits in base 64


def test_who_has_which_token(tmp_path):
    tokens = Tokens(_file(tmp_path, TOKENS))
    assert tokens.holder(COMMANDER).role == "command"
    assert tokens.holder(WATCHER) == tokens.named("wall")
    for wrong in ("", COMMANDER[:-1], COMMANDER + "x", "\udcff", "-"):
        assert tokens.holder(wrong) is None


def test_a_user_of_the_proxy_has_no_token(tmp_path):
    tokens = Tokens(_file(tmp_path, "command bob -\nwatch * -\n"))
    assert tokens.named("bob") == Holder("bob", "command", "")
    assert [tokens.holder(text) for text in ("", "-")] == [None, None]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("watch anna", "tokens.txt:1: 2 words; expected ROLE NAME DIGEST"),
        ("\nwatcher anna -", "tokens.txt:2: role: 'watcher'; expected watch or command; did you mean 'watch'?"),
        ("watch an/na -", "tokens.txt:1: name: 'an/na'; expected up to 64 of letters, digits and . _ @ + -"),
        (f"watch * {'0' * 64}", "tokens.txt:1: name: '*'; expected up to 64 of letters, digits and . _ @ + -"),
        ("watch a -\nwatch a -", "tokens.txt:2: name: a again; expected each name once"),
        ("watch a 123", "tokens.txt:1: digest: 3 characters; expected 64 of 0-9 and a-f, or - for a user of the proxy"),
    ],
)
def test_what_is_wrong_with_a_file(tmp_path, text, said):
    with pytest.raises(InputError) as raised:
        read_holders(_file(tmp_path, text))
    assert str(raised.value).startswith(f"{tmp_path}/{said}")


@pytest.mark.parametrize("text", ["", "\n", "# nobody yet\n"])
def test_a_file_without_a_token(tmp_path, text):
    """It names nobody; a server does not begin with it."""
    file = _file(tmp_path, text)
    assert read_holders(file) == ()
    with pytest.raises(InputError) as raised:
        Tokens(file)
    said = "no token; expected a line ROLE NAME DIGEST (muster serve --new-token)"
    assert str(raised.value) == f"{file}: {said}"


@pytest.mark.parametrize("text", ["", "# the team\n"])
def test_when_the_last_line_is_deleted_nobody_is_let_in(tmp_path, caplog, text):
    now = [0.0]
    tokens = Tokens(_file(tmp_path, f"{TOKENS}command bob -\n"), lambda: now[0])
    _file(tmp_path, text)
    now[0] += 2.0
    assert [tokens.holder(token) for token in (COMMANDER, WATCHER)] == [None, None]
    assert tokens.named("bob") is None
    assert (tokens.look(), caplog.messages) == ("", [f"{tmp_path}/tokens.txt: no token; nobody is let in"])


def test_a_token_in_the_file_is_not_shown(tmp_path):
    with pytest.raises(InputError, match="expected its SHA-256") as raised:
        read_holders(_file(tmp_path, f"watch anna {COMMANDER}"))
    assert COMMANDER not in str(raised.value)


def test_a_file_that_anybody_may_write(tmp_path):
    file = _file(tmp_path, TOKENS)
    file.chmod(0o666)
    with pytest.raises(InputError, match="may be written by anybody; expected chmod o-w"):
        read_holders(file)


def test_no_text(tmp_path):
    (tmp_path / "tokens.txt").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="is no text"):
        read_holders(tmp_path / "tokens.txt")


def test_a_change_counts_and_a_broken_one_does_not(tmp_path, caplog):
    now = [0.0]
    file = _file(tmp_path, TOKENS)
    tokens = Tokens(file, lambda: now[0])
    _file(tmp_path, line_of("wall", "watch", WATCHER))
    now[0] += 2.0
    assert tokens.holder(COMMANDER) is None
    assert tokens.holder(WATCHER) is not None
    _file(tmp_path, "nonsense")
    now[0] += 2.0
    assert tokens.holder(WATCHER) is not None
    assert "the tokens are as before" in caplog.text
    file.unlink()
    now[0] += 2.0
    assert tokens.holder(WATCHER) is not None


@pytest.mark.parametrize("name", ["", "a b", "a\n", "-", "*", "x" * 65])
def test_a_name_that_is_none(name):
    with pytest.raises(InputError, match="expected up to 64"):
        line_of(name, "watch", "t")


def test_a_change_that_cannot_be_read_is_told_again_and_again_until_it_is_mended(tmp_path, caplog):
    now = [0.0]
    file = _file(tmp_path, TOKENS)
    tokens = Tokens(file, clock=lambda: now[0])
    assert tokens.look() == ""
    file.unlink()
    for now[0] in (10.0, 20.0, 75.0):
        assert "the tokens are as before" in tokens.look()
    assert len(caplog.records) == 2
    _file(tmp_path, TOKENS)
    now[0] = 80.0
    assert tokens.look() == ""
