"""One run of the campaign with rules of time: what robots agree on, and what teams carry out."""

from tests.muster_team.campaign.calm import calm, like_the_centre
from tests.muster_team.campaign.carried_out import carried_out
from tests.muster_team.campaign.trial import trial


def timed_trial(seed):
    """What robots agree on with rules of time, and what teams carry out, with faults and without."""
    agreed = trial(seed, timed=True)
    others = {"like the centre": like_the_centre(seed), "carried out": carried_out(seed), "in calm": calm(seed)}
    for what, report in others.items():
        agreed.failures += [f"{what}: {failure}" for failure in report.failures]
        agreed.story += report.story
        agreed.counts.update({f"{what}, {name}": count for name, count in report.counts.items()})
    return agreed
