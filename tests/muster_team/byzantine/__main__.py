"""Run the campaign: `python -m tests.muster_team.byzantine [SEEDS] [--first SEED] [--processes N]`, or one seed.

With `--orders` nobody lies: operators on both sides of cuts give orders that may contradict each other.
"""

import sys

from tests.muster_team.byzantine.orders import orders_trial
from tests.muster_team.byzantine.trial import byzantine_trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    parser = parser_of("tests.muster_team.byzantine", __doc__)
    parser.add_argument("--orders", action="store_true", help="orders at the same time in place of lies")
    sys.exit(run(parser, orders_trial if parser.parse_args().orders else byzantine_trial))
