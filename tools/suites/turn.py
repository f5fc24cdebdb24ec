"""`make turn`: raise `.ci/turn`, remake a tenth of the map of tests, and commit both. The last step of every change.

`python -m tools.suites.turn [--whole]`. Recorded are the test functions of this turn's share, those that the map does
not know yet, and with `--whole` all. A test that fails is recorded too: `.ci/run` decides what lands.
"""

import argparse
import subprocess
import sys

from tests.suites import SHARES, share_of

from tools.suites.change import ROOT, TURN, git, turn
from tools.suites.executed import MAP, merged, read_map, read_records, write_map
from tools.suites.record import RECORDS

_LIST = ROOT / "build" / "recorded.txt"


def collected(*options: str) -> list[str]:
    """Return the ids of all test functions, or of those that options of pytest choose."""
    listing = ROOT / "build" / "functions.txt"
    listing.parent.mkdir(exist_ok=True)
    listing.unlink(missing_ok=True)
    _pytest("--collect-only", "-qq", f"--functions={listing}", *options)
    return listing.read_text(encoding="utf-8").splitlines()


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.suites.turn", description=__doc__.partition("\n")[0])
    parser.add_argument("--whole", action="store_true", help="remake the whole map")
    parser.add_argument("--no-commit", action="store_true", help="change the files, and commit nothing")
    asked = parser.parse_args()
    if git("status", "--porcelain") and not asked.no_commit:
        print("Commit your change first: the turn is raised after it.", file=sys.stderr)
        return 2
    number = turn() + 1
    (ROOT / TURN).write_text(f"{number}\n", encoding="utf-8")
    known = read_map()
    functions = collected()
    names = [one for one in functions if asked.whole or one not in known or share_of(one) == number % SHARES]
    print(f"Turn {number}: recording {len(names)} of {len(functions)} test functions.", flush=True)
    _LIST.write_text("\n".join(names) + "\n", encoding="utf-8")
    _pytest("-q", "-p", "tools.suites.record", "-n", "2", "--dist", "loadgroup", f"--only={_LIST}")
    new = read_records(RECORDS)
    if missing := set(names) - set(new):
        print(f"{len(missing)} test functions were not recorded, {min(missing)} among them.", file=sys.stderr)
        return 1
    tests = merged(known, new)
    write_map({name: tests[name] for name in functions if name in tests})
    if not asked.no_commit:
        git("add", TURN, MAP.relative_to(ROOT).as_posix())
        git("commit", "-m", f"Raise the turn of CI to {number}, and remake a tenth of the map of tests")
    return 0


def _pytest(*arguments: str) -> None:
    subprocess.run([sys.executable, "-m", "pytest", *arguments], cwd=ROOT, check=False, stdout=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
