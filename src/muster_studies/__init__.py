"""Published experiments, repeated beside their published numbers. Every own number is the judge's."""

from muster_studies.effort import Effort
from muster_studies.registry import STUDIES, Illustrated, Study, study_named
from muster_studies.tables import Cell, Report, Table

__all__ = ["STUDIES", "Cell", "Effort", "Illustrated", "Report", "Study", "Table", "study_named"]
