"""Market paper, sections 4 and 5: its search and rescue scenario, and a richer one."""

from muster.studies.market_rescue.study import MarketRescue

__all__ = ["MarketRescue"]
