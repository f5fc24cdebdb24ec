"""[market-paper], sections 4 and 5: its search and rescue scenario, and a richer one."""

from muster_studies.market_rescue.study import MARKET_RESCUE

__all__ = ["MARKET_RESCUE"]
