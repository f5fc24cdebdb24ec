"""Run the campaign: `python -m tests.timed_missions [SEEDS] [--first SEED] [--processes N]`, or one seed in full."""

import sys
from statistics import fmean

from tests.timed_missions.trial import trial
from tests.trials import parser_of, run


def sum_up(gaps):
    return f"mean gap of quick bounds: {100 * fmean(gaps):.1f} %"


if __name__ == "__main__":
    sys.exit(run(parser_of("tests.timed_missions", __doc__), trial, sum_up))
