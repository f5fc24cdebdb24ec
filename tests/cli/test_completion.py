"""What shells complete: by the scripts that are printed, in a real bash, and by what the command answers them."""

import os
import re
import shutil
import subprocess
import sys

import pytest
from click.shell_completion import get_completion_class

from muster.cli.main import muster as root
from muster.cli.main import verbs
from muster.library import missions

VERBS = tuple(verbs())

pytestmark = pytest.mark.usefixtures("folder")


def completed(arguments, typed):
    kind = get_completion_class("bash")
    found = kind(root, {}, "muster", "_MUSTER_COMPLETE").get_completions(arguments, typed)
    return [(item.type, item.value) for item in found]


def test_verbs():
    assert [value for _, value in completed([], "s")] == [verb for verb in VERBS if verb[0] == "s"]


def test_options():
    assert ("plain", "--allocator") in completed(["solve", "yard.yaml"], "--al")


def test_missions_by_name_and_files():
    shipped = [m.name for m in missions() if m.name.startswith("31T")]
    assert len(shipped) > 1
    assert completed(["solve"], "31T") == [("file", "31T"), *(("plain", name) for name in shipped)]


def test_paths_have_no_missions_in_them():
    assert completed(["solve"], "plans/") == [("file", "plans/")]


SHELLS = ("bash", "zsh", "fish")


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_for_each_shell(shell, muster):
    code, out, err = muster("completion", shell)
    assert (code, err) == (0, "")
    assert f"_MUSTER_COMPLETE={shell}_complete" in out


@pytest.mark.parametrize("shell", [shell for shell in SHELLS if shutil.which(shell)])
def test_each_shell_that_is_here_reads_its_script(shell, muster, tmp_path):
    script = tmp_path / "script"
    script.write_text(muster("completion", shell)[1], encoding="utf-8")
    read = subprocess.run([shell, "-n", script], capture_output=True, encoding="utf-8", check=False)
    assert (read.returncode, read.stdout, read.stderr) == (0, "", "")


def test_zsh_completes_by_the_function_that_it_registers(muster):
    script = muster("completion", "zsh")[1]
    assert script.startswith("#compdef muster\n")
    assert "\n_muster_completion() {\n" in script
    assert "compdef _muster_completion muster\n" in script


def test_fish_completes_by_the_function_that_it_registers(muster):
    script = muster("completion", "fish")[1]
    assert "function _muster_completion;" in script
    assert 'complete --no-files --command muster --arguments "(_muster_completion)";' in script
    words = re.findall(r"\w+", re.sub(r'"[^"]*"', "", script))
    assert sum(words.count(word) for word in ("function", "for", "if")) == words.count("end") + words.count("else")


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("shell", "words", "at", "first"),
    [
        ("zsh", "muster solve 31T-6R50", "2", ["file", "31T-6R50", "_"]),
        ("fish", "muster solve ", "31T-6R50", ["file,31T-6R50"]),
    ],
)
def test_what_zsh_and_fish_are_answered(shell, words, at, first):
    asked = {"_MUSTER_COMPLETE": f"{shell}_complete", "COMP_WORDS": words, "COMP_CWORD": at}
    ended = subprocess.run(
        [sys.executable, "-m", "muster.cli"], env=os.environ | asked, capture_output=True, encoding="utf-8", check=True
    )
    lines = ended.stdout.splitlines()
    assert lines[: len(first)] == first
    assert any("31T-6R50-as-run" in line for line in lines)
    assert ended.stderr == ""


def test_another_shell_is_refused(muster):
    code, out, err = muster("completion", "csh")
    assert (code, out) == (2, "")
    assert "'csh' is not one of 'bash', 'zsh', 'fish'" in err


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_bash_completes_names_and_files(tmp_path, muster):
    script = muster("completion", "bash")[1]
    (tmp_path / "31T-of-mine.yaml").touch()
    words = "COMP_WORDS=(muster solve 31T); COMP_CWORD=2; compopt() { :; }\n"  # which only a shell at a terminal has
    words += f'muster() {{ "{sys.executable}" -m muster.cli; }}\n'
    asked = f'{script}\n{words}_muster_completion muster solve 31T\nprintf "%s\\n" "${{COMPREPLY[@]}}"'
    ended = subprocess.run(["bash", "-c", asked], capture_output=True, encoding="utf-8", check=True)
    assert "31T-of-mine.yaml" in ended.stdout.splitlines()
    assert "31T-6R50" in ended.stdout.splitlines()
