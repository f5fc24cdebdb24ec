"""Measure: `python -m muster_studies.negotiation [RUNS]`; one run in full: `--replay SEED`."""

import argparse
import sys

from muster_studies.negotiation.figures import lines
from muster_studies.negotiation.trial import replay


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m muster_studies.negotiation", description=__doc__)
    parser.add_argument("runs", type=int, nargs="?", default=100)
    parser.add_argument("--replay", type=int, metavar="SEED")
    asked = parser.parse_args()
    if asked.replay is not None:
        report = replay(asked.replay)
        sys.stdout.writelines(f"{line}\n" for line in report.lines())
        return bool(report.failures)
    for line in lines(asked.runs):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
