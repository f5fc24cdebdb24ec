"""What docs/estimation.md says is so."""

import re
from pathlib import Path

import pytest

TEXT = (Path(__file__).parents[2] / "docs" / "estimation.md").read_text(encoding="utf-8")


@pytest.mark.long
def test_its_examples_run(capsys):
    names = {}
    for example in re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL):
        exec(compile(example, "estimation.md", "exec"), names)
    assert capsys.readouterr().out
    assert names["fix"].nis < 10
    assert names["drift"].travelled[-1] == pytest.approx(51.6, abs=0.05)
    assert names["drift"].fixes.max() < 0.2 < names["drift"].odometry.max()
    # seen from (0.5, 0.5) facing 0.6: 1 m ahead, 0.7 m up the map
    assert names["mark"].range_m == pytest.approx(1.2207, abs=0.01)
    assert names["mark"].bearing_rad == pytest.approx(0.6107 - 0.6, abs=0.01)


def test_every_file_it_names_is_there():
    from muster import perception

    folder = Path(perception.__file__).parent
    filters = TEXT[: TEXT.index("## Sensors of the pose")]
    rows = re.findall(r"^\| `([a-z_]+)` \|", filters, flags=re.MULTILINE)
    assert rows == ["ground_fusion", "air_fusion", "heading_fusion"]
    for name in [*rows, "kalman", "dead_reckoning", "pose_tracking", "targets", "laser", "drift"]:
        assert f"`{name}" in TEXT
        assert (folder / f"{name}.py").exists()
