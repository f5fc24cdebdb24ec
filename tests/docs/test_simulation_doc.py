"""What docs/simulation.md shows runs."""

import re
from pathlib import Path

import numpy as np
import pytest

TEXT = (Path(__file__).parents[2] / "docs" / "simulation.md").read_text(encoding="utf-8")


def test_its_examples_run(capsys, tmp_path, monkeypatch):
    pytest.importorskip("shapely")
    monkeypatch.chdir(tmp_path)  # where films go
    names = {}
    for example in re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL):
        exec(compile(example, "simulation.md", "exec"), names)
    two_numbers = [line for line in capsys.readouterr().out.splitlines() if re.fullmatch(r"[\d.]+ [\d.]+", line)]
    (measured, exact) = map(float, two_numbers[-1].split())
    assert 0 < abs(measured - exact) < 0.05
    assert np.isfinite(exact)
