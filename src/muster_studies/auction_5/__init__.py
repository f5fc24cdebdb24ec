"""[auction-thesis], chapter 5: its three scenarios, Tables 5.2 to 5.23."""

from muster_studies.auction_5.study import AUCTION_5

__all__ = ["AUCTION_5"]
