"""Run the campaign: `python -m tests.carried_missions [SEEDS] [--first SEED] [--processes N]`, or one seed in full."""

import sys

from tests.carried_missions.trial import sum_up, trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.carried_missions", __doc__), trial, sum_up))
