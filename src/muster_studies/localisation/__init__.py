"""Study `localisation`: tracking, global localisation, the kidnapped robot, and robots that see each other."""

from muster_studies.localisation.study import LOCALISATION

__all__ = ["LOCALISATION"]
