"""Orders that operators give while a mission is under way: on both sides of a cut, and one after another."""

from tests.muster_team.networks import agree, line_mission, network, owners, settled_team

from muster import Task


def test_operators_on_two_sides_of_a_cut_may_give_orders_that_fit_together():
    net = settled_team(line_mission(robots=5, tasks=15), delay_s=0.02)
    net.cut(("r_0", "r_1"), ("r_2", "r_3", "r_4"))
    net.run(net.now + 8)
    net.nodes["r_0"].announce(Task(id="x", position=(1.0, 1.0), prerequisites=("3",)))
    net.nodes["r_4"].announce(Task(id="y", position=(9.0, 1.0), prerequisites=("2",), starts_with=("3",)))
    net.nodes["r_4"].cancel("7")
    net.run(net.now + 8)
    net.heal()
    agree(net, 60)
    assert {task: len(robots) for task, robots in owners(net).items()} == dict.fromkeys(
        ["x", "y", *(str(k) for k in range(15) if k != 7)], 1
    )


def test_tasks_that_come_one_by_one_are_each_done_once_though_messages_are_lost():
    net = network(line_mission(robots=4, tasks=4), delay_s=0.05, loss=0.2)
    net.start()
    done, names = [], [f"late {k}" for k in range(12)]
    for k, name in enumerate([None, *names]):
        if name is not None:
            net.nodes[f"r_{k % 4}"].announce(Task(id=name, position=(7.0 * k, 3.0)))
        agree(net, 60)
        for node in net.nodes.values():
            for claim in node.route:
                assert node.begin(claim.task)
                node.finish(claim.task)
                done.append(claim.task)
        net.run(net.now + 1)
    agree(net, 60)
    assert not owners(net)
    assert sorted(done) == sorted(["0", "1", "2", "3", *names])
