"""The alternatives that section 2 of the TCF thesis reviews, measured beside its verdicts."""

from muster_studies.thesis_2.study import THESIS_2

__all__ = ["THESIS_2"]
