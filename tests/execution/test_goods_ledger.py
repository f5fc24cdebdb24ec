"""The ledger of goods keeps what was taken on in balance with what became of it."""

from tests.carry_charge import robot, task

from muster.mission.goods import as_amount, negative
from muster.state.goods_ledger import GoodsLedger


def ledger():
    goods = GoodsLedger()
    goods.join(robot("r", load_capacity=4, load_at_start=1))
    return goods


def test_tasks_take_on_and_deliver():
    goods = ledger()
    goods.end(task("a", load=2), "r")
    assert (goods.load("r"), goods.carrier("a")) == ({"": 3}, "r")
    goods.end(task("b", delivers="a"), "r")
    assert (goods.load("r"), goods.carrier("a"), goods.delivered) == ({"": 1}, None, {"": 2})


def test_what_is_put_down_is_the_oldest():
    goods = ledger()
    goods.end(task("a", load=2), "r")
    goods.end(task("b", load=-2), "r")
    assert dict(goods.carried("a")) == {"": 1}
    assert (goods.load("r"), goods.put_down) == ({"": 1}, {"": 2})


def test_stations_take_what_is_not_tied():
    goods = ledger()
    goods.end(task("a", load=2), "r")
    goods.end(task("b", load=1), "r")
    assert goods.loose("r", {"a"}) == {"": 2}
    goods.unload("r", {"a"})
    assert goods.unloaded == {"": 2}
    assert goods.load("r") == {"": 2}


def test_goods_of_a_failed_robot_lie_there_and_are_taken_once():
    goods = ledger()
    goods.end(task("a", load=2), "r")
    goods.fall("r")
    assert (goods.load("r"), goods.lying, goods.left) == ({}, {"a": {"": 2}}, {"": 1})
    goods.end(task("a", load=2), "s")
    assert (goods.load("s"), goods.lying, goods.taken) == ({"": 2}, {}, {"": 3})


def test_what_does_not_fit_is_refused():
    goods, one = ledger(), robot("r", load_capacity=4, load_at_start=1)
    assert goods.refusal(task("a", load=3), one) == ""
    assert "4" in goods.refusal(task("a", load=4), one)
    assert "puts down" in goods.refusal(task("a", load=-2), one)
    assert "does not have on board" in goods.refusal(task("b", delivers="a"), one)


def test_amounts_are_told_as_missions_have_them():
    assert (as_amount({}), as_amount({"": 2}), negative({"water": 1})) == (None, 2, {"water": -1})
