"""`make quick`: run the fast tests that executed what the change touches, most specific ones first, within a budget.

Tests that need a service (server, browser, ROS master, network) run only where no other fast test executes the change.

`python -m tools.suites.quick [--base COMMIT] [--budget SECONDS] [--list] [PYTEST OPTION...]`. The change is what
differs from the commit where the branch left `origin/main` (`--base` names another), files that git does not know yet
included.
"""

import argparse
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from tools.suites.change import ROOT, base_of_work, changed_files
from tools.suites.executed import Executed, TestMap, read_map
from tools.suites.touched import SERVICES, Touched, touched

_LIST = ROOT / "build" / "quick.txt"
_NO_TESTS = 5  # the exit code of pytest where no test is left to run
_NEW_S = 0.2  # CPU seconds that a test is taken for of which the map knows nothing


@dataclass(frozen=True)
class Selection:
    """The tests that `make quick` runs, and how many it leaves out for which reason."""

    tests: list[str]  # ids of functions, or files of which the map knows nothing
    cpu_s: float
    with_services: int
    beyond_budget: int


def select(found: Touched, tests: TestMap, budget_s: float, *, with_services: bool = False) -> Selection:
    """Choose among touched tests: those with the fewest executed sources first, as they say most of the change.

    `with_services`: of those that need a service, instead of the others.
    """
    named_files = {name for name in found.tests if "::" not in name}
    functions = {name for name in tests if name.partition("::")[0] in named_files} | (found.tests - named_files)
    services = {name for name in functions if name.startswith(SERVICES) and name.partition("::")[0] not in named_files}
    new_files = set[str]() if with_services else named_files - {name.partition("::")[0] for name in functions}
    wanted = services if with_services else functions - services
    ranked = sorted(wanted, key=lambda name: _rank(name, tests[name], named_files))
    chosen, spent = sorted(new_files), _NEW_S * len(new_files)
    for name in ranked:
        if spent + tests[name].cpu_s <= budget_s:
            chosen.append(name)
            spent += tests[name].cpu_s
    return Selection(chosen, spent, len(services), len(ranked) - (len(chosen) - len(new_files)))


def _rank(name: str, test: Executed, named_files: Iterable[str]) -> tuple[bool, int, float, str]:
    return name.partition("::")[0] not in named_files, len(test.sources), test.cpu_s, name


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.suites.quick", description=__doc__.partition("\n")[0])
    parser.add_argument("--base", help="the commit before the change; where the branch left origin/main by default")
    parser.add_argument("--budget", type=float, default=240.0, help="CPU seconds of all chosen tests; 240 by default")
    parser.add_argument("--list", action="store_true", help="print the chosen tests and run none")
    asked, options = parser.parse_known_args()
    tests = read_map()
    changed = changed_files(asked.base or base_of_work())
    if not changed:
        print("Nothing has changed.")
        return 0
    found = touched(changed, tests)
    chosen = select(found, tests, asked.budget)
    _tell(changed, found, chosen)
    if asked.list:
        print("\n".join(chosen.tests))
        return 0
    code = _run(chosen, options) if chosen.tests else _NO_TESTS
    if code == _NO_TESTS and chosen.with_services:
        chosen = select(found, tests, asked.budget, with_services=True)
        print(f"None of these is fast: {len(chosen.tests)} that need a service run, about {chosen.cpu_s:.0f} CPU s.")
        sys.stdout.flush()
        code = _run(chosen, options)
    if code == _NO_TESTS:
        print("No fast test executes what the change touches.")
        return 0
    return code


def _tell(changed: list[str], found: Touched, chosen: Selection) -> None:
    print(f"{len(changed)} changed files; {len(chosen.tests)} test functions run, about {chosen.cpu_s:.0f} CPU s.")
    print("Left out: long tests (the rotating share of .ci/run runs them, and make test-all all),")
    print(f"  {chosen.with_services} test functions that need a service (server, browser, ROS master, network),")
    print(f"  {chosen.beyond_budget} test functions beyond the budget (make test runs them; BUDGET=SECONDS raises it).")
    for file in found.unknown:
        print(f"No test is known for {file}.")
    sys.stdout.flush()


def _run(chosen: Selection, options: list[str]) -> int:
    """Run pytest for the chosen tests; returns its exit code."""
    _LIST.parent.mkdir(exist_ok=True)
    _LIST.write_text("\n".join(chosen.tests) + "\n", encoding="utf-8")
    files = sorted({name.partition("::")[0] for name in chosen.tests if Path(name.partition("::")[0]).exists()})
    workers = ["-n", "2", "--dist", "loadgroup"] if chosen.cpu_s > 5 else []
    command = [sys.executable, "-m", "pytest", "-q", *workers, "--suite", "fast", f"--only={_LIST}"]
    return subprocess.run([*command, *options, *files], cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
