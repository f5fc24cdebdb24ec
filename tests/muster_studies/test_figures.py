"""Figures of studies: their numbers, what they are drawn from, and that they are drawn."""

from importlib.util import find_spec

import pytest
from tools.figures.printed_figures import NOT_DRAWN, PRINTED

from muster.cli.main import run as muster
from muster_studies.registry import STUDIES


@pytest.mark.parametrize("name", [study.name for study in STUDIES.values() if study.figures])
def test_numbers_and_tables_are_a_study_s_own(name):
    study = STUDIES[name]
    numbers = [figure.number for figure in study.figures]
    assert len(set(numbers)) == len(numbers)
    for figure in study.figures:
        assert figure.tables
        assert set(figure.tables) <= set(study.tables)
        assert figure.shows
        assert not figure.shows.endswith(".")


@pytest.mark.long
@pytest.mark.parametrize(
    ("study", "number"),
    [("auction-5", "5.3"), ("auction-5", "5.16"), ("auction-5", "5.15"), ("thesis-6", "6.12"), ("market-rescue", "6"),
     ("thesis-6.1", "A.12")],
)  # fmt: skip
def test_a_figure_is_drawn_without_tables(study, number, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    assert muster(["study", study, "--figures", number, "--quick", "--plot", str(tmp_path)]) == 0
    assert (tmp_path / f"figure-{number}.png").stat().st_size > 10_000
    assert capsys.readouterr().out == ""


@pytest.mark.long
@pytest.mark.skipif(find_spec("mujoco") is None or find_spec("cv2") is None, reason="needs the extra `physics`")
def test_a_view_of_the_physics_world(tmp_path):
    assert muster(["study", "thesis-6", "--figures", "6.11", "--plot", str(tmp_path)]) == 0
    assert (tmp_path / "figure-6.11.png").stat().st_size > 10_000


@pytest.mark.parametrize("source", PRINTED)
def test_every_printed_figure_is_drawn_or_has_a_reason(source):
    figures = [figure for study in STUDIES.values() for figure in study.figures]
    drawn = {figure.number for figure in figures if figure.source == source}
    left_out = [number for entry in NOT_DRAWN if entry.source == source for number in entry.numbers]
    assert len(set(left_out)) == len(left_out)
    assert not drawn & set(left_out)
    assert drawn | set(left_out) == set(PRINTED[source])


def test_a_figure_s_source_is_a_document():
    for study in STUDIES.values():
        assert {figure.source for figure in study.figures} <= {*PRINTED, ""}
    assert all(entry.reason for entry in NOT_DRAWN)
