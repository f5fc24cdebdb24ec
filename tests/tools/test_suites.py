"""Suites, the map of tests, and what a change makes `make quick` and `.ci/run` choose."""

import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.suites import SHARES, chosen, function_id, share_of, shuffle
from tools.suites import change, ci, executed, quick, touched
from tools.suites.alone import EXTRAS
from tools.suites.campaigns import CAMPAIGNS
from tools.suites.executed import Executed

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
MAP = {
    "tests/a/test_one.py::test_near": Executed(0.5, frozenset({"src/muster/a.py"})),
    "tests/a/test_one.py::test_far": Executed(2.0, frozenset({"src/muster/a.py", "src/muster/b.py"})),
    "tests/muster_control/cli/test_serve.py::test_page": Executed(
        1.0, frozenset({"src/muster/a.py", "src/muster/b.py"})
    ),
}


class Item:
    """A collected test as far as suites look at it."""

    def __init__(self, name, *, long=None, group=False, file="tests/x/test_y.py"):
        markers = {"long": SimpleNamespace(kwargs=long)} if long is not None else {}
        markers |= {"xdist_group": SimpleNamespace(args=("story",))} if group else {}
        self.nodeid, self.name, self.path, self.get_closest_marker = f"{file}::{name}", name, file, markers.get


def names(items):
    return {item.nodeid.partition("::")[2] for item in items}


class TestSuites:
    def test_ten_shares_and_the_fast_suite_are_all_tests_and_none_twice(self):
        def of_all():
            return [
                Item(f"test_{i}[{k}]", long={"keep": i % 3} if i % 2 else None) for i in range(60) for k in range(4)
            ]

        seen = []
        for suite, turn in [("fast", 0), *(("share", turn) for turn in range(7, 17))]:
            items = of_all()
            chosen(items, suite, turn)
            seen += [one.nodeid for one in items]
        assert sorted(seen) == sorted(one.nodeid for one in of_all())

    def test_kept_cases_stay_in_the_fast_suite(self):
        items = [Item(f"test_a[{k}]", long={"keep": 2}) for k in range(9)] + [Item("test_b"), Item("test_c", long={})]
        left_out = chosen(items, "fast")
        assert len(items) == 3
        assert "test_b" in names(items)
        assert "test_c" in names(left_out)

    def test_cases_of_one_function_share_a_turn(self):
        assert share_of("tests/x.py::test_a[1::2]@group") == share_of("tests/x.py::test_a") < SHARES
        assert function_id("tests/x.py::TestA::test_b[1]@group") == "tests/x.py::TestA::test_b"

    def test_a_share_has_the_listed_long_tests_besides(self, tmp_path):
        (tmp_path / "also").write_text("tests/x/test_y.py::test_1\ntests/x/test_z.py\n")
        other = {"long": {}, "file": "tests/x/test_z.py"}
        items = [Item("test_1", long={}), Item("test_2", long={}), Item("test_3"), Item("test_4", **other)]
        turn = next(turn for turn in range(SHARES) if turn not in {share_of(one.nodeid) for one in items})
        chosen(items, "share", turn, also=tmp_path / "also")
        assert names(items) == {"test_1", "test_4"}

    def test_a_listed_test_of_a_story_brings_the_story(self, tmp_path):
        (tmp_path / "only").write_text("tests/x/test_y.py::test_2\ntests/x/test_z.py::test_5\n")
        items = [Item(f"test_{i}", group=True) for i in range(3)]
        items += [Item(f"test_{i}", file="tests/x/test_z.py") for i in (4, 5)]
        chosen(items, "all", only=tmp_path / "only")
        assert names(items) == {"test_0", "test_1", "test_2", "test_5"}

    def test_a_random_order_keeps_stories_together(self):
        items = [Item(f"test_{i}", file=f"f{i // 10}", group=i < 10) for i in range(50)]
        before = [one.nodeid for one in items]
        shuffle(items, 3)
        after = [one.nodeid for one in items]
        assert after != before
        assert sorted(after) == sorted(before)
        story = [name for name in after if name.startswith("f0")]
        assert story == before[:10]


