"""Print what each of ten turns of `.ci/run` executes of all that takes long: `python -m tools.suites.shares`."""

import sys

from tests.suites import SHARES, share_of

from tools.suites.campaigns import CAMPAIGNS
from tools.suites.executed import read_map
from tools.suites.turn import collected


def main() -> int:
    """Print for each turn its campaigns and its long test functions with their CPU seconds."""
    tests = read_map()
    long = collected("--suite=long")
    for turn in range(SHARES):
        of_turn = [name for name in long if share_of(name) == turn]
        seconds = sum(tests[name].cpu_s for name in of_turn if name in tests)
        campaigns = ", ".join(f"{one.target} ({one.seeds} of {one.total})" for one in CAMPAIGNS if one.turn == turn)
        print(f"turn {turn}: {len(of_turn)} long test functions, {seconds:.0f} CPU s; {campaigns}")
        for name in of_turn:
            print(f"  {tests[name].cpu_s if name in tests else 0:6.2f}  {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
