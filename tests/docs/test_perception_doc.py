"""What docs/perception.md says is so."""

import re
from pathlib import Path

import pytest

pytest.importorskip("apriltag")
pytest.importorskip("cv2")
pytest.importorskip("scipy")

TEXT = (Path(__file__).parents[2] / "docs" / "perception.md").read_text(encoding="utf-8")


def test_the_examples_print_what_stands_beneath_them(capsys):
    names = {}
    printed = []
    for example in re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL):
        exec(compile(example, "perception.md", "exec"), names)
        printed.append(capsys.readouterr().out)
    first, *others = printed
    assert f"That prints `{first.strip()}`" in TEXT
    assert others == re.findall(r"```text\n(.*?)```", TEXT, flags=re.DOTALL)
