"""Campaigns, and the part of them that each turn of `.ci/run` executes.

Every campaign belongs to one of ten turns. A turn executes `seeds` seeds of its campaigns, which takes a minute or
two on two cores; ten turns later it continues with the seeds that follow, so that no seed is tried twice before all
were.
"""

from dataclasses import dataclass

from tests.suites import SHARES


@dataclass(frozen=True)
class Campaign:
    """One campaign: its turn of ten, its target of make, and how many seeds a turn executes of how many in all.

    In `flags`, {first} stands for the first seed, {seeds} for their number.
    """

    turn: int
    target: str
    seeds: int
    total: int
    flags: str = "{seeds} --first {first}"

    def command(self, turn: int) -> list[str]:
        """Return the command for this campaign at a turn."""
        first = turn // SHARES * self.seeds % self.total
        flags = self.flags.format(seeds=self.seeds, first=first)
        return ["make", self.target, f"CAMPAIGN_FLAGS={flags}", f"DISTURBANCES_FLAGS={flags}"]


CAMPAIGNS = [
    Campaign(0, "campaign", 600, 10_000),
    Campaign(1, "campaign-times", 600, 5_000),
    Campaign(2, "campaign-carry", 300, 3_000),
    Campaign(3, "campaign-auction", 1_000, 10_000),
    Campaign(6, "campaign-mixed", 500, 10_000),
    Campaign(4, "campaign-auction", 200, 2_000, "--timed {seeds} --first {first}"),
    Campaign(2, "campaign-byzantine", 500, 10_000),
    Campaign(8, "campaign-byzantine", 200, 1_000, "--orders {seeds} --first {first}"),
    Campaign(9, "campaign-mutated", 5, 50),
    Campaign(0, "campaign-model", 1, 9),
    Campaign(5, "disturbances", 1_000, 10_000),
    Campaign(6, "disturbances-timed", 200, 2_000),
    Campaign(7, "disturbances-traffic", 100, 2_000),
    Campaign(7, "campaign-state", 300, 10_000),
    Campaign(8, "campaign-goods", 200, 2_000),
    Campaign(9, "campaign-server", 10, 50, "{seeds} --seed {first}"),
    Campaign(7, "campaign-faults", 8, 100, "{seeds} --seed {first}"),
    Campaign(5, "campaign-kills", 40, 1_000),
    Campaign(3, "campaign-narrow", 10, 100),
    Campaign(4, "campaign-coverage", 200, 200, "{seeds}"),
    Campaign(9, "campaign-api", 20, 60, "{seeds}"),
]
