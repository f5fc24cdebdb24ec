"""Fonts for names in scripts that the default font lacks: another installed font, or numbers in place of the names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cached_property

from muster.mission.model import Mission

FALLBACKS = (
    *("Noto Sans CJK SC", "Noto Sans CJK TC", "Noto Sans CJK JP", "Noto Sans CJK KR", "Noto Sans SC", "Noto Sans JP"),
    *("Source Han Sans SC", "WenQuanYi Micro Hei", "WenQuanYi Zen Hei", "Droid Sans Fallback", "Arial Unicode MS"),
    *("PingFang SC", "Hiragino Sans", "Microsoft YaHei", "Yu Gothic", "Malgun Gothic", "NanumGothic"),
    *("Noto Sans", "Noto Sans Devanagari", "Noto Sans Thai", "Noto Sans Bengali", "Noto Sans Tamil", "Nirmala UI"),
    *("Noto Emoji", "Noto Sans Symbols2", "Segoe UI Symbol", "FreeSans", "Unifont"),
)
"""Families that are looked at, in this order, for characters that the usual font lacks."""

NOTE = "#n: the n-th robot, task or station\nof the mission, whose id\nno installed font has"


class Names:
    """The names of a mission as a picture writes them. An id that no font can write is replaced by its number."""

    def __init__(self, mission: Mission) -> None:
        robots, tasks = [robot.id for robot in mission.robots], [task.id for task in mission.tasks]
        stations = [station.id for station in mission.stations]
        self._families, self._lacking = fonts_for({*mission.name}.union(*robots, *tasks, *stations))
        self._robots = {name: f"robot #{k}" for k, name in enumerate(robots, start=1) if not self._drawable(name)}
        self._tasks = {name: f"task #{k}" for k, name in enumerate(tasks, start=1) if not self._drawable(name)}
        self._stations = {name: f"station #{k}" for k, name in enumerate(stations, start=1) if not self._drawable(name)}

    @cached_property
    def _numbers(self) -> list[tuple[str, str]]:
        """What stands for ids that no font can write; longer ids first, as they may hold shorter ones."""
        found = {**self._robots, **self._tasks, **self._stations}
        return sorted(found.items(), key=lambda pair: -len(pair[0]))

    @property
    def notes(self) -> tuple[str, ...]:
        """The legend's remarks on the names."""
        return (NOTE,) if self._robots or self._tasks or self._stations else ()

    def robot(self, name: str) -> str:
        return self._robots.get(name, name)

    def task(self, name: str) -> str:
        return self._tasks.get(name, name)

    def station(self, name: str) -> str:
        return self._stations.get(name, name)

    def words(self, text: str) -> str:
        """A text that may hold ids: those that no font can write are replaced by their numbers."""
        for name, number in self._numbers:
            text = text.replace(name, number)
        return text

    def title(self, name: str) -> str:
        """The mission's own name, with question marks for what no font has."""
        return "".join("?" if c in self._lacking else c for c in name)

    @contextmanager
    def fonts(self) -> Iterator[None]:
        """A context in which new texts have the fonts that the names need."""
        from matplotlib import rc_context, rcParams

        with rc_context({"font.family": [*rcParams["font.family"], *self._families]}):
            yield

    def _drawable(self, name: str) -> bool:
        return self._lacking.isdisjoint(name)


def fonts_for(characters: Iterable[str]) -> tuple[list[str], set[str]]:
    """The installed fallbacks that the characters need, and the characters that none of them has."""
    foreign = {c for c in characters if not c.isascii()}
    if not foreign:
        return [], set()
    from matplotlib import rcParams
    from matplotlib.font_manager import fontManager

    lacking = foreign - _characters(rcParams["font.family"])
    installed = {font.name for font in fontManager.ttflist}
    chosen = []
    for family in FALLBACKS:
        found = lacking & _characters([family]) if lacking and family in installed else set()
        if found:
            chosen.append(family)
            lacking -= found
    return chosen, lacking


def _characters(families: list[str]) -> set[str]:
    """The characters that a font has, both upright and bold."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    files = [findfont(FontProperties(family=families, weight=weight)) for weight in ("normal", "bold")]
    return set.intersection(*(set(map(chr, get_font(file).get_charmap())) for file in files))
