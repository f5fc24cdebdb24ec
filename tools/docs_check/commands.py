"""Shell commands of a page: what is run, what is looked up instead, and what they print."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COLUMNS, README_COLUMNS = 120, 80
"""The width of terminals for which pages show output; a newcomer's is that of the README."""
LIMIT_S = 180.0
"""A command that takes longer fails. It is generous: on a busy machine a command of 20 s may take two minutes."""


@dataclass(frozen=True)
class Ran:
    """A command's exit code and output."""

    code: int
    out: str
    err: str


def command_lines(text: str) -> list[str]:
    """The commands of a shell block: lines that a backslash continues are joined, remarks left out."""
    joined = text.replace("\\\n", " ")
    return [line.strip() for line in joined.splitlines() if line.strip() and not line.lstrip().startswith("#")]


def without_remark(command: str) -> str:
    """A command without the remark behind it."""
    return re.sub(r"\s+#.*", "", command)


def run_command(command: str, folder: Path, limit_s: float = LIMIT_S, columns: int = COLUMNS) -> Ran:
    """Run a command in a folder, with the environment's programs first on the path and without a terminal."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {
        **os.environ,
        "PATH": path,
        "COLUMNS": str(columns),
        "XDG_DATA_HOME": str(folder / ".data"),
        "ROOT": str(ROOT),
    }
    variables.pop("FORCE_COLOR", None)
    process = subprocess.Popen(
        ["bash", "-c", command],
        cwd=folder,
        env=variables,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        out, err = process.communicate(timeout=limit_s)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # with what it has started, which holds the pipes open
        out, _ = process.communicate()
        return Ran(124, out, f"took more than {limit_s:.0f} s: mark it `long`")
    return Ran(process.returncode, out, err)


def look_up(command: str) -> str | None:
    """Of a command that is never run here: "" if what it names is there, else what is wrong; None: it is to be run."""
    words = command.split("#")[0].split()
    if words[0] == "make":
        missing = [word for word in words[1:] if "=" not in word and word not in _targets()]
        return f"no such target of make: {', '.join(missing)}" if missing else ""
    if words[:2] == ["pip", "install"]:
        return _unknown_extras(command)
    if words[0].startswith((".ci/", "tools/")):
        return "" if (ROOT / words[0]).is_file() else f"no such file: {words[0]}"
    return None


@cache
def _targets() -> frozenset[str]:
    return frozenset(re.findall(r"^([a-z][a-z-]*):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))


def _unknown_extras(command: str) -> str:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = re.search(r"(?:muster-robotics|\.)\[([a-z0-9,]+)\]", command)
    missing = set(wanted[1].split(",")) - set(project["optional-dependencies"]) if wanted else set()
    return f"no such extra: {', '.join(sorted(missing))}" if missing else ""