class TestMap:
    def test_a_map_is_read_as_it_was_written(self, tmp_path):
        file = tmp_path / "map.json"
        executed.write_map(MAP, file)
        assert executed.read_map(file) == MAP

    def test_numbers_of_sources_stay(self, tmp_path):
        file = tmp_path / "map.json"
        executed.write_map(MAP, file)
        line = file.read_text().splitlines()[-2]
        executed.write_map(MAP | {"tests/0.py::test": Executed(1.0, frozenset({"src/muster/0.py"}))}, file)
        assert line in file.read_text()

    def test_times_that_differ_little_stay(self):
        near, far = Executed(0.6, frozenset()), Executed(4.0, frozenset())
        new = executed.merged(MAP, {"tests/a/test_one.py::test_near": near, "tests/a/test_one.py::test_far": far})
        assert [test.cpu_s for test in new.values()] == [0.5, 4.0, 1.0]

    def test_what_processes_of_fixtures_import_counts_for_all_tests_of_the_file(self, tmp_path):
        (tmp_path / "1.json").write_text(
            '{"tests/a.py::test_a": {"cpu_s": 0.123, "sources": []}, "tests/a.py::test_b": {"cpu_s": 0, "sources": []}}'
        )
        (tmp_path / "child-2.json").write_text('{"test": "tests/a.py::test_a[x] (setup)", "sources": ["s"]}')
        (tmp_path / "child-3.json").write_text('{"test": "tests/a.py::test_b (call)", "sources": ["c"]}')
        assert executed.read_records(tmp_path) == {
            "tests/a.py::test_a": Executed(0.1, frozenset("s")),
            "tests/a.py::test_b": Executed(0.01, frozenset("sc")),
        }

    def test_the_committed_map_names_files_that_exist(self):
        files = {name.partition("::")[0] for name in executed.read_map()}
        assert len(files) > 400
        assert all((ROOT / file).exists() for file in files)


class TestTouched:
    def test_sources_touch_the_tests_that_executed_them(self):
        assert touched.touched(["src/muster/b.py"], MAP).tests == set(MAP) - {"tests/a/test_one.py::test_near"}

    @pytest.mark.long
    def test_a_source_without_functions_touches_what_executes_its_importers(self):
        importer = "src/muster/allocation/registry.py"
        tests = {"tests/x.py::test": Executed(1.0, frozenset({importer}))}
        assert touched.touched(["src/muster/allocation/algorithms/greedy.py"], tests).tests == set(tests)

    @pytest.mark.parametrize(
        ("file", "test"),
        [
            ("src/muster/core/plans/search.cpp", "tests/core/test_local_search.py"),
            ("src/muster/report/page/player.js", "tests/report/page/test_page_in_a_browser.py"),
            ("src/muster_control/pages/map/map.js", "tests/muster_control/browser/test_story.py"),
            ("src/muster/library/missions/31T-6R50.yaml", "tests/library/test_missions.py"),
            ("src/muster_control/store/migrations/script.py.mako", "tests/muster_control/store/test_backup.py"),
            ("docs/index.md", "tests/docs/test_docs.py"),
            ("tests/core/test_core.py", "tests/core/test_core.py"),
            ("tests/verification/brute_paths.py", "tests/verification/test_map_paths.py"),
            ("tests/muster_control/store/conftest.py", "tests/muster_control/store/test_backup.py"),
        ],
    )
    def test_other_files_touch_the_tests_of_their_folder_or_of_those_that_import_them(self, file, test):
        assert test in touched.touched([file], {}).tests

    def test_a_file_that_no_test_is_known_for_is_named(self):
        assert touched.touched(["src/other/thing.bin"], MAP).unknown == ["src/other/thing.bin"]

    def test_every_folder_that_is_named_exists(self):
        places = [place for _, places in touched.FOLDERS for place in places] + list(touched.SERVICES)
        assert all((ROOT / place).exists() for place in places)


