"""Robots that have agreed thousands of times keep no more than after some dozens, and know the same."""

import gc

import pytest
from tests.muster_team.networks import agree, line_mission, network, owners

from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.auctions.epoch import Epoch
from muster_team.negotiators.participant import PAST
from muster_team.negotiators.robot_book import book_of_view
from muster_team.negotiators.robot_view import view_of


def agree_again(net, times):
    """Let a robot open an epoch, and all agree in it, this many times."""
    first = max(node.stage.epoch for node in net.nodes.values())
    for number in range(first + 1, first + times + 1):
        net.nodes["r_0"].come_back()
        assert net.run(
            net.now + 5.0, lambda n=number: all(x.stage.epoch == n and x.settled for x in net.nodes.values())
        )


def are_in(net, epoch):
    return all(node.settled and node.stage.epoch == epoch for node in net.nodes.values())


def kept():
    gc.collect()
    return len(gc.get_objects())


@pytest.mark.long
@pytest.mark.parametrize("epochs", [200, pytest.param(3000, marks=pytest.mark.long)])
def test_what_a_robot_keeps_does_not_grow_with_the_number_of_epochs(epochs):
    net = network(line_mission(robots=2, tasks=2))
    net.start()
    agree(net)
    agree_again(net, PAST + 5)
    before = kept()
    agree_again(net, epochs)
    assert kept() - before < 100
    node = net.nodes["r_1"]
    assert sum(isinstance(each, Epoch) for each in gc.get_objects()) == 2
    assert len(view_of(node).auctions) == PAST + 1
    assert sorted(owners(net)) == ["0", "1"]


@pytest.mark.parametrize("absent", [False, True])
def test_the_book_knows_prices_of_forgotten_epochs_and_whether_all_took_part(absent):
    problem = Problem.compile(line_mission(robots=2, tasks=4)).ready()
    net = network(problem)
    net.start(["r_0"] if absent else None)
    agree(net)
    if absent:
        net.start(["r_1"])
        agree(net)
    sold = book_of_view(problem, Parameters(), view_of(net.nodes["r_0"])).awards
    agree_again(net, PAST + 5)
    view = view_of(net.nodes["r_0"])
    book = book_of_view(problem, Parameters(), view)
    assert view.together is not absent
    assert book.messages == (view.sent if absent else None)
    assert {(a.task, a.robot, a.price) for a in book.awards} == {(a.task, a.robot, a.price) for a in sold}
    assert len(sold) == 4
