"""One run of the campaign, in a process of its own."""

import traceback
from collections import Counter

from muster.studies.negotiation import replay


def trial(seed):
    """(seed, failures, time, counts) of a run; an error is a failure like any other.

    The time is that until agreement: in seconds, and as a share of what it may take.
    """
    try:
        report = replay(seed)
    except Exception:
        return seed, [traceback.format_exc()], (0.0, 0.0), Counter()
    return seed, report.failures, (report.took_s, report.share), report.counts
