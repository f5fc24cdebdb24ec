"""Measurements that take more than a minute, stored as docs/measured/NAME.json with their command and commit."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import time
from pathlib import Path
from typing import Any

from tools.docs_check.commands import ROOT, run_command

FOLDER = ROOT / "docs" / "measured"
_HOURS = 6 * 3600.0
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*\.\d+(?![\w.]*\d)")


def numbers(text: str) -> list[str]:
    """The numbers of a text that have a decimal point, without separators of thousands."""
    return [found.replace(",", "").lstrip("+") for found in _NUMBER.findall(text)]


def unknown_numbers(text: str, output: str) -> list[str]:
    """The numbers of a text that an output does not have, not even with more digits."""
    known = set(numbers(output))
    longer = sorted(known)
    return [number for number in numbers(text) if number not in known and not _rounds_to(number, longer)]


def _rounds_to(number: str, longer: list[str]) -> bool:
    digits = len(number.partition(".")[2])
    return any(len(k.partition(".")[2]) > digits and f"{float(k):.{digits}f}" == number for k in longer)


def load(name: str, folder: Path = FOLDER) -> dict[str, Any] | None:
    """A stored measurement; None if there is none."""
    path = folder / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def measure(name: str, command: str, scratch: Path, folder: Path = FOLDER) -> str:
    """Run a command and store the Markdown that it writes, or what it prints if it writes none; returns a remark.

    Raises
    ------
    RuntimeError
        if the command fails.
    """
    (scratch / "docs").mkdir(exist_ok=True)
    begin = time.monotonic()
    ran = run_command(command, scratch, _HOURS)
    if ran.code != 0:
        raise RuntimeError(f"{command}: exit code {ran.code}\n{ran.err}")
    written = "".join(path.read_text(encoding="utf-8") for path in sorted(scratch.rglob("*.md")))
    stored = {
        "command": command,
        "commit": commit(),
        "seconds": round(time.monotonic() - begin),
        "output": (written or ran.out).splitlines(),
    }
    store(name, stored, folder)
    return f"{name}: {stored['seconds']} s"


def store(name: str, data: dict[str, Any], folder: Path = FOLDER) -> None:
    """Write a measurement."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def commit() -> str:
    """The commit that is checked out, with `+` if files differ from it."""
    head = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    dirty = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True, check=True)
    return head.stdout.strip() + ("+" if dirty.stdout.strip() else "")


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
