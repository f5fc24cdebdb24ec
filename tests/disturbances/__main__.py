"""`python -m tests.disturbances [SEEDS] [--first SEED] [--processes N]`, or one seed with all that happened.

Even seeds are missions of points, odd ones of robots with bodies in the kinematic world (`--kind points|bodies`).
"""

import sys

from tests.disturbances.trial import trial
from tests.trials import parser_of, run, seeds_of


def main():
    parser = parser_of("tests.disturbances", __doc__)
    parser.add_argument("--kind", choices=("points", "bodies"), help="only missions of this kind")
    return run(parser, trial, seeds_of=_seeds_of)


def _seeds_of(asked):
    if asked.kind is None:
        return seeds_of(asked)
    odd = int(asked.kind == "bodies")
    first = asked.first + (asked.first + odd) % 2
    return range(first, first + 2 * asked.seeds, 2)


if __name__ == "__main__":
    sys.exit(main())
