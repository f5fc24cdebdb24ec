"""One run of the campaign, in a process of its own."""

from tests.muster_team.trials import replay
from tests.muster_team.trials.observer import PROMISED_NEVER
from tests.trials import Report


def trial(seed, *, timed=False):
    """Run the trial of a seed, of a mission with times if `timed`, and check all guarantees."""
    report = Report(seed)
    with report.trying():
        played = replay(seed, timed=timed)
        report.story += played.scenario.described()
        report.failures, report.figures = played.failures, [(played.took_s, played.share)]
        report.counts.update(dict.fromkeys(PROMISED_NEVER, 0))
        report.counts.update(played.counts)
    return report
