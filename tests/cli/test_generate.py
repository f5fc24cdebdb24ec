"""`muster generate`: the files, and what it says."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from muster.generation.generate import generate
from muster.generation.generator import Generator
from muster.generation.registry import GENERATORS

pytestmark = pytest.mark.usefixtures("folder")


def test_files_are_those_of_their_seeds(muster):
    code, out, err = muster(
        "generate", "uniform", "--tasks", 4, "--robots", 2, "--count", 3, "--seed", 8, "-o", "made/u"
    )
    assert code == 0
    assert out.split() == [str(Path("made/u") / f"uniform-4T-2R-{seed}.yaml") for seed in (8, 9, 10)]
    assert err == "next: muster compare made/u --allocators search,greedy,auction\n"
    code, single, err = muster("generate", "uniform", "--tasks", 4, "--robots", 2, "--seed", 9, "-q")
    assert (code, err) == (0, "")
    assert muster("generate", "-q", "uniform", "--tasks", 4, "-o", "quiet")[2] == ""
    assert single == Path("made/u/uniform-4T-2R-9.yaml").read_text(encoding="utf-8")
    assert muster("solve", "made/u/uniform-4T-2R-9.yaml", "-a", "greedy", "-q")[0] == 0


def test_a_file_that_is_another_is_left_alone(muster):
    assert muster("generate", "mixed", "-o", "m.yaml")[0] == 0
    before = Path("m.yaml").read_bytes()
    assert muster("generate", "mixed", "-o", "m.yaml")[0] == 0
    code, out, err = muster("generate", "mixed", "--seed", 1, "-o", "m.yaml")
    assert (code, out, err) == (2, "", "m.yaml: exists, with another content; expected the name of a new file\n")
    assert Path("m.yaml").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("unifrom",), "did you mean 'uniform'?"),
        ((), "FAMILY missing"),
        (("uniform", "--taks", 3), "No such option '--taks'"),
        (("uniform", "--tasks", 0), "uniform: tasks: 0, expected a whole number of at least 1"),
        (("uniform", "--count", 2), "--count: 2 without -o; expected -o FOLDER"),
        (("uniform", "--count", 2, "-o", "m.yaml"), "--output: m.yaml; expected a folder for 2 missions"),
        (("uniform", "-o", "m.json"), "--output: m.json; expected a folder, or a file .yaml"),
        (("--format", "json", "uniform"), "--format without --list; missions are written as YAML"),
        (("uniform", "-o", "none/m.yaml"), "none/m.yaml: No such file or directory"),
    ],
)
def test_what_is_wrong_is_told(arguments, said, muster):
    code, out, err = muster("generate", *arguments)
    assert (code, out) == (2, "")
    assert said in err


@pytest.mark.parametrize("family", GENERATORS.shipped)
def test_a_family_has_help(family, muster):
    code, out, err = muster("generate", family, "--help")
    assert (code, err) == (0, "")
    for name in GENERATORS[family].parameters.__dataclass_fields__:
        assert f"--{name.replace('_', '-')}" in out
    assert "Source: " in out


@dataclass(frozen=True, kw_only=True)
class Odd:
    """Parameters of which some are no options."""

    tasks: int = 3
    sides_m: tuple[float, ...] = (4.0, 5.0)
    words: list[str] = field(default_factory=list)
    most: float | None = None


def test_parameters_that_no_option_can_be_are_for_python_alone(muster):
    def make(given, seed):
        return generate("uniform", 1, seed, tasks=given.tasks)[0]

    GENERATORS.add("odd", Generator(name="odd", summary="odd", source="a test", parameters=Odd, make=make))
    try:
        code, out, _ = muster("generate", "odd", "--help")
        assert code == 0
        assert "--tasks" in out
        assert "--sides-m" not in out
        assert muster("generate", "odd", "--tasks", 2)[1].count("position") == 2 + 5
        assert muster("generate", "--list")[0] == 0
    finally:
        GENERATORS.remove("odd")


def test_families_are_listed(muster):
    assert [row["family"] for row in json.loads(muster("generate", "--list", "--format", "json")[1])] == list(
        GENERATORS
    )
    code, out, _ = muster("generate", "--list")
    assert code == 0
    assert all(family in out for family in GENERATORS)


def test_flags_and_drawn_numbers(muster):
    assert "return_to_start: true" in muster("generate", "uniform", "--return-to-start")[1]
    assert "return_to_start" not in muster("generate", "uniform", "--no-return-to-start")[1]
    assert muster("generate", "windows", "--tasks", 5)[1].count("window_s") == 5
