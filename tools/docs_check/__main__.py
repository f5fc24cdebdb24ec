"""`python -m tools.docs_check [--long] [PAGE or NAME...]`."""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

from tools.docs_check import measured, pictures
from tools.docs_check.commands import ROOT, command_lines, without_remark
from tools.docs_check.outcomes import FAILED, Outcome, summary
from tools.docs_check.page_run import timed_check
from tools.docs_check.pages import read_page
from tools.docs_check.rows import Due

_SLOWEST = 10  # pages that are named


def pages() -> list[Path]:
    """All pages that are checked."""
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def has_rows(page: Path) -> bool:
    """Return whether a page has rows with commands, of which each turn runs a tenth."""
    return "<!-- docs-check: rows -->" in page.read_text(encoding="utf-8")


def check(chosen: list[Path], due: Due) -> int:
    """Check pages, two at a time, each in a process of its own; returns the exit code."""
    begin = time.monotonic()
    with ProcessPoolExecutor(2, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        found = list(pool.map(partial(timed_check, due=due), chosen))
    outcomes: list[Outcome] = [outcome for _, of_page in found for outcome in of_page]
    print("\n".join(summary(outcomes)))
    print(f"{len(chosen)} pages, {time.monotonic() - begin:.0f} s")
    slowest = sorted(zip((seconds for seconds, _ in found), chosen, strict=True), reverse=True)[:_SLOWEST]
    print("slowest: " + ", ".join(f"{page.name} {seconds:.0f} s" for seconds, page in slowest))
    return int(any(outcome.status == FAILED for outcome in outcomes))


def make_long(names: list[str]) -> int:
    """Make what takes more than a minute, or of it what is named, and store it; returns the exit code."""
    failed = False
    for name, make in _long_work():
        if not names or name in names:
            with TemporaryDirectory() as scratch:
                try:
                    print(make(Path(scratch)), flush=True)
                except RuntimeError as error:
                    failed = True
                    print(f"FAILED {name}: {error}", flush=True)
    return int(failed)


def _long_work() -> Iterator[tuple[str, Callable[[Path], str]]]:
    """The name of each measurement and picture that takes long, and what makes it in a folder."""
    for page in pages():
        for item in read_page(page):
            made = item.marker("made")
            if item.kind == "picture" and made and item.marker("long"):
                command = made.rest.removeprefix("by ").strip()
                yield Path(item.text).name, partial(pictures.make_stored, page, item.text, command)
            for marker in item.markers if item.kind == "block" else ():
                if marker.word == "long":
                    for command in command_lines(item.text):
                        if marker.pattern is None or re.search(marker.pattern, command):
                            yield marker.rest, partial(measured.measure, marker.rest, without_remark(command))


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tools.docs_check", description="Check what the documents show.")
    parser.add_argument("names", nargs="*", help="pages; with --long names of measurements and pictures")
    parser.add_argument("--long", action="store_true", help="make what takes more than a minute, and store it")
    parser.add_argument("--turn", type=int, help="run a tenth of the rows, long ones too")
    parser.add_argument("--since", metavar="COMMIT", help="with --turn: and the rows that a change since then touches")
    parser.add_argument("--every", action="store_true", help="run all rows, long ones too")
    given = parser.parse_args()
    if given.long:
        return make_long(given.names)
    due = Due.since(given.turn, given.since) if given.since else Due(given.turn, every=given.every)
    return check([Path(name).resolve() for name in given.names] or pages(), due)


if __name__ == "__main__":
    sys.exit(main())
