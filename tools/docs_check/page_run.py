"""Runs one page: its blocks share a folder, its Python blocks a namespace."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
import traceback
import types
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import yaml

from tools.docs_check import outcomes as o
from tools.docs_check.commands import (
    COLUMNS,
    README_COLUMNS,
    ROOT,
    Ran,
    command_lines,
    look_up,
    run_command,
    without_remark,
)
from tools.docs_check.consoles import compare_console, elided_lines
from tools.docs_check.measured import load, numbers, unknown_numbers
from tools.docs_check.outcomes import Outcome
from tools.docs_check.pages import Item, read_page
from tools.docs_check.pictures import compare, compare_stored
from tools.docs_check.rows import Due, Row, Shown, read_rows, wrong_figures


def check_page(path: Path, due: Due | None = None) -> list[Outcome]:
    """What became of everything on a page; `due` says which rows are run, all short ones unless given."""
    name = str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else path.name
    try:
        items = read_page(path)
    except ValueError as error:
        return [Outcome(o.FAILED, "page", name, str(error))]
    with TemporaryDirectory(prefix="docs-check-") as folder:
        run = _PageRun(path, name, Path(folder), due or Due())
        try:
            return [outcome for item in items for outcome in run.check(item)]
        finally:
            run.close()


def timed_check(path: Path, due: Due) -> tuple[float, list[Outcome]]:
    """How many seconds that took, and what it found."""
    begin = time.monotonic()
    outcomes = check_page(path, due)
    return time.monotonic() - begin, outcomes


class _PageRun:
    def __init__(self, path: Path, name: str, folder: Path, due: Due) -> None:
        self._path, self._name, self._folder, self._due = path, name, folder, due
        self._columns = README_COLUMNS if path.name == "README.md" else COLUMNS
        module = types.ModuleType("__docs__")  # whose name dataclasses look up
        sys.modules[module.__name__] = module
        self._names: dict[str, Any] = module.__dict__
        self._printed = ""
        self._servers: list[subprocess.Popen[str]] = []
        self._of_rows: dict[str, Ran] = {}

    def check(self, item: Item) -> Iterator[Outcome]:
        """What became of an item."""
        where = f"{self._name}:{item.line}"
        skip = item.marker("skip")
        if skip and skip.pattern is None:
            yield Outcome(o.SKIPPED, item.kind, where, skip.rest)
            return
        kinds = {"sh": self._shell, "console": self._console, "python": self._python, "yaml": self._yaml,
                 "json": self._json, "text": self._text}  # fmt: skip
        act = {"setup": self._setup, "background": self._background, "region": self._region, "picture": self._picture,
               "rows": self._rows}  # fmt: skip
        try:
            if item.kind == "block" and item.language not in kinds:
                yield Outcome(o.FAILED, "block", where, f"a block of language {item.language!r} needs a marker")
            else:
                yield from (kinds[item.language] if item.kind == "block" else act[item.kind])(item, where)
        except Exception:  # a document can fail in any way, and the others are still to be checked
            yield Outcome(o.FAILED, item.kind, where, traceback.format_exc(limit=-3))

    def close(self) -> None:
        """End the servers of the page."""
        for server in self._servers:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(server.pid, signal.SIGINT)
            try:
                server.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(server.pid, signal.SIGKILL)

    def _setup(self, item: Item, where: str) -> Iterator[Outcome]:
        for command in command_lines(item.text):
            ran = run_command(command, self._folder, columns=self._columns)
            if ran.code:
                yield Outcome(o.FAILED, "setup", where, f"{command}: exit code {ran.code}\n{ran.out}{ran.err}")

    def _background(self, item: Item, where: str) -> Iterator[Outcome]:
        """Start a server; it runs once it has printed its address."""
        environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
        environment["XDG_DATA_HOME"] = str(self._folder / ".data")
        server = subprocess.Popen(
            ["bash", "-c", f"exec {item.text} 2>&1"],
            cwd=self._folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        self._servers.append(server)
        assert server.stdout is not None
        said = []
        for line in server.stdout:
            said.append(line)
            if "http://" in line:
                return
        yield Outcome(o.FAILED, "background", where, f"{item.text} ended: {''.join(said)}")

    def _shell(self, item: Item, where: str) -> Iterator[Outcome]:
        ran_any = False
        for command in command_lines(item.text):
            outcome = self._command(item, command, where)
            ran_any |= outcome.status == o.RUN
            yield outcome
        if ran_any:
            yield Outcome(o.RUN, "block", where)

    def _command(self, item: Item, command: str, where: str) -> Outcome:
        for marker in item.markers:
            if marker.pattern is None or re.search(marker.pattern, command):
                if marker.word == "skip":
                    return Outcome(o.SKIPPED, "command", where, marker.rest)
                if marker.word == "long":
                    return self._stored(marker.rest, command, where)
        wrong = look_up(command)
        if wrong is not None:
            return Outcome(o.FAILED if wrong else o.LOOKED_UP, "command", where, wrong)
        ran = run_command(command, self._folder, columns=self._columns)
        if ran.code:
            return Outcome(
                o.FAILED, "command", where, f"{command}\nexit code {ran.code}\n{ran.out[-2000:]}{ran.err[-2000:]}"
            )
        if elided := self._elided(ran.out):
            return Outcome(o.FAILED, "command", where, f"{command}\nfigures left out for want of width: {elided[0]}")
        return Outcome(o.RUN, "command", where)

    def _stored(self, name: str, command: str, where: str) -> Outcome:
        stored = load(name)
        command = without_remark(command)
        if stored is None:
            return Outcome(o.FAILED, "command", where, f"docs/measured/{name}.json: not there; `make docs-check-long`")
        if stored["command"] != command:
            detail = f"docs/measured/{name}.json is of `{stored['command']}`, the page says `{command}`"
            return Outcome(o.FAILED, "command", where, detail)
        return Outcome(o.MEASURED, "command", where)

    def _console(self, item: Item, where: str) -> Iterator[Outcome]:
        yield Outcome(o.RUN, "block", where)
        masks = item.marker("mask") is not None
        for part in re.split(r"^\$ ", item.text, flags=re.MULTILINE)[1:]:
            command, *shown = part.splitlines()
            ran = run_command(command, self._folder, columns=self._columns)
            differs = compare_console(shown, ran, masks=masks)
            yield Outcome(
                o.FAILED if differs else o.COMPARED, "output", where, f"$ {command}\n{differs}" if differs else ""
            )

    def _python(self, item: Item, where: str) -> Iterator[Outcome]:
        out = io.StringIO()
        before = Path.cwd()
        try:
            os.chdir(self._folder)
            with contextlib.redirect_stdout(out):
                exec(compile(item.text, where, "exec"), self._names)  # noqa: S102
        finally:
            os.chdir(before)
            self._printed = out.getvalue()
        elided = self._elided(self._printed)
        detail = f"figures left out for want of width: {elided[0]}" if elided else ""
        yield Outcome(o.FAILED if elided else o.RUN, "block", where, detail)

    def _elided(self, printed: str) -> list[str]:
        """Return the rows that leave figures out in a newcomer's terminal, which the README is read in."""
        return elided_lines(printed) if self._columns == README_COLUMNS else []

    def _text(self, item: Item, where: str) -> Iterator[Outcome]:
        if item.marker("output") is None:
            yield Outcome(o.FAILED, "block", where, "a block of text needs a marker: output, or skip with its reason")
            return
        same = item.text.strip() == self._printed.strip()
        yield Outcome(o.COMPARED if same else o.FAILED, "output", where, "" if same else f"printed:\n{self._printed}")

    def _json(self, item: Item, where: str) -> Iterator[Outcome]:
        json.loads(item.text)
        yield Outcome(o.PARSED, "block", where)

    def _yaml(self, item: Item, where: str) -> Iterator[Outcome]:
        from muster.mission.reading.yaml_reader import parse_yaml

        given, extra = yaml.safe_load(item.text), item.marker("with")
        text = item.text
        needed = {"schema": "muster/1", "robots": [{"id": "r_0", "position": [1, 1]}], "tasks": []}
        needed |= yaml.safe_load(extra.rest) if extra else {}
        missing = {key: value for key, value in needed.items() if key not in given}
        if missing and ("schema" not in given or extra):
            text += "\n" + yaml.safe_dump(missing)
        mission = parse_yaml(text, Path(where))
        kept = item.marker("as")
        (self._folder / (kept.rest if kept else f"{mission.name}.yaml")).write_text(text, encoding="utf-8")
        yield Outcome(o.PARSED, "block", where)

    def _picture(self, item: Item, where: str) -> Iterator[Outcome]:
        made = item.marker("made")
        if made is None:
            yield Outcome(
                o.FAILED, "picture", where, f"{item.text}: no command makes it; <!-- docs-check: made by COMMAND -->"
            )
            return
        command, long = made.rest.removeprefix("by ").strip(), item.marker("long") is not None
        if long:
            differs = compare_stored(self._path, item.text, command)
        else:
            differs = compare(self._path, item.text, command, self._folder)
        status = o.FAILED if differs else o.MEASURED if long else o.COMPARED
        yield Outcome(status, "picture", where, f"{item.text}: {differs}" if differs else "")

    def _region(self, item: Item, where: str) -> Iterator[Outcome]:
        kind, _, source = item.markers[0].rest.partition(" ")
        if kind == "by":
            ran = run_command(source, self._folder, columns=self._columns)
            if ran.code:
                yield Outcome(o.FAILED, "numbers", where, f"{source}: exit code {ran.code}\n{ran.err}")
                return
            output, status = ran.out, o.COMPARED
        else:
            output, status = _stored_output(source.split()), o.MEASURED
        unknown = unknown_numbers(item.text, output)
        if unknown:
            yield Outcome(o.FAILED, "numbers", where, f"not printed by {source}: {', '.join(unknown)}")
        yield from (Outcome(status, "number", where) for _ in range(len(numbers(item.text)) - len(unknown)))

    def _rows(self, item: Item, where: str) -> Iterator[Outcome]:
        for row in read_rows(item.text, item.line):
            yield from self._row(row, f"{self._name}:{row.line}")

    def _row(self, row: Row, where: str) -> Iterator[Outcome]:
        problems = list(row.problems())
        yield from (Outcome(o.FAILED, "row", where, problem) for problem in problems)
        if problems or not row.commands:
            return
        if not self._due.has(row):
            yield Outcome(o.LEFT, "row", where)
            return
        wrong = [found for shown in row.commands if (found := wrong_figures(shown, self._ran_once(shown)))]
        yield from (Outcome(o.FAILED, "row", where, found) for found in wrong)
        if not wrong:
            yield Outcome(o.COMPARED, "row", where)

    def _ran_once(self, shown: Shown) -> Ran:
        """Run a command of a row, or return what it printed for a row before."""
        if shown.command not in self._of_rows:
            self._of_rows[shown.command] = run_command(shown.command, self._folder, shown.limit_s)
        return self._of_rows[shown.command]


def _stored_output(names: list[str]) -> str:
    lines: list[str] = []
    for name in names:
        stored = load(name)
        if stored is None:
            raise LookupError(f"docs/measured/{name}.json: not there; `make docs-check-long`")
        lines += stored["output"]
    return "\n".join(lines)
