"""The Python blocks of the pages on Python and on extending run, and print what the pages say."""

import re
from pathlib import Path

import pytest

from muster.mission.action_keys import ACTION_KEYS
from muster.motion.actions import ACTIONS

DOCS = Path(__file__).parents[2] / "docs"
BLOCK = re.compile(r"```python\n(.*?)```(?:\s*<!-- docs-check: output -->\n```text\n(.*?)```)?", re.DOTALL)
BLOCKS = [
    pytest.param(*block.groups(), id=f"{page}-{k}")
    for page in ("python-api", "extending")
    for k, block in enumerate(BLOCK.finditer((DOCS / f"{page}.md").read_text(encoding="utf-8")))
]


@pytest.mark.long(keep=2)
@pytest.mark.parametrize(("code", "output"), BLOCKS)
def test_a_block_runs_and_prints_what_stands_below_it(code, output, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        exec(compile(code, "block", "exec"), {"__name__": "block"})
    finally:
        if "rounds" in ACTIONS:
            ACTIONS.remove("rounds")
            ACTION_KEYS.remove("rounds")
    printed = capsys.readouterr().out
    assert output is None or printed == output
