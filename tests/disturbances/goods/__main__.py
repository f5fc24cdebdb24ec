"""`python -m tests.disturbances.goods [SEEDS] [--first SEED] [--processes N]`, or one seed with all that happened."""

import sys

from tests.disturbances.goods.trial import trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.disturbances.goods", __doc__), trial))
