"""Features whose role nothing decides: one finding each, with the reason and the option that decides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from muster.mission.errors import Finding
from muster_files.sites.decisions import Decision
from muster_files.sites.features import Feature, Layer
from muster_files.sites.labels import labels_of, names_of, quoted

_MOST = 20


def findings_of(layer: Layer, undecided: Sequence[tuple[Feature, Decision]], of: int) -> Iterator[Finding]:
    """Yield a finding for each undecided feature of a layer that has `of` features, up to a number of lines."""
    counts: dict[str, int] = {}
    for feature, _ in undecided:
        for label in labels_of(layer, feature)[:1]:
            counts[label] = counts.get(label, 0) + 1
    for feature, decision in undecided[:_MOST]:
        own = next((label for label in labels_of(layer, feature)[:1] if counts[label] == 1), None)
        everything = names_of(layer)[0]
        named = everything if own is None or (len(undecided) == of > 1) else own
        first, *others = decision.choices
        expected = f"--as {quoted(f'{named}={first}')} (or {', '.join(others)}) of muster import, or a property kind"
        yield feature.finding("", f"undecided: {decision.reason}", expected)
    if len(undecided) > _MOST:
        feature, decision = undecided[_MOST]
        told = f"undecided, with {len(undecided) - _MOST - 1} more: {decision.reason}"
        yield feature.finding("", told, f"--as {quoted(f'{names_of(layer)[0]}={decision.choices[0]}')}")
