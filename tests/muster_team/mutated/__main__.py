"""Run the campaign: `python -m tests.muster_team.mutated [SEEDS] [--first SEED] [--processes N]`, or one seed.

A seed is a run of a team of five that hears 20,000 mutated messages; 50 seeds are a million.
"""

import sys

from tests.muster_team.mutated.trial import mutated_trial
from tests.trials import parser_of, run

LIMIT_S = 100.0
"""CPU time of a seed, far more than one takes."""

if __name__ == "__main__":
    parser = parser_of("tests.muster_team.mutated", __doc__)
    parser.set_defaults(seeds=50)
    sys.exit(run(parser, mutated_trial, cpu_limit_s=LIMIT_S))
