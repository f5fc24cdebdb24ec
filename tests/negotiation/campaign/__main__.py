"""Run the campaign: `python -m tests.negotiation.campaign [SEEDS] [--first SEED] [--processes N]`, or one seed.

With `--timed` the missions have rules of time, and a second one of each seed is carried out, by teams.
"""

import sys

from tests.negotiation.campaign.carried_out import carried_out
from tests.negotiation.campaign.trial import trial
from tests.trials import parser_of, run


def sum_up(took):
    seconds, shares = (sorted(values) for values in zip(*took, strict=True))
    middle, most = seconds[len(seconds) // 2], seconds[int(0.99 * (len(seconds) - 1))]
    told = f"agreed after quiet: {middle:.2f} s (median), {most:.2f} s (99 %), {seconds[-1]:.2f} s (all), virtual time"
    return f"{told}; at most {shares[-1]:.0%} of what the docs allow"


def timed_trial(seed):
    """What robots agree on with rules of time, and what teams carry out."""
    agreed, done = trial(seed, timed=True), carried_out(seed)
    agreed.failures += done.failures
    agreed.story += done.story
    agreed.counts.update({f"carried out, {name}": count for name, count in done.counts.items()})
    return agreed


if __name__ == "__main__":
    parser = parser_of("tests.negotiation.campaign", __doc__)
    parser.add_argument("--timed", action="store_true", help="missions with rules of time, and teams at work")
    sys.exit(run(parser, timed_trial if parser.parse_args().timed else trial, sum_up))
