"""Rules as packages declare them: what a declaration must be, and what is said of one that is wrong."""

import pytest

from muster.mission.declared_rules import RULES, DeclaredRule, implemented, rules_in_order
from muster.mission.errors import ParameterError, PluginError
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole
from muster.model.rules import all_rules

JUDGE = "muster.verification.rules.skill:Skill"


@record
class Needed(Checked):
    """Keys of which one has no default."""

    least: int = spec(Whole(), "how many")


def test_all_that_ship_are_declared_and_sought_in_the_order_that_they_declare():
    assert list(rules_in_order()) == sorted(RULES.shipped, key=lambda name: RULES[name].order)
    planned = [name for name, rule in rules_in_order().items() if rule.planning and rule.ignorable]
    assert list(dict.fromkeys(rule.word for rule in all_rules() if rule.word in planned)) == planned
    assert set(IGNORABLE) == {name for name, rule in RULES.items() if rule.ignorable}


@pytest.mark.parametrize(
    ("found", "message"),
    [
        (3, "it is a int; expected a muster.mission.declared_rules.DeclaredRule"),
        (DeclaredRule(order=5, judge=JUDGE, task=Needed), "key least; expected a default"),
    ],
)
def test_wrong_declarations_are_refused(found, message):
    with pytest.raises(ParameterError, match=f"rule noon: {message}"):
        RULES.add("noon", found)


@pytest.mark.parametrize("where", ["muster.no_such_module:Rule", "muster.verification.rules.skill:NoSuchRule"])
def test_what_a_declaration_names_must_be_there(where):
    with pytest.raises(PluginError, match=f"rule noon: {where} cannot be loaded"):
        implemented("noon", where)
