"""[market-paper], sections 4.2 to 6: its search and rescue scenario carried out."""

from muster_studies.rescue.study import RESCUE

__all__ = ["RESCUE"]
