"""Words of the field for what is called otherwise here: near matches that no spelling tells."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from muster.mission.packaged_files import packaged_data


def meant_by(word: str) -> list[str]:
    """Return the words here that a word of the field, in lower case, may mean; of these the known one is named."""
    return [name for name, others in _called().items() if word in others.split(", ")]


@cache
def _called() -> Mapping[str, str]:
    called: Mapping[str, str] = packaged_data("muster.mission", "synonyms.yaml")
    return called
