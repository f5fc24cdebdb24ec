"""One run of the campaign, in a process of its own."""

from tests.trials import Report

from muster.studies.negotiation import replay


def trial(seed):
    """Play the scene of a seed and look whether all that is promised holds."""
    report = Report(seed)
    with report.trying():
        played = replay(seed)
        report.story += played.scene.described()
        report.failures, report.counts, report.figures = played.failures, played.counts, [played.took_s]
    return report