class TestQuick:
    def test_the_most_specific_tests_run_first_and_what_is_left_out_is_counted(self):
        found = touched.touched(["src/muster/a.py"], MAP)
        selection = quick.select(found, MAP, budget_s=1.0)
        assert selection.tests == ["tests/a/test_one.py::test_near"]
        assert (selection.with_services, selection.beyond_budget) == (1, 1)

    def test_a_test_file_that_has_changed_runs_though_it_needs_a_service(self):
        found = touched.touched(["tests/muster_control/cli/test_serve.py"], MAP)
        assert quick.select(found, MAP, budget_s=9.0).tests == ["tests/muster_control/cli/test_serve.py::test_page"]

    def test_a_test_file_that_the_map_does_not_know_runs_whole(self):
        found = touched.Touched({"tests/a/test_new.py"})
        assert quick.select(found, MAP, budget_s=9.0).tests == ["tests/a/test_new.py"]

    @pytest.mark.parametrize(
        ("codes", "runs", "code"), [([0], 1, 0), ([1], 1, 1), ([5, 0], 2, 0), ([5, 1], 2, 1), ([5, 5], 2, 0)]
    )
    def test_tests_with_services_run_where_no_other_test_is_fast(self, monkeypatch, capsys, codes, runs, code):
        ran, left = [], list(codes)
        monkeypatch.setattr(quick, "read_map", lambda: MAP)
        monkeypatch.setattr(quick, "base_of_work", lambda: "HEAD")
        monkeypatch.setattr(quick, "changed_files", lambda base: ["src/muster/a.py"])
        monkeypatch.setattr(quick, "_run", lambda chosen, options: ran.append(chosen.tests) or left.pop(0))
        monkeypatch.setattr("sys.argv", ["quick"])
        assert quick.main() == code
        assert len(ran) == runs
        assert all("muster_control" not in test for test in ran[0])
        assert ran[1:] in ([], [["tests/muster_control/cli/test_serve.py::test_page"]])
        assert ("No fast test executes" in capsys.readouterr().out) == (codes == [5, 5])


class TestCI:
    @pytest.fixture(autouse=True)
    def small_map(self, monkeypatch):
        monkeypatch.setattr(ci, "read_map", lambda: MAP)

    def test_ten_turns_run_every_campaign_that_make_has(self):
        targets = set(re.findall(r"^((?:campaign|disturbances)[a-z-]*):", MAKEFILE, re.MULTILINE))
        assert {campaign.target for campaign in CAMPAIGNS} == targets
        executed = [step.name for turn in range(3, 13) for step in ci.steps(turn, [])]
        assert all(executed.count(name) == len([one for one in CAMPAIGNS if one.target == name]) for name in targets)

    def test_ten_turns_run_the_tests_of_each_package_alone(self):
        commands = [step.command for turn in range(3, 13) for step in ci.steps(turn, [])]
        alone = [command[2] for command in commands if command[1] == "test-alone"]
        assert sorted(alone) == sorted(f"PACKAGE={package}" for package in EXTRAS)

    def test_a_campaign_goes_on_with_the_seeds_that_follow(self):
        of_turn = [CAMPAIGNS[0].command(turn)[2] for turn in (0, 10, 170)]
        assert of_turn == [f"CAMPAIGN_FLAGS=600 --first {first}" for first in (0, 600, 200)]

    def test_ten_turns_run_every_page_and_every_file_under_the_sanitizers(self):
        pages, files, sites = set(), set(), 0
        for turn in range(20, 30):
            for step in ci.steps(turn, []):
                pages |= set(step.command[-1].removeprefix("DOCS=").split()) if step.name == "documents" else set()
                files |= set(step.environment.get("SANITIZED_TESTS", "").split())
                sites += step.name == "site"
        assert pages == {page.relative_to(ROOT).as_posix() for page in ci.pages()}
        assert "tests/core/test_core.py" in files
        assert "tests/traffic/test_parts.py" in files
        assert not any(name.startswith("tests/motion/areas") for name in files)  # tools/sanitize.sh leaves them out
        assert sites == 1

    def test_a_change_of_the_core_runs_all_under_the_sanitizers(self):
        (step,) = (step for step in ci.steps(1, ["src/muster/core/plans/draft.cpp"]) if step.name == "sanitizers")
        assert not step.environment

    def test_changed_pages_are_checked(self):
        (step,) = (step for step in ci.steps(1, ["docs/maps.md"]) if step.name == "documents")
        assert "docs/maps.md" in step.command[-1]

    @pytest.mark.parametrize(
        ("file", "page"),
        [("docs/images/field.png", "docs/areas.md"), ("docs/measured/study-jams.json", "docs/avoidance.md")],
    )
    def test_a_page_is_chosen_whose_picture_or_measurement_has_changed(self, file, page):
        (step,) = (step for step in ci.steps(1, [file]) if step.name == "documents")
        pages = step.command[-1].removeprefix("DOCS=").split()
        assert page in pages
        assert len(pages) < len(ci.pages()) / 2

    def test_each_turn_runs_rows_of_its_share_and_of_the_change(self):
        for turn in range(20, 30):
            (step,) = (step for step in ci.steps(turn, []) if step.name == "documents")
            assert step.command[2].startswith(f"DOCS_FLAGS=--turn {turn} --since ")
            assert "docs/coverage.md" in step.command[-1].removeprefix("DOCS=").split()

    def test_everything_is_everything(self):
        commands = [step.command for step in ci.steps(1, None)]
        assert ["make", "docs-check", "DOCS_FLAGS=--every"] in commands
        assert sum(command[1] in {campaign.target for campaign in CAMPAIGNS} for command in commands) == len(CAMPAIGNS)


