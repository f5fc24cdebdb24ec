"""`python -m tests.disturbances.timed [SEEDS] [--first SEED] [--processes N]`, or one seed with all that happened."""

import sys

from tests.disturbances.timed.trial import trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.disturbances.timed", __doc__), trial))
