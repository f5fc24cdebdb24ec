"""What `.ci/run` executes: checks, fast tests, and of all that takes long what the change touches and a share.

The change is everything since `.ci/turn` was last raised. `CI_ALL=1` executes everything.
"""

import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from zlib import crc32

from tests.suites import SHARES

from tools.docs_check.__main__ import has_rows, pages
from tools.suites.alone import EXTRAS
from tools.suites.campaigns import CAMPAIGNS
from tools.suites.change import ROOT, TURN, base_of_submission, changed_files, git, raises, turn
from tools.suites.executed import read_map
from tools.suites.touched import touched

_ALSO = ROOT / "build" / "ci_long.txt"
_SITE_TURN = 3  # the one of ten turns at which the site is built whatever the change is
_CORE = ("src/muster/core/", "CMakeLists.txt", "tools/sanitize.sh")
_SITE = ("docs/", "examples/", "tools/docs_site/", "README.md", "CONTRIBUTING.md", "CHANGELOG.md")
_SANITIZED = (
    "tests/core",
    "tests/allocation",
    "tests/conformance",
    "tests/motion",
    "tests/simulation",
    "tests/traffic",
)


@dataclass(frozen=True)
class Step:
    """One command of a run, why it was chosen, and what its environment has besides."""

    name: str
    why: str
    command: list[str]
    environment: dict[str, str] = field(default_factory=dict)


def steps(number: int, changed: list[str] | None) -> Iterator[Step]:
    """Yield what a run at turn `number` executes for the changed files; None stands for everything."""
    yield Step("check", "always", ["make", "check"])
    yield Step("fast tests", "always", ["make", "test", "PYTEST_FLAGS=--no-skips --durations 20 --durations-min 0"])
    yield _long_tests(number, changed)
    for campaign in CAMPAIGNS:
        if changed is None or campaign.turn == number % SHARES:
            yield Step(campaign.target, f"turn {campaign.turn} of ten", campaign.command(number))
    for turn_of_package, package in enumerate(EXTRAS):
        if changed is None or turn_of_package == number % SHARES:
            why = f"turn {turn_of_package} of ten"
            yield Step(f"{package} alone", why, ["make", "test-alone", f"PACKAGE={package}"])
    yield _documents(number, changed)
    if changed is None or _touches(changed, _SITE) or number % SHARES == _SITE_TURN:
        yield Step("site", "documents have changed, or it is the site's turn", ["make", "docs"])
    yield _sanitizers(number, changed)


def _long_tests(number: int, changed: list[str] | None) -> Step:
    flags = "--no-skips --durations 20 --durations-min 0"
    if changed is None:
        return Step("long tests", "all", ["make", "test-all", f"PYTEST_FLAGS=--suite=long {flags}"])
    tests = read_map()
    names = touched(changed, tests).tests
    _ALSO.parent.mkdir(exist_ok=True)
    _ALSO.write_text("\n".join(sorted(names)) + "\n", encoding="utf-8")
    why = f"the tenth of turn {number % SHARES}, and what the change touches"
    return Step(
        "long tests", why, ["make", "test-all", f"PYTEST_FLAGS=--suite=share --turn={number} --also={_ALSO} {flags}"]
    )


def _documents(number: int, changed: list[str] | None) -> Step:
    """Choose pages: those of which text, pictures or measurements have changed, a tenth, and those with rows to run."""
    if changed is None:
        return Step("documents", "all pages", ["make", "docs-check", "DOCS_FLAGS=--every"])
    flags = f"DOCS_FLAGS=--turn {number} --since {base_of_submission() or 'HEAD'}"
    if _touches(changed, ("tools/docs_check/",)):
        return Step("documents", "all pages", ["make", "docs-check", flags])
    shown = [re.escape(Path(file).name) for file in changed if file.startswith("docs/images/")]
    shown += [
        rf"docs-check: \w+ {re.escape(Path(file).stem)} " for file in changed if file.startswith("docs/measured/")
    ]
    every = {page.relative_to(ROOT).as_posix(): page for page in pages()}
    chosen = [
        name
        for name, page in every.items()
        if name in changed or crc32(name.encode()) % SHARES == number % SHARES or has_rows(page) or _holds(page, shown)
    ]
    why = "changed pages, a tenth, and a tenth of the rows"
    return Step("documents", why, ["make", "docs-check", flags, f"DOCS={' '.join(chosen)}"])