@pytest.mark.long
@pytest.mark.parametrize(
    "text",
    ["import pytest\n\npytest.importorskip('no_such_module')\n", "import pytest\n\ndef test_a():\n    pytest.skip()\n"],
)
def test_neither_a_test_nor_a_whole_module_may_be_skipped_where_nothing_may(tmp_path, text):
    (tmp_path / "test_one.py").write_text(text, encoding="utf-8")

    def run(*options):
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-p",
            "tests.conftest",
            "-p",
            "no:cacheprovider",
            "--rootdir",
            tmp_path,
        ]
        return subprocess.run([*command, tmp_path, *options], cwd=ROOT, check=False, capture_output=True, text=True)

    assert "1 skipped" in run().stdout
    refused = run("--no-skips")
    assert refused.returncode != 0
    assert "where nothing may be skipped" in refused.stdout


class TestTurn:
    @pytest.fixture
    def repository(self, tmp_path, monkeypatch):
        """A repository whose turn was raised to 4 and then to 5."""
        monkeypatch.setattr(change, "ROOT", tmp_path)
        for key in ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"):
            monkeypatch.delenv(key, raising=False)
        subprocess.run(["git", "init", "-q", "-b", "main"], cwd=tmp_path, check=True)
        change.git("config", "user.email", "a@example.org")
        change.git("config", "user.name", "A")
        (tmp_path / ".ci").mkdir()

        def commit(file, text):
            (tmp_path / file).write_text(text)
            change.git("add", "-A")
            change.git("commit", "-q", "-m", f"Change {file}")

        for file, text in [("a", "1"), (change.TURN, "4\n"), ("a", "2"), ("b", "1"), (change.TURN, "5\n")]:
            commit(file, text)
        return commit

    def test_the_change_is_everything_since_the_turn_before(self, repository):
        assert ci.unraised(change.raises()) is None
        assert change.changed_files(change.base_of_submission()) == [change.TURN, "a", "b"]

    def test_a_change_after_the_raise_is_refused(self, repository):
        repository("a", "3")
        assert "1 files have changed since" in ci.unraised(change.raises())

    def test_a_turn_that_falls_is_refused(self, repository):
        repository(change.TURN, "3\n")
        assert "not raised" in ci.unraised(change.raises())

    def test_a_change_under_way_has_files_that_are_not_committed(self, repository, tmp_path):
        (tmp_path / "new").write_text("1")
        assert change.changed_files("HEAD") == ["new"]


def test_workflows_call_targets_that_exist():
    text = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    called = re.findall(r"run: make ([a-z-]+)", text)
    assert called
    assert all(re.search(rf"^{target}:", MAKEFILE, re.MULTILINE) for target in called)
    assert "secrets." not in text
