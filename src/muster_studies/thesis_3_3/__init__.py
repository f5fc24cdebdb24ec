"""[tcf-thesis], section 3.3: the evaluation of its task allocation algorithms, Tables 3.2 to 3.22."""

from muster_studies.thesis_3_3.study import THESIS_3_3

__all__ = ["THESIS_3_3"]
