"""`search` against solvers from elsewhere: OR-Tools, PyVRP, VROOM. Needs the extra `bench`."""

from muster.studies.peers.study import Peers

__all__ = ["Peers"]
