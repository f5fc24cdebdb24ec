"""`python -m tests.running.narrow [SCENES] [--first SEED] [--processes N]`, or one seed with all that happened."""

import sys

from tests.running.narrow.trial import trial
from tests.trials import parser_of, run

if __name__ == "__main__":
    sys.exit(run(parser_of("tests.running.narrow", __doc__), trial))
