"""Names in scripts that the usual font lacks. Matplotlib's warnings of missing glyphs are errors here."""

import pytest

from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.report import plot_gantt, plot_routes, save_figure
from muster.report.figures.fonts import NOTE, Names
from muster.report.figures.labels import text_size
from muster.verification import verify

OF_STIX = "Ⓐ"  # one that DejaVu Sans Bold lacks and STIXGeneral, which comes with matplotlib, has


def yard(robot, task, name="yard"):
    robots = (Robot(id="r_0", position=(0, 0)), Robot(id=robot, position=(5, 0)))
    tasks = (Task(id=task, position=(9, 9), actuation_cost=3), Task(id="é", position=(4, 9)))
    return Mission(name=name, robots=robots, tasks=tasks)


def drawn_texts(mission, tmp_path):
    """All that is written in both pictures, which are also saved."""
    names = [task.id for task in mission.tasks]
    plan = Plan(routes=(Route(mission.robots[0].id, ()), Route(mission.robots[1].id, tuple(names))))
    verdict = verify(mission, plan)
    texts = []
    for number, ax in enumerate((plot_routes(mission, plan, verdict), plot_gantt(mission, verdict))):
        save_figure(ax, tmp_path / f"{number}.png")
        legend = [text.get_text() for text in ax.get_legend().get_texts()]
        ticks = [text.get_text() for text in ax.get_yticklabels()]
        texts.append({*legend, *ticks, *(text.get_text() for text in ax.texts), ax.get_title(loc="left")})
    return texts


@pytest.fixture
def no_fallbacks(monkeypatch):
    monkeypatch.setattr("muster.report.figures.fonts.FALLBACKS", ())


@pytest.mark.usefixtures("no_fallbacks")
def test_numbers_stand_for_ids_that_no_font_has(tmp_path):
    routes, gantt = drawn_texts(yard("北一", "甲", "救 yard"), tmp_path)
    for texts in (routes, gantt):
        assert {"task #1", "é", NOTE, "? yard"} <= texts
        assert not any(set(text) & set("北一甲救") for text in texts)
    assert any(text.startswith("robot #2  ") for text in routes)
    assert "robot #2" in routes & gantt
    assert "r_0" in routes & gantt


@pytest.mark.long(keep=1)
@pytest.mark.usefixtures("no_fallbacks")
@pytest.mark.parametrize(("robot", "task"), [("r_1", "a"), ("Δφ", "ж"), ("ש", "ü")])
def test_names_that_the_usual_font_has_stand_as_they_are(robot, task, tmp_path):
    for texts in drawn_texts(yard(robot, task), tmp_path):
        assert {robot, task} <= texts
        assert NOTE not in texts


def test_a_fallback_font_that_is_installed_is_used(monkeypatch, tmp_path):
    monkeypatch.setattr("muster.report.figures.fonts.FALLBACKS", ("No Such Font", "STIXGeneral"))
    for texts in drawn_texts(yard(f"r{OF_STIX}", f"t{OF_STIX}", OF_STIX), tmp_path):
        assert {f"r{OF_STIX}", f"t{OF_STIX}", OF_STIX} <= texts
        assert NOTE not in texts


@pytest.mark.usefixtures("no_fallbacks")
def test_a_name_of_a_mission_alone_needs_no_note():
    names = Names(yard("r_1", "a", "a救b"))
    assert names.notes == ()
    assert names.title("a救b") == "a?b"


def test_wide_characters_take_the_room_of_two():
    assert text_size("北一", 10) == text_size("abcd", 10)


def test_ids_that_no_font_has_are_numbers_in_any_words():
    robots = [Robot(id=name, position=(0.0, 0.0)) for name in ("r", "\U00013000", "\U00013000\U00013001")]
    names = Names(Mission(robots=tuple(robots), tasks=(Task(id="a", position=(1.0, 1.0)),)))
    assert names.words("r waits for \U00013000\U00013001, \U00013000") == "r waits for robot #3, robot #2"
