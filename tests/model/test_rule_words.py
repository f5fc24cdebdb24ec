"""Only rooms that read or write missions, the model and the judge name a rule; whoever plans or runs reads primitives.

A rule's words are its name and the keys that it declares. In Python a module names a rule by an import of its module,
by an attribute, a keyword or a string that is one of these words, and by a name of several words that is one of the
keys; a source of the core by an identifier that is a key. Docstrings and comments are free.
"""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import fields
from functools import cache
from pathlib import Path

import pytest

from muster.mission.declared_rules import rules_in_order
from muster.model.parts import Parts

HOUSE = Path(__file__).parents[2] / "src" / "muster"
NAMING = ("mission", "library", "generation", "model", "verification", "report", "cli")
"""Rooms that read, write, make or show missions, and those in which each rule has a file."""

OF_THE_MODEL = {
    "prerequisites": "the order of tasks, whichever rule asks for it",
    "team": "the robots that do one task, whichever rule asks for several",
    "needs": "what the abilities of a team sum to",
    "abilities": "what each robot adds to such a sum",
    "load": "what a task adds to a meter",
    "delivers": "whether a task takes off a meter what another one added",
}
"""Keys that are words of the plan model, too, with what they mean in the core and in allocation."""

PRIMITIVES = {f.name for f in fields(Parts)}

_API = "a parameter or function of the Python API and an option of the command"
_LEFT = "the mission that is left is a mission: written with its keys"
_SHOWN = "a documented key of what is reported"
_MATTERS = "what must happen by a rule while the mission is carried out"
ALLOWED = {
    "allocation/auctions/bids.py": ("suitability", "a published bid rule weighs the score"),
    "allocation/remedies/remedy.py": ("capacity prerequisite", _SHOWN),
    "execution/deadlocks/resolution.py": ("relation", _MATTERS),
    "execution/dispatch.py": ("load prerequisite team", _MATTERS),
    "execution/changes.py": ("load", "what lies where a robot has put it down"),
    "execution/goods_beside.py": ("lock skill", _MATTERS),
    "execution/replanning/reallocation.py": ("lock team", _LEFT),
    "execution/replanning/relations.py": ("lock relation team window", _LEFT),
    "execution/replanning/remaining_problem.py": (
        "capacity load lock prerequisite relation suitability",
        _LEFT,
    ),
    "execution/replanning/situation.py": ("capacity load", _LEFT),
    "execution/replanning/transports.py": ("load lock", _LEFT),
    "execution/reports/report.py": ("team", _SHOWN),
    "execution/robots/robot_state.py": ("capacity", _MATTERS),
    "execution/status.py": ("load team", _SHOWN),
    "execution/supervision.py": ("skill", _MATTERS),
    "execution/timing/beginning.py": ("prerequisite shift team", _MATTERS),
    "execution/timing/punctuality.py": ("prerequisite", _MATTERS),
    "planning/explaining/explanations.py": ("prerequisite team", _SHOWN),
    "planning/explaining/impossible.py": ("prerequisite", _SHOWN),
    "planning/explaining/phrases.py": ("capacity team", "words for people"),
    "planning/explaining/tables.py": ("team", _SHOWN),
    "planning/loading.py": ("suitability", _API),
    "planning/mission_readers.py": ("suitability", _API),
    "running/exploration.py": (
        "lock suitability",
        "a task of a frontier is for the robots that fly, or drive, and has a type that most suit",
    ),
    "running/true_places.py": ("team", "a team is as far off as its robot that is farthest off"),
    "running/unknown_ground.py": ("team", "the ways of all robots of a team are measured"),
    "simulation/energy.py": ("battery capacity", "the battery of a robot that has none by the mission"),
    "simulation/world_base.py": ("battery", "a simulated robot's battery"),
    "state/goods_ledger.py": ("load", "what is on board, as tasks that are done take it on and put it down"),
    "state/task_events.py": ("load team", "kinds of events and their documented keys"),
    "state/task_ledger.py": ("deadline load prerequisite relation", _LEFT),
}
"""Files elsewhere that name rules, each with these and why."""

