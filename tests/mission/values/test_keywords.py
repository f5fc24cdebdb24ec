"""Names that callers give."""

from __future__ import annotations

import pytest

import muster
from muster.mission.values.keywords import require_one_of


def test_a_known_name_is_accepted() -> None:
    require_one_of("law", "thesis", ("profile", "thesis"))


@pytest.mark.parametrize(
    ("word", "joined_by", "message"),
    [
        ("theses", ", ", "law: theses; expected profile, thesis; did you mean 'thesis'?"),
        ("gravity", " or ", "law: gravity; expected profile or thesis"),
    ],
)
def test_another_name_is_refused_with_all_known_ones_and_the_nearest(word: str, joined_by: str, message: str) -> None:
    with pytest.raises(muster.ParameterError) as refused:
        require_one_of("law", word, ("profile", "thesis"), joined_by=joined_by)
    assert str(refused.value) == message
