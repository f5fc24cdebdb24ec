"""One run of the campaign, in a process of its own."""

from tests.trials import Report

from muster.running.negotiation_trials import replay
from muster.running.negotiation_trials.observer import PROMISED_NEVER


def trial(seed):
    """Run the trial of a seed and check all guarantees."""
    report = Report(seed)
    with report.trying():
        played = replay(seed)
        report.story += played.scenario.described()
        report.failures, report.figures = played.failures, [(played.took_s, played.share)]
        report.counts.update(dict.fromkeys(PROMISED_NEVER, 0))
        report.counts.update(played.counts)
    return report
