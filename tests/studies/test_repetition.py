"""Studies by their tables: which runs are done, how often, and what comes of them."""

from dataclasses import dataclass

import pytest

from muster.mission.errors import ParameterError
from muster_studies.effort import Effort
from muster_studies.registry import Illustrated
from muster_studies.repetition import IllustratedRepetition, Repetition, one_by_one
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

    kind = IllustratedRepetition if more else Repetition
    study = kind(
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


def test_pictures_of_wanted_tables(tmp_path):
    study, _ = squares(pictures=lambda effort, folder, numbers: [folder / number for number in numbers])
    assert isinstance(study, Illustrated)
    assert study.draw(Effort(tables=("3", "1")), tmp_path) == [tmp_path / "3", tmp_path / "1"]
    assert not isinstance(squares()[0], Illustrated)
