"""Pictures: made again by the command beside them, and compared by the data in their description."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tools.docs_check import measured
from tools.docs_check.commands import ROOT, run_command

_STORE = "pictures"


def compare(page: Path, target: str, command: str, scratch: Path) -> str:
    """What differs between a picture of a page and what its command makes; "" if nothing does."""
    kept = (page.parent / target).resolve()
    made = _make(kept, command, scratch)
    if isinstance(made, str):
        return made
    then, now = _description(kept), _description(made)
    if then is None or now is None:
        return "no description in the committed picture" if then is None else "no description in the picture made again"
    return "" if then == now else _difference(json.loads(then), json.loads(now))


def compare_stored(page: Path, target: str, command: str) -> str:
    """What differs between a picture of a page and what `--long` stored of it; "" if nothing does."""
    kept = (page.parent / target).resolve()
    entry = (measured.load(_STORE) or {}).get(kept.name)
    if entry is None:
        return "never made by --long"
    if entry["command"] != command:
        return f"stored with another command: {entry['command']}"
    return "" if entry["sha256"] == measured.digest(kept) else "not the picture that --long made"


def make_stored(page: Path, target: str, command: str, scratch: Path) -> str:
    """Make a picture, put it on its page, and store its command, commit and digest; returns a remark.

    Raises
    ------
    RuntimeError
        if the command does not make it.
    """
    kept = (page.parent / target).resolve()
    made = _make(kept, command, scratch, limit_s=3600.0)
    if isinstance(made, str):
        raise RuntimeError(f"{target}: {made}")
    kept.write_bytes(made.read_bytes())
    entry = {"command": command, "commit": measured.commit(), "sha256": measured.digest(kept)}
    measured.store(_STORE, {**(measured.load(_STORE) or {}), kept.name: entry})
    return f"{kept.name}: made"


def _make(kept: Path, command: str, scratch: Path, limit_s: float = 180.0) -> Path | str:
    relative = kept.relative_to(ROOT)
    (scratch / relative.parent).mkdir(parents=True, exist_ok=True)
    ran = run_command(command, scratch, limit_s)
    if ran.code != 0:
        return f"{command}: exit code {ran.code}\n{ran.err}"
    made = next((path for path in (scratch / relative, scratch / kept.name) if path.is_file()), None)
    return made or f"{command} writes no {relative}"


def _description(path: Path) -> str | None:
    from PIL import Image

    with Image.open(path) as image:
        return image.info.get("Description")


def _difference(then: list[dict[str, Any]], now: list[dict[str, Any]]) -> str:
    if len(then) != len(now):
        return f"{len(then)} axes, now {len(now)}"
    found = []
    for number, (was, is_now) in enumerate(zip(then, now, strict=True), start=1):
        words = [
            f"words {old!r}, now {new!r}" for old, new in zip(was["words"], is_now["words"], strict=False) if old != new
        ]
        found += [f"axes {number}: {what}" for what in words[:5]]
        found += [f"axes {number}: other {kind}" for kind in was if kind != "words" and was[kind] != is_now[kind]]
    return "\n".join(found) or "other words"
