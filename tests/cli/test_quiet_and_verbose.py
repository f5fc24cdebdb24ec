"""-q and -v, which every verb has: they change what is said on standard error, never standard output."""

from pathlib import Path

import pytest

from muster.cli.main import verbs

VERBS = tuple(verbs())

pytestmark = pytest.mark.usefixtures("folder")

READ = "read yard.yaml: mission yard, 2 robots, 4 tasks\n"
READ_BOTH = f"{READ}read plan.json: plan, 2 routes, 3 tasks\n"
CALLS = [
    (["check", "yard.yaml"], READ),
    (["verify", "yard.yaml", "plan.json"], READ_BOTH),
    (["explain", "yard.yaml", "plan.json"], READ_BOTH),
    (["explain", "yard.yaml", "plan.json", "--task", "open"], READ_BOTH),
    (["missions"], "missions in "),
    (["init", "new"], "wrote new.yaml: a template, 19 lines\n"),
    (["init", "new", "--from", "6T-2R"], "wrote new.yaml: a copy of 6T-2R, "),
]


DB = ("info", "backup", "restore", "prune")


@pytest.mark.parametrize("verb", [*((verb,) for verb in VERBS if verb != "db"), *(("db", what) for what in DB)])
def test_every_verb_has_them(verb, muster):
    _, out, _ = muster(*verb, "--help")
    assert "-q, --quiet" in out
    assert "-v, --verbose" in out


@pytest.mark.parametrize(("arguments", "said"), CALLS)
def test_verbose_says_what_was_read_or_written(arguments, said, plan, muster):
    code, out, err = muster(*arguments)
    assert said not in err
    Path("new.yaml").unlink(missing_ok=True)
    louder = muster(*arguments, "-v")
    assert louder[:2] == (code, out)
    assert said in louder[2]


@pytest.mark.parametrize(("arguments", "_"), CALLS)
def test_quiet_says_nothing(arguments, _, plan, muster):
    code, _, err = muster(*arguments, "-q")
    assert (code, err) == (3 if arguments[0] == "check" else 0, "")  # a task of it can never be done


@pytest.mark.parametrize("verb", ["check", "verify", "explain"])
def test_quiet_does_not_hide_errors(verb, plan, muster):
    arguments = [verb, "none.yaml", *([plan] if verb != "check" else []), "-q"]
    assert muster(*arguments) == (2, "", "none.yaml: No such file or directory; expected a file to read\n")


def test_a_plan_that_names_another_mission_is_refused(plan, muster):
    text = Path("yard.yaml").read_text(encoding="utf-8")
    Path("other.yaml").write_text(text.replace("name: yard", "name: harbour"), encoding="utf-8")
    code, out, err = muster("verify", "other.yaml", plan)
    assert (code, err) == (1, "")
    assert "the plan is of yard; expected harbour, or no name" in " ".join(out.split())
    code, out, err = muster("explain", "other.yaml", plan)
    assert (code, out) == (2, "")
    assert "mission: the plan is of yard; expected" in err


@pytest.mark.parametrize("verb", ["verify", "explain"])
def test_a_renamed_file_and_a_plan_that_names_no_mission(verb, plan, muster):
    Path("yard.yaml").rename("renamed.yaml")
    assert muster(verb, "renamed.yaml", plan)[2] == ""
    plan.write_text(plan.read_text(encoding="utf-8").replace('"mission": "yard"', '"mission": null'), encoding="utf-8")
    assert muster(verb, "renamed.yaml", plan)[2] == ""


@pytest.mark.long
def test_verbose_says_why_a_bound_holds(muster):
    args = ("solve", "eil51-5", "--objective", "max", "--iterations", 20, "--bound")
    code, out, err = muster(*args, "-v")
    assert code == 0
    assert "lower bound       112.07 m  (gap " in out
    assert err.splitlines()[-1].startswith("lower bound: the farthest task: some robot must get to it")
    assert muster(*args)[2] == ""


@pytest.mark.long
def test_a_bound_that_was_asked_for_and_is_not_there_is_no_surprise(muster):
    args = ("solve", "31T-3R44-3R26", "--allocator", "greedy", "--bound")
    code, out, err = muster(*args)
    assert (code, "lower bound" in out) == (0, False)
    assert err == "no lower bound: quick bounds are of plans that do all tasks, and this one leaves some out\n"
    assert muster(*args, "-q")[2] == ""
