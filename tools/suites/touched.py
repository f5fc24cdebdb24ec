"""Which tests a change touches: those that executed its sources by the map, and those of a folder otherwise."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from tools.suites.executed import ROOT, TestMap

# For files that no Python process executes: the first pattern that matches a file names the tests of it, and the
# rooms whose Python reads it. The patterns are those of `re.match`.
FOLDERS = [
    (
        r"src/muster/core/.*\.(cpp|hpp)$",
        ["tests/core/", "tests/allocation/", "tests/traffic/", "tests/motion/", "tests/simulation/"],
    ),
    (r"src/muster/core/.*\.pyi$", ["tests/core/test_stub.py"]),
    (r"src/muster/report/page/", ["tests/report/page/"]),
    (r"src/muster_control/pages/", ["tests/muster_control/pages/", "tests/muster_control/browser/"]),
    (r"src/muster_control/store/", ["tests/muster_control/store/"]),
    (r"src/muster/library/", ["tests/library/", "tests/conformance/test_allocators.py"]),
    (r"src/muster/mission/", ["tests/mission/"]),
    (r"src/muster_studies/", ["tests/muster_studies/"]),
    (r"src/muster/", ["tests/test_python_api.py"]),
    (r"examples/", ["tests/examples/"]),
    (r"deploy/", ["tests/deploy/"]),
    (r"man/", ["tests/cli/test_man.py"]),
    (r"(docs/|README\.md|CONTRIBUTING\.md|CHANGELOG\.md)", ["tests/docs/", "tests/library/test_documents.py"]),
    (r"(tools/|Makefile|\.ci/|\.github/)", ["tests/tools/"]),
    (r"(pyproject\.toml|CMakeLists\.txt)", ["tests/tools/", "tests/core/", "tests/cli/test_doctor.py"]),
    (r"\.[a-z-]+$|[A-Z_]+(\.[a-z]+)?$|\.github/", []),  # rules of formatters, licence, and the like
]
SERVICES = (  # folders of which the tests start servers, browsers, a ROS master or other processes beside them
    "tests/muster_robots/ros1/",
    "tests/muster_robots/ros2/",
    "tests/muster_control/client/",
    "tests/muster_control/api/",
    "tests/muster_control/browser/",
    "tests/muster_control/runs/",
    "tests/muster_control/cli/test_serve.py",
    "tests/muster_control/cli/test_server_option.py",
    "tests/conformance/test_planning_doors.py",
    "tests/muster_team/test_real_network.py",
)


@dataclass
class Touched:
    """The tests that a change touches.

    tests : set[str]
        Ids of test functions, and test files (every function of theirs).
    unknown : list[str]
        Changed files for which no test is known.
    """

    tests: set[str] = field(default_factory=set)
    unknown: list[str] = field(default_factory=list)


def touched(changed: list[str], tests: TestMap) -> Touched:
    """Return the tests that the changed files touch."""
    found = Touched()
    executors = _executors(tests)
    for file in changed:
        of_file = _tests_of(file, executors)
        if of_file is None:
            found.unknown.append(file)
        else:
            found.tests |= of_file
    return found


def _tests_of(file: str, executors: dict[str, set[str]]) -> set[str] | None:
    if file == "tests/executed.json":
        return set()
    if file.startswith("tests/"):
        return _tests_of_test_file(file)
    if file in executors:
        return executors[file]
    if file.startswith("src/") and file.endswith(".py"):
        importers = _importers(file)
        return set().union(*(executors.get(importer, set()) for importer in importers)) or None
    return _tests_by_folder(file)


def _executors(tests: TestMap) -> dict[str, set[str]]:
    """Return for each source the test functions that executed it."""
    found: dict[str, set[str]] = {}
    for name, test in tests.items():
        for source in test.sources:
            found.setdefault(source, set()).add(name)
    return found


def _tests_by_folder(file: str) -> set[str] | None:
    for pattern, places in FOLDERS:
        if re.match(pattern, file):
            return {str(path) for place in places for path in _test_files(place)}
    return None


def _test_files(place: str) -> Iterator[str]:
    """Yield the test files at a place: a file, or everything below a folder."""
    path = ROOT / place
    for file in sorted(path.rglob("test_*.py")) if path.is_dir() else [path]:
        yield file.relative_to(ROOT).as_posix()


def _tests_of_test_file(file: str) -> set[str] | None:
    """Return the test files that a file among the tests bears on: itself, those that import it, or its folder's."""
    path = Path(file)
    if path.name.startswith("test_") and path.suffix == ".py":
        return {file} if (ROOT / file).exists() else set()
    if path.name != "conftest.py" and path.suffix == ".py":
        users = {name for name in _all_importers(file) if Path(name).name.startswith("test_")}
        if users:
            return users
    return set(_test_files(path.parent.as_posix())) if path.parent != Path("tests") else None


def _all_importers(file: str) -> set[str]:
    """Return the Python files that import a file, also by way of others."""
    found: set[str] = set()
    waiting = [file]
    while waiting:
        new = _importers(waiting.pop()) - found
        found |= new
        waiting += [name for name in new if not Path(name).name.startswith("test_")]
    return found


def _importers(file: str) -> set[str]:
    """Return the Python files that name the module of a file: in an import, or by a group of entry points it is in."""
    path = Path(file)
    parts = path.with_suffix("").parts[1 if file.startswith("src/") else 0 :]
    parts = parts[:-1] if parts[-1] == "__init__" else parts
    package, module = re.escape(".".join(parts[:-1])), parts[-1]
    whole = ".".join(parts)
    groups = "".join(rf"|\"{re.escape(group)}\"" for group in _groups_of(whole))
    listed = rf"from {package} import (?:\([^)]*|[^(\n]*)\b{module}\b"
    pattern = re.compile(rf"\b{re.escape(whole)}\b|^\s*{listed}{groups}", re.MULTILINE)
    return {name for name, text in _python_files().items() if name != file and pattern.search(text)}


def _groups_of(module: str) -> Iterator[str]:
    """Yield the groups of entry points in which a module is registered."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for group, entries in project["entry-points"].items():
        if any(value.partition(":")[0] == module for value in entries.values()):
            yield group


@cache
def _python_files() -> dict[str, str]:
    """Return the text of every Python file below `src` and `tests`."""
    paths = (path for folder in ("src", "tests") for path in (ROOT / folder).rglob("*.py"))
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}
