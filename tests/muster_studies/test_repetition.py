"""Studies by their tables: which runs are done, how often, and what comes of them."""

from dataclasses import dataclass

import pytest

from muster.mission.errors import ParameterError
from muster_studies.descriptions import captioned
from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure, draw_figures
from muster_studies.repetition import Repetition, one_by_one
from muster_studies.tables import Table


@dataclass(frozen=True)
class Squares:
    number: str
    numbers: tuple[int, ...]

    def jobs(self, effort):
        return self.numbers

    def table(self, effort, found):
        return Table(self.number, "squares", ("n", "square"), tuple((n, found[n]) for n in self.numbers))


def squares(**more):
    done = []

    def square(number):
        done.append(number)
        return number**2

    study = Repetition(
        name="squares",
        summary="",
        document="",
        legend=(),
        reproductions=(Squares("1", (1, 2)), Squares("2", (2, 3)), Squares("3", (4,))),
        perform=one_by_one(square),
        seeds=lambda _: None,
        **more,
    )
    return study, done


def test_each_job_is_done_once_and_told():
    study, done = squares()
    told = []
    report = study.run(Effort(), 1, lambda *counts: told.append(counts))
    assert done == [1, 2, 3, 4]
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert (report.runs, report.seeds) == (4, None)
    assert [table.rows for table in report.tables] == [((1, 1), (2, 4)), ((2, 4), (3, 9)), ((4, 16),)]


def test_only_what_wanted_tables_need_is_done():
    study, done = squares()
    report = study.run(Effort(tables=("2",)))
    assert done == [2, 3]
    assert [table.number for table in report.tables] == ["2"]
    with pytest.raises(ParameterError, match="table: 4; expected 1 to 3"):
        study.run(Effort(tables=("4",)))


def blank(effort):
    from muster.report.figures.canvas import new_figure

    return new_figure(1.0, 1.0)


FIGURES = (
    StudyFigure(number="4.1", source="market-paper", shows="it", draw=blank, tables=("1",)),
    StudyFigure(number="A.2", source="market-paper", shows="it", draw=blank, tables=("2", "3")),
    StudyFigure(number="own", shows="it", draw=blank),
)


@pytest.mark.parametrize(
    ("effort", "names"),
    [
        (Effort(), ["figure-4.1.png", "figure-A.2.png", "own.png"]),
        (Effort(figures=("all",)), ["figure-4.1.png", "figure-A.2.png", "own.png"]),
        (Effort(tables=("3", "1")), ["figure-4.1.png", "figure-A.2.png"]),
        (Effort(figures=("own", "4.1")), ["figure-4.1.png", "own.png"]),
    ],
)
def test_figures_of_an_effort(tmp_path, effort, names):
    pytest.importorskip("matplotlib")
    study, _ = squares(figures=FIGURES)
    assert [path.name for path in draw_figures(study.figures, effort, tmp_path)] == names
    assert sorted(path.name for path in tmp_path.iterdir()) == names


def test_a_figure_that_there_is_not(tmp_path):
    with pytest.raises(ParameterError, match=r"figure: 4.2; expected all or 4.1 or A.2 or own; did you mean"):
        list(draw_figures(FIGURES, Effort(figures=("4.2",)), tmp_path))


def test_each_figure_needs_its_caption():
    with pytest.raises(ValueError, match=r"^rvo: figures \['A.1'\]; expected those with captions, \['A.15'"):
        captioned("rvo", {"A.1": blank})
