"""Hints at the known word that a misspelt one may stand for."""

import difflib

import pytest

from muster.mission.texts.near_matches import did_you_mean, near_file

IDS = [f"task_{k}" for k in range(20_000)]


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("tsak_17123", "task_17123"),  # wrong at the beginning
        ("xtask_17123", "task_17123"),
        ("Task-17123", "task_17123"),
        ("task_1712a", "task_1712"),  # and at the end
        ("task_199999", "task_19999"),
    ],
)
def test_among_many_words_the_nearest_is_named(word, hint):
    assert did_you_mean(word, IDS) == f"; did you mean '{hint}'?"


def test_a_word_like_no_other_gets_no_hint():
    assert did_you_mean("quay", IDS) == ""
    assert did_you_mean("quay", IDS[:5]) == ""


def test_of_words_that_differ_in_case_the_first_is_named():
    assert did_you_mean("taks_7", ["Task_7", "task_7"]) == "; did you mean 'Task_7'?"


def test_many_known_words_cost_no_more_comparisons_than_a_few(monkeypatch):
    compared = []

    def close_matches(word, candidates, n, cutoff):
        compared.append(len(candidates))
        return []

    monkeypatch.setattr(difflib, "get_close_matches", close_matches)
    for count in (10, 100, 20_000):
        did_you_mean("tsak_7", IDS[:count])
    assert max(compared) <= 100


def test_swapped_letters_are_nearer_than_others():
    assert did_you_mean("cvs", ["csv", "ics"]) == did_you_mean("cvs", ["ics", "csv"]) == "; did you mean 'csv'?"


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("jobs", ["robots", "tasks", "stations"], "tasks"),
        ("Vehicles", ["robots", "tasks"], "robots"),
        ("cbba", ["auction", "consensus-bundle", "combinatorial-auction"], "consensus-bundle"),
        ("CBBA", ["auction", "consensus-bundle"], "consensus-bundle"),
        ("depends on", ["prerequisites", "deadline_s"], "prerequisites"),
        ("time-windows", ["window_s", "tasks"], "window_s"),
        ("no_fly_zones", ["boundary", "zones"], "zones"),
        ("minmax", ["total", "max", "makespan"], "max"),
    ],
)
def test_words_of_the_field_mean_what_is_called_otherwise_here(word, known, meant):
    assert did_you_mean(word, known) == f"; did you mean '{meant}'?"


def test_a_word_of_the_field_means_nothing_where_its_meaning_is_not_known():
    assert did_you_mean("cbba", ["one", "two"]) == ""


@pytest.mark.parametrize(
    ("asked", "there", "near"),
    [
        ("mission.yml", ["mission.yaml", "mission.json"], "mission.yaml"),
        ("mission.yaml", ["mission.json", "other.yaml"], "mission.json"),
        ("misison.yaml", ["mission.yaml"], "mission.yaml"),
        ("Harbour.yaml", ["harbour.yaml"], "harbour.yaml"),
        ("quay.yaml", ["plan.json"], None),
    ],
)
def test_the_nearest_file_is_named(asked, there, near, tmp_path):
    for name in there:
        (tmp_path / name).touch()
    assert near_file(tmp_path / asked) == (f"; did you mean '{tmp_path / near}'?" if near else "")


def test_a_folder_that_is_not_there_has_no_near_files(tmp_path):
    assert near_file(tmp_path / "none" / "mission.yaml") == ""
