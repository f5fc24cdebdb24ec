"""Key files."""

import pytest

from muster.mission.errors import InputError
from muster_team.network.keys import new_key, read_key, write_key


def test_a_key_is_read_as_it_was_written_and_is_its_owners_alone(tmp_path):
    path, key = tmp_path / "team.key", new_key()
    write_key(path, key)
    assert path.stat().st_mode & 0o777 == 0o600
    assert read_key(path) == key
    assert len(key) == 32
    assert new_key() != key


def test_a_key_is_not_overwritten(tmp_path):
    path = tmp_path / "team.key"
    write_key(path, new_key())
    with pytest.raises(InputError, match="it exists; expected the name of a new file"):
        write_key(path, new_key())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("00" * 31, "62 digits; expected 64 hexadecimal digits"),
        ("00" * 33, "66 digits; expected 64 hexadecimal digits"),
        ("", "0 digits; expected 64 hexadecimal digits"),
        ("g" * 64, "other characters; expected 64 hexadecimal digits"),
        ("é" * 64, "other characters; expected 64 hexadecimal digits"),
    ],
)
def test_what_is_no_key_is_told(tmp_path, text, expected):
    path = tmp_path / "team.key"
    path.touch(0o600)
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=expected):
        read_key(path)


@pytest.mark.parametrize("mode", [0o644, 0o640, 0o602])
def test_a_key_that_others_may_use_is_refused(tmp_path, mode):
    path = tmp_path / "team.key"
    write_key(path, new_key())
    path.chmod(mode)
    with pytest.raises(InputError, match=f"mode {mode:04o}.*expected mode 0600"):
        read_key(path)


def test_a_key_that_is_not_there_is_told(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_key(tmp_path / "none.key")
    with pytest.raises(InputError, match="directory"):
        read_key(tmp_path)
    with pytest.raises(InputError, match="expected a file that can be made"):
        write_key(tmp_path / "none" / "team.key", new_key())
