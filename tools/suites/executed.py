"""The map of tests: which sources each test function executes, and how many CPU seconds the function takes.

The map is `tests/executed.json`. It has one line a test file, so that merges conflict where two changes meet alone:

    "tests/core/test_team.py": {"common": [3, 17], "functions": {"test_a": [0.5, [21]], ...}}

Numbers are places in the list `sources`, which only grows until the whole map is made anew. `common` are sources that
every function of the file executes; behind the CPU seconds of a function stand the others.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.suites import function_id

from tools.suites.change import ROOT

MAP = ROOT / "tests" / "executed.json"


@dataclass(frozen=True)
class Executed:
    """What one test function executes: CPU seconds of all its cases, and sources relative to the repository."""

    cpu_s: float
    sources: frozenset[str]


TestMap = dict[str, Executed]  # by the id of the test function


def read_map(path: Path = MAP) -> TestMap:
    """Return the committed map; an empty one where there is none."""
    if not path.exists():
        return {}
    data = json.loads(path.read_text(encoding="utf-8"))
    sources = data["sources"]
    return {
        f"{file}::{name}": Executed(cpu_s, frozenset(sources[i] for i in entry["common"] + others))
        for file, entry in data["files"].items()
        for name, (cpu_s, others) in entry["functions"].items()
    }


def write_map(tests: TestMap, path: Path = MAP) -> None:
    """Write a map; sources keep the numbers that they have in the file."""
    known = json.loads(path.read_text(encoding="utf-8"))["sources"] if path.exists() else []
    used = {source for test in tests.values() for source in test.sources}
    sources = [*known, *sorted(used - set(known))]
    number = {source: i for i, source in enumerate(sources)}
    files: dict[str, dict[str, Executed]] = {}
    for name in sorted(tests):
        file, _, function = name.partition("::")
        files.setdefault(file, {})[function] = tests[name]
    lines = ",\n".join(f"{json.dumps(file)}: {_line(of_file, number)}" for file, of_file in files.items())
    path.write_text(f'{{"sources": {json.dumps(sources, indent=0)},\n"files": {{\n{lines}\n}}}}\n', encoding="utf-8")


def _line(of_file: Mapping[str, Executed], number: Mapping[str, int]) -> str:
    common = frozenset.intersection(*(test.sources for test in of_file.values()))
    functions = {
        name: [test.cpu_s, sorted(number[source] for source in test.sources - common)] for name, test in of_file.items()
    }
    return json.dumps(
        {"common": sorted(number[source] for source in common), "functions": functions}, separators=(",", ":")
    )


def read_records(folder: Path) -> TestMap:
    """Return what the recording plugin wrote in the processes of one run of tests."""
    seconds: dict[str, float] = {}
    sources: dict[str, set[str]] = {}
    for path in sorted(folder.glob("[0-9]*.json")):
        for name, found in json.loads(path.read_text(encoding="utf-8")).items():
            seconds[name] = seconds.get(name, 0.0) + found["cpu_s"]
            sources.setdefault(name, set()).update(found["sources"])
    for path in sorted(folder.glob("child-*.json")):
        found = json.loads(path.read_text(encoding="utf-8"))
        test, _, phase = found["test"].rpartition(" ")
        for name in _tests_of_child(function_id(test), phase == "(setup)", seconds):
            sources[name].update(found["sources"])
    return {name: Executed(_rounded(seconds[name]), frozenset(sources[name])) for name in seconds}


def _tests_of_child(test: str, in_setup: bool, known: Iterable[str]) -> list[str]:
    """Return the tests for which a child process ran: all of the file where a fixture started the process."""
    file = test.partition("::")[0]
    return [name for name in known if name == test or (in_setup and name.startswith(f"{file}::"))]


def merged(old: TestMap, new: TestMap) -> TestMap:
    """Return the old map with the new entries.

    CPU seconds that differ by less than a half stay as they were, so that a map made anew differs where the tests do.
    """
    return old | {name: Executed(_settled(old.get(name), test), test.sources) for name, test in new.items()}


def _settled(old: Executed | None, new: Executed) -> float:
    return old.cpu_s if old and old.cpu_s / 1.5 <= new.cpu_s <= old.cpu_s * 1.5 else new.cpu_s


def _rounded(seconds: float) -> float:
    """Return CPU seconds with one significant digit, and at least a hundredth."""
    return max(float(f"{seconds:.1g}"), 0.01)
