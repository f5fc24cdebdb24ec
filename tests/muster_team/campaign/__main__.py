"""Run the campaign: `python -m tests.muster_team.campaign [SEEDS] [--first SEED] [--processes N]`, or one seed.

With `--timed` the missions have rules of time, and a second one of each seed is carried out, by teams.
"""

import sys

from tests.muster_team.campaign.timed_trial import timed_trial
from tests.muster_team.campaign.trial import trial
from tests.trials import parser_of, run

CPU_LIMIT_S = 60.0
"""No seed takes so long: one that goes on for ever ends and fails."""


def sum_up(took):
    seconds, shares = (sorted(values) for values in zip(*took, strict=True))
    middle, most = seconds[len(seconds) // 2], seconds[int(0.99 * (len(seconds) - 1))]
    told = f"agreed after quiet: {middle:.2f} s (median), {most:.2f} s (99 %), {seconds[-1]:.2f} s (all), virtual time"
    return f"{told}; at most {shares[-1]:.0%} of what the docs allow"


if __name__ == "__main__":
    parser = parser_of("tests.muster_team.campaign", __doc__)
    parser.add_argument("--timed", action="store_true", help="missions with rules of time, and teams at work")
    sys.exit(run(parser, timed_trial if parser.parse_args().timed else trial, sum_up, cpu_limit_s=CPU_LIMIT_S))