def _holds(page: Path, patterns: list[str]) -> bool:
    text = page.read_text(encoding="utf-8")
    return any(re.search(pattern, text) for pattern in patterns)


def _sanitizers(number: int, changed: list[str] | None) -> Step:
    """Choose the test files that the sanitized core runs: all where the core has changed, else a tenth."""
    if changed is None or _touches(changed, _CORE):
        return Step("sanitizers", "the core has changed", ["make", "sanitize"])
    files = (path for folder in _SANITIZED for path in sorted((ROOT / folder).rglob("test_*.py")))
    names = [path.relative_to(ROOT).as_posix() for path in files]
    left_out = tuple(re.findall(r"--ignore (\S+)", (ROOT / "tools" / "sanitize.sh").read_text(encoding="utf-8")))
    in_turn = (name for name in names if crc32(name.encode()) % SHARES == number % SHARES)
    chosen = [name for name in in_turn if not name.startswith(left_out)]
    return Step("sanitizers", "a tenth of the test files", ["make", "sanitize"], {"SANITIZED_TESTS": " ".join(chosen)})


def _touches(changed: list[str], prefixes: tuple[str, ...]) -> bool:
    return any(file.startswith(prefixes) for file in changed)


def unraised(found: list[str]) -> str | None:
    """Return what is wrong where the change does not end with the commit that raises the turn."""
    advice = "When the change is complete, `make turn` raises it, remakes a tenth of the map of tests and commits both."
    if not found:
        return f"{TURN} is not committed. {advice}"
    later = git("diff", "--name-only", found[0], "HEAD").splitlines()
    if later:
        return f"{len(later)} files have changed since {TURN} was raised, {later[0]} among them. {advice}"
    if len(found) > 1 and int(git("show", f"{found[1]}:{TURN}")) >= turn():
        return f"{TURN} was changed, but not raised: it is {turn()}. {advice}"
    return None


def main() -> int:
    """Execute what is chosen, one step after the other, and sum up; returns the exit code."""
    everything = bool(os.environ.get("CI_ALL"))
    wrong = unraised(raises())
    if wrong and not everything:
        print(wrong, file=sys.stderr)
        return 1
    base = base_of_submission()
    changed = None if everything or base is None else changed_files(base)
    plan = list(steps(turn(), changed))
    _tell(base, changed, plan)
    times = [(step, *_executed(step)) for step in plan]
    print("\nWhat was executed:")
    for step, code, seconds in times:
        print(f"  {seconds:6.0f} s  {'passed' if code == 0 else 'FAILED'}  {step.name}: {step.why}")
    return int(any(code != 0 for _, code, _ in times))


def _tell(base: str | None, changed: list[str] | None, plan: list[Step]) -> None:
    what = "everything" if changed is None else f"{len(changed)} files since {(base or '')[:9]}"
    print(f"Turn {turn()}. The change: {what}. Chosen:")
    for step in plan:
        more = " ".join(f"{name}={value}" for name, value in step.environment.items())
        print(f"  {step.name} ({step.why}): {more} {' '.join(step.command)}".rstrip())
    sys.stdout.flush()


def _executed(step: Step) -> tuple[int, float]:
    """Execute a step; returns its exit code and wall seconds."""
    print(f"\n== {step.name}", flush=True)
    begin = time.monotonic()
    done = subprocess.run(step.command, cwd=ROOT, env=os.environ | step.environment, check=False)
    return done.returncode, time.monotonic() - begin


if __name__ == "__main__":
    sys.exit(main())
