"""`search` against solvers from elsewhere: OR-Tools, PyVRP, VROOM. Needs the extra `studies`."""

from muster_studies.peers.goods_study import peers_goods_study
from muster_studies.peers.routes_study import peers_routes_study
from muster_studies.peers.study import peers_study
from muster_studies.peers.timed_study import peers_timed_study
from muster_studies.peers.waiting_study import peers_waiting_study

__all__ = ["peers_goods_study", "peers_routes_study", "peers_study", "peers_timed_study", "peers_waiting_study"]
