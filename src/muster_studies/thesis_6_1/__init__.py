"""[tcf-thesis], section 6.1: tags that drones find, Tables 6.2 to 6.5."""

from muster_studies.thesis_6_1.study import THESIS_6_1

__all__ = ["THESIS_6_1"]