OTHER_MEANING = {
    "__init__.py": ("load", "`muster.load` reads a mission"),
    "motion/maps/images.py": ("load", "pixels of a picture are loaded"),
    "running/bring_home.py": ("lock prerequisite suitability", "robots come home without the mission's rules"),
    "running/fleet_type.py": ("team battery", "abilities of fleets"),
    "running/worlds.py": ("team", "abilities of worlds"),
    "simulation/declaration.py": ("team", "abilities of worlds"),
    "simulation/kinematic_world.py": ("team", "abilities of a world"),
}
"""Files in which such a word means something else."""

MOST, MOST_INSIDE = 12, 2
"""Files elsewhere that name one rule: in all, and in allocation and the core."""


@cache
def _words() -> dict[str, frozenset[str]]:
    """By rule its keys, of the rules that missions state by keys."""
    return {word: frozenset(rule.keys) for word, rule in rules_in_order().items() if rule.keys}


def _said(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr=str(name)) | ast.keyword(arg=str(name)) | ast.Constant(value=str(name)):
                yield name
            case ast.Name(id=name) | ast.arg(arg=name) | ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                if "_" in name:  # a word alone may be a variable of any kind
                    yield name


def _named_in_python(text: str, *, inside: bool = False) -> set[str]:
    tree = ast.parse(text)
    said = set(_said(tree)) - (OF_THE_MODEL.keys() if inside else set())
    strings = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    modules = {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    return {
        word
        for word, keys in _words().items()
        if keys & said or word in strings - PRIMITIVES or f"muster.model.rules.{word.replace('-', '_')}" in modules
    }


def _named_in_core(text: str) -> set[str]:
    code = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    said = set(re.findall(r"[A-Za-z_]\w*", code)) - OF_THE_MODEL.keys()
    return {word for word, keys in _words().items() if keys & said}


def _is_inside(file: str) -> bool:
    return file.startswith(("allocation/", "core/"))


def _naming() -> dict[str, set[str]]:
    """By file of the other rooms the rules that it names."""
    any_word = re.compile(rf"\b({'|'.join({word for rule, keys in _words().items() for word in (rule, *keys)})})\b")
    found: dict[str, set[str]] = {}
    for path in sorted(HOUSE.rglob("*")):
        file = path.relative_to(HOUSE).as_posix()
        if path.suffix not in (".py", ".cpp", ".hpp") or file.startswith(tuple(f"{room}/" for room in NAMING)):
            continue
        text = path.read_text()
        if not any_word.search(text):
            continue
        named = _named_in_python(text, inside=_is_inside(file)) if path.suffix == ".py" else _named_in_core(text)
        if named:
            found[file] = named
    return found


@pytest.mark.long
def test_no_other_file_names_a_rule_and_no_file_is_allowed_what_it_does_not_need():
    allowed = {file: set(rules.split()) for file, (rules, _) in (ALLOWED | OTHER_MEANING).items()}
    assert _naming() == allowed


def test_few_files_elsewhere_name_one_rule():
    files = defaultdict(list)
    for file, (rules, _) in ALLOWED.items():
        for rule in rules.split():
            files[rule].append(file)
    assert {rule: len(some) for rule, some in files.items() if len(some) > MOST} == {}
    assert {rule: some for rule, some in files.items() if sum(map(_is_inside, some)) > MOST_INSIDE} == {}


def test_each_rule_that_can_be_ignored_declares_its_keys():
    assert set(_words()) == {word for word, rule in rules_in_order().items() if rule.ignorable}


@pytest.mark.parametrize(
    ("text", "rules"),
    [
        ("late = task.deadline_s", {"deadline"}),
        ("replace(robot, work_capacity=3)", {"capacity"}),
        ("ignored = ['min-tasks']", {"min-tasks"}),
        ("min_tasks = 3", {"min-tasks"}),
        ("from muster.model.rules.window import late", {"window"}),
        ("team = [0, 1]  # a team of a task", set()),
        ('def of(task):\n    """Whether battery or deadline_s bind."""', set()),
    ],
)
def test_words_in_python_are_found(text, rules):
    assert _named_in_python(text) == rules


def test_words_in_the_core_are_found_but_in_comments():
    assert _named_in_core("double slack = deadline_s[j] - t;  // of longest_duty_s") == {"deadline"}
