"""Run the campaign: `python -m tests.negotiation.campaign [SEEDS] [--first SEED] [--processes N]`, or one seed."""

import sys

from tests.negotiation.campaign.trial import trial
from tests.trials import parser_of, run


def sum_up(took_s):
    took_s = sorted(took_s)
    middle, most = took_s[len(took_s) // 2], took_s[int(0.99 * (len(took_s) - 1))]
    return f"agreed after quiet: {middle:.2f} s (median), {most:.2f} s (99 %), {took_s[-1]:.2f} s (all), virtual time"


if __name__ == "__main__":
    sys.exit(run(parser_of("tests.negotiation.campaign", __doc__), trial, sum_up))
