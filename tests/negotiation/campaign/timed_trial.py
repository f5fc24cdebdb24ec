"""One run of the campaign with rules of time: what robots agree on, and what teams carry out."""

from tests.negotiation.campaign.carried_out import carried_out
from tests.negotiation.campaign.trial import trial


def timed_trial(seed):
    """What robots agree on with rules of time, and what teams carry out."""
    agreed, done = trial(seed, timed=True), carried_out(seed)
    agreed.failures += done.failures
    agreed.story += done.story
    agreed.counts.update({f"carried out, {name}": count for name, count in done.counts.items()})
    return agreed
