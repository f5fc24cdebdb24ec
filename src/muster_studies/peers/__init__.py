"""`search` against solvers from elsewhere: OR-Tools, PyVRP, VROOM. Needs the extra `studies`."""

from muster_studies.peers.study import peers_study

__all__ = ["peers_study"]
