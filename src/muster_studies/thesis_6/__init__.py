"""[tcf-thesis], chapter 6: plans carried out, Tables 6.2, 6.3 and 6.6 to 6.11."""

from muster_studies.thesis_6.study import THESIS_6

__all__ = ["THESIS_6"]
