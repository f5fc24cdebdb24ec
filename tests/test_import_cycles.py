"""No module of Muster imports itself through others, and neither do packages that lie beside each other in a room."""

from graphlib import CycleError, TopologicalSorter

import pytest

grimp = pytest.importorskip("grimp", reason="import-linter is not installed")

ROOTS = ("muster", "muster_studies")


@pytest.fixture(scope="module")
def graph():
    """All imports but those for type checkers alone; an import within a function counts."""
    return grimp.build_graph(*ROOTS, exclude_type_checking_imports=True, cache_dir=None)


def cycle_of(imports):
    """The modules of one cycle, each of which imports the next; None if there is none."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return error.args[1][::-1]
    return None


def test_modules_have_no_cycle(graph):
    assert len(graph.modules) > 500
    assert cycle_of({module: graph.find_modules_directly_imported_by(module) for module in graph.modules}) is None


def test_packages_of_a_room_have_no_cycle(graph):
    packages = [module for module in graph.modules if graph.find_children(module) and module != "muster"]
    to_be_removed = {package: graph.nominate_cycle_breakers(package) for package in packages}
    assert {package: sorted(imports) for package, imports in to_be_removed.items() if imports} == {}


def test_a_cycle_is_found():
    assert cycle_of({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) in (
        ["a", "b", "c", "a"],
        ["b", "c", "a", "b"],
        ["c", "a", "b", "c"],
    )
