"""`python -m tests.disturbances.traffic [RUNS] [--first SEED] [--processes N]`, or one seed with all that happened."""

import sys

from tests.disturbances.traffic.trial import sum_up, trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.disturbances.traffic", __doc__), trial, sum_up))
