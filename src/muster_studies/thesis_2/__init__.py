"""The alternatives that [tcf-thesis], section 2, reviews, measured beside its verdicts."""

from muster_studies.thesis_2.study import THESIS_2

__all__ = ["THESIS_2"]
