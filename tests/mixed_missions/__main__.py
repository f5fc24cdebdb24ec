"""Run the campaign: `python -m tests.mixed_missions [SEEDS] [--first SEED] [--processes N]`, or one seed in full."""

import sys

from tests.mixed_missions.trial import CPU_LIMIT_S, trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.mixed_missions", __doc__), trial, cpu_limit_s=CPU_LIMIT_S))
