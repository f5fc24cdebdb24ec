"""The studies by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from muster.mission.values.keywords import require_one_of
from muster_studies.allocators.study import ALLOCATORS_STUDY
from muster_studies.areas.study import AREAS
from muster_studies.auction_5.study import AUCTION_5
from muster_studies.flown.study import FLOWN
from muster_studies.jams.study import JAMS
from muster_studies.localisation.study import LOCALISATION
from muster_studies.market_5.study import MARKET_5
from muster_studies.market_rescue.study import MARKET_RESCUE
from muster_studies.negotiation.study import NEGOTIATION
from muster_studies.peers.study import peers_study
from muster_studies.peers.timed_studies import (
    peers_goods_study,
    peers_routes_study,
    peers_timed_study,
    peers_waiting_study,
)
from muster_studies.repetition import Repetition
from muster_studies.rescue.study import RESCUE
from muster_studies.rotors.study import ROTORS
from muster_studies.rvo.study import RVO
from muster_studies.thesis_2.study import THESIS_2
from muster_studies.thesis_3_3.study import THESIS_3_3
from muster_studies.thesis_6.study import THESIS_6
from muster_studies.thesis_6_1.study import THESIS_6_1
from muster_studies.unknown.study import UNKNOWN

Study = Repetition[Any, Any]
"""A published experiment that can be repeated."""

_IMPLEMENTATIONS: tuple[Study, ...] = (
    THESIS_2,
    THESIS_3_3,
    THESIS_6,
    THESIS_6_1,
    AUCTION_5,
    MARKET_RESCUE,
    ALLOCATORS_STUDY,
    peers_study(),
    peers_timed_study(),
    peers_routes_study(),
    peers_waiting_study(),
    peers_goods_study(),
    RVO,
    RESCUE,
    MARKET_5,
    LOCALISATION,
    ROTORS,
    FLOWN,
    JAMS,
    UNKNOWN,
    AREAS,
    NEGOTIATION,
)

STUDIES: Mapping[str, Study] = MappingProxyType({study.name: study for study in _IMPLEMENTATIONS})


def study_named(name: str) -> Study:
    """The study of that name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    require_one_of("study", name, STUDIES, joined_by=" or ")
    return STUDIES[name]
