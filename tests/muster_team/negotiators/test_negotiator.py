"""What robots promise each other: one owner a task, through restarts, cuts, names claimed twice, new work."""

from dataclasses import replace

import pytest
from tests.muster_team.networks import agree, line_mission, network, owners, settled_team

from muster import Task
from muster.mission.errors import MissionError, ParameterError
from muster_team.knowledge.effects import Notice
from muster_team.knowledge.messages import Message, Stage
from muster_team.knowledge.new_tasks import content_of
from muster_team.negotiators.negotiator import Negotiator
from muster_team.negotiators.robot_view import view_of

ALL = {str(k) for k in range(6)}


def cut_off(net, *groups, for_s=8.0):
    net.cut(*groups)
    net.run(net.now + for_s)


def begin_once(net, robot, task, within_s=10.0):
    """Whether a robot may begin an at-most-once task in the end."""
    return net.run(net.now + within_s, lambda: net.nodes[robot].begin(task))


def first_task(net, robot):
    return net.nodes[robot].route[0].task


def test_the_tasks_of_a_robot_that_crashes_are_sold_again():
    net = settled_team(line_mission())
    net.crash("r_0")
    agree(net)
    assert {task: len(names) for task, names in owners(net).items()} == dict.fromkeys(ALL, 1)
    assert Notice("silent", ("r_0",)) in net.nodes["r_1"].notices


def test_what_a_robot_has_done_is_not_sold_again_when_it_crashes():
    net = settled_team(line_mission())
    task = first_task(net, "r_0")
    assert net.nodes["r_0"].begin(task)
    net.nodes["r_0"].finish(task)
    net.run(net.now + 1.0)
    net.crash("r_0")
    agree(net)
    assert owners(net).keys() == ALL - {task}


def test_a_fact_reaches_all_although_its_first_message_is_lost():
    net = settled_team(line_mission(robots=6))
    task = first_task(net, "r_0")
    net.nodes["r_0"].begin(task)
    net.nodes["r_0"].finish(task)
    net.cut(["r_0", "r_1"], ["r_2", "r_3", "r_4", "r_5"])
    net.run(net.now + 1.0)  # too short for anybody to fall silent
    assert net.nodes["r_1"].known != net.nodes["r_2"].known
    net.heal()
    epoch = net.nodes["r_5"].stage.epoch
    net.run(net.now + 1.0)
    assert len({node.known for node in net.nodes.values()}) == 1
    assert net.nodes["r_5"].stage.epoch == epoch


def test_a_restart_without_memory_in_the_same_epoch_gives_back_what_it_owned():
    net = settled_team(line_mission())
    task = first_task(net, "r_0")
    net.nodes["r_0"].begin(task)
    net.crash("r_0")
    net.run(net.now + 0.3)  # nobody has noticed
    net.start(["r_0"])
    assert net.nodes["r_0"].route == ()
    agree(net)
    assert {name: len(robots) for name, robots in owners(net).items()} == dict.fromkeys(ALL, 1)
    assert not any(claim.begun for node in net.nodes.values() for claim in node.route)


def test_a_restart_with_memory_goes_on_and_never_declares_in_an_old_epoch():
    net = settled_team(line_mission())
    task = first_task(net, "r_0")
    net.nodes["r_0"].begin(task)
    before = net.crash("r_0")
    net.memories["r_0"] = before.memory
    net.start(["r_0"])
    assert net.nodes["r_0"].stage.epoch > before.stage.epoch
    assert net.nodes["r_0"].route == ()  # until it has heard whether others own it now
    agree(net)
    assert first_task(net, "r_0") == task
    assert net.nodes["r_0"].route[0].begun


def test_messages_of_an_earlier_life_are_not_heard():
    net = settled_team(line_mission())
    old = Message("r_0", 1, 10**6, Stage(99))
    net.crash("r_0")
    net.start(["r_0"])
    agree(net)
    stage = net.nodes["r_1"].stage
    net.nodes["r_1"].handle(old, net.now)
    assert net.nodes["r_1"].stage == stage


def test_strangers_are_not_heard():
    net = settled_team(line_mission())
    stage = net.nodes["r_0"].stage
    assert net.nodes["r_0"].handle(Message("nobody", 1, 1, Stage(99)), net.now) == []
    assert net.nodes["r_0"].stage == stage


def test_an_earlier_process_of_a_name_falls_silent_and_a_later_one_goes_on():
    net = settled_team(line_mission())
    first = net.crash("r_0")
    net.start(["r_0"])
    agree(net)
    second = net.nodes["r_0"]
    net.sent = lambda message: message.sender == "r_1" and first.handle(message, net.now)
    net.run(net.now + 8.0)  # in which r_1 tells of the later process, which nobody hears the first one refute
    assert first.superseded
    assert first.route == ()
    assert first.tick(net.now + 9.0) == []
    assert Notice("rival", ("r_0",)) in first.notices
    assert not second.superseded
    assert not second.rivals


def test_two_processes_with_one_name_and_incarnation_are_told():
    net = settled_team(line_mission())
    node = net.nodes["r_0"]
    node.handle(Message("r_0", node.incarnation, 10**6, Stage(1)), net.now)
    assert node.rivals == {node.incarnation}


class Stubborn(Negotiator):
    """Beats, but does not bid."""

    def _go_on(self, now):
        return [] if self.epoch.base is not None else [out for out in super()._go_on(now) if not out.message.bids]


def test_a_robot_that_does_not_bid_is_left_out():
    def make(robot, *rest, **more):
        return (Stubborn if robot == "r_2" else Negotiator)(robot, *rest, **more)

    net = network(line_mission(robots=4), make=make)
    net.start()
    others = [net.nodes[name] for name in ("r_0", "r_1", "r_3")]
    assert net.run(20.0, lambda: all(node.stage.ended and "r_2" not in node.epoch.own.members for node in others))
    assert {claim.task for node in others for claim in node.route} == ALL


def test_each_side_of_a_cut_goes_on_and_ownership_is_settled_when_it_heals():
    net = settled_team(line_mission(robots=4))
    cut_off(net, ["r_0", "r_1"], ["r_2", "r_3"])
    assert all(len(names) == 2 for names in owners(net).values())
    net.heal()
    agree(net, 5.0)
    assert {task: len(names) for task, names in owners(net).items()} == dict.fromkeys(ALL, 1)
    assert any(event.kind == "dropped" for event in net.nodes["r_0"].notices)


def test_work_begun_on_both_sides_goes_on_and_is_told():
    net = settled_team(line_mission(robots=2))
    cut_off(net, ["r_0"], ["r_1"])
    assert net.nodes["r_0"].begin("2")
    assert net.nodes["r_1"].begin("2")
    net.heal()
    agree(net)
    assert sorted(owners(net)["2"]) == ["r_0", "r_1"]
    for node in net.nodes.values():
        assert node.twice == {"2": ("r_0", "r_1")}
        assert Notice("twice", ("r_0", "r_1"), "2") in node.notices
        node.finish("2")
    net.run(net.now + 1.0)
    assert set(net.nodes["r_0"].twice["2"]) == {"r_0", "r_1"}


def test_what_is_begun_stays_at_the_beginning():
    net = settled_team(line_mission(robots=1, tasks=3))
    node = net.nodes["r_0"]
    assert node.begin("1")
    node.announce(Task(id="n", position=(1.0, 0.0)))  # nearer than all others
    agree(net)
    assert [claim.task for claim in node.route] == ["1", "n", "0", "2"]


def test_a_task_waits_for_what_must_be_done_before():
    mission = line_mission(robots=1, tasks=2)
    first, second = mission.tasks
    net = settled_team(replace(mission, tasks=(first, replace(second, prerequisites=("0",)))))
    node = net.nodes["r_0"]
    assert not node.begin("1")
    assert node.begin("0")
    node.finish("0")
    assert node.begin("1")


def test_nothing_is_begun_while_it_is_not_known_who_owns_it():
    net = network(line_mission())
    net.start()
    assert not net.nodes["r_0"].begin("0")
    agree(net)
    assert not net.nodes["r_1"].begin(first_task(net, "r_0"))
    assert net.nodes["r_0"].begin(first_task(net, "r_0"))


def test_a_task_that_appears_comes_to_one_owner_although_its_herald_dies():
    net = settled_team(line_mission(robots=4))
    net.nodes["r_3"].announce(Task(id="n", position=(299.0, 0.0)))
    net.run(net.now + 0.2)
    net.crash("r_3")
    agree(net)
    assert len(owners(net)["n"]) == 1


def test_a_task_that_does_not_fit_is_refused():
    net = settled_team(line_mission())
    with pytest.raises(ParameterError, match="expected an id that no task has"):
        net.nodes["r_0"].announce(Task(id="0", position=(0.0, 0.0)))
    with pytest.raises(MissionError, match="prerequisites"):
        net.nodes["r_0"].announce(Task(id="n", position=(0.0, 0.0), prerequisites=("nothing",)))


def test_a_cancelled_task_is_nobodys_and_what_waits_for_it_too():
    mission = line_mission(tasks=2)
    first, second = mission.tasks
    net = settled_team(replace(mission, tasks=(first, replace(second, prerequisites=("0",)))))
    assert owners(net).keys() == {"0", "1"}
    net.nodes["r_2"].cancel("0")
    agree(net)
    assert owners(net) == {}


def test_a_task_given_back_goes_to_another_and_its_robot_bids_for_it_no_more():
    net = settled_team(line_mission())
    task = first_task(net, "r_0")
    net.nodes["r_0"].begin(task)
    net.nodes["r_0"].release(task)
    assert task not in {claim.task for claim in net.nodes["r_0"].route}
    agree(net)
    assert owners(net)[task] != ["r_0"]
    assert owners(net).keys() == ALL


def test_a_robot_that_is_out_owns_nothing_any_more():
    net = settled_team(line_mission())
    net.nodes["r_0"].withdraw()
    agree(net)
    assert net.nodes["r_0"].route == ()
    assert {task: len(names) for task, names in owners(net).items()} == dict.fromkeys(ALL, 1)


def test_a_robot_that_was_out_comes_back():
    net = settled_team(line_mission())
    before = owners(net)
    net.nodes["r_0"].withdraw()
    agree(net)
    net.nodes["r_0"].come_back()
    agree(net)
    net.nodes["r_1"].withdraw()
    net.nodes["r_2"].withdraw()
    agree(net)
    assert {robot for names in before.values() for robot in names} >= {"r_0"}
    assert "r_0" in {robot for names in owners(net).values() for robot in names}


def test_a_task_that_moves_is_sold_again():
    net = settled_team(line_mission())
    task, (owner,) = "0", owners(net)["0"]
    price = {claim.task: claim.price for claim in net.nodes[owner].route}[task]
    net.nodes["r_2"].move(Task(id=task, position=(1000.0, 0.0)))
    agree(net)
    (new_owner,) = owners(net)[task]
    assert {claim.task: claim.price for claim in net.nodes[new_owner].route}[task] != price
    assert owners(net).keys() == ALL


def test_work_that_was_begun_goes_on_wherever_the_task_is():
    net = settled_team(line_mission())
    task = first_task(net, "r_0")
    assert net.nodes["r_0"].begin(task)
    net.nodes["r_1"].move(Task(id=task, position=(1000.0, 0.0)))
    agree(net)
    assert owners(net)[task] == ["r_0"]


def test_a_task_moves_again_and_again():
    net = settled_team(line_mission())
    for x in (400.0, 700.0):
        net.nodes["r_1"].move(Task(id="0", position=(x, 0.0)))
        agree(net)
    contents = {view_of(node).added for node in net.nodes.values()}
    assert contents == {(content_of(Task(id="0", position=(700.0, 0.0))),)}
    with pytest.raises(ParameterError, match="expected the id of a task"):
        net.nodes["r_0"].move(Task(id="nothing", position=(0.0, 0.0)))


def test_robots_that_come_later_are_not_waited_for():
    net = network(line_mission(robots=4), absent=frozenset({"r_3"}))
    net.start(["r_0", "r_1", "r_2"])
    agree(net, 2.0)
    net.start(["r_3"])
    agree(net)
    assert set(net.nodes["r_0"].epoch.own.members) == {"r_0", "r_1", "r_2", "r_3"}


def test_rounds_are_counted_over_epochs():
    net = settled_team(line_mission())
    assert sorted(claim.round for node in net.nodes.values() for claim in node.route) == [1, 2, 3, 4, 5, 6]
    net.nodes["r_0"].announce(Task(id="n", position=(1.0, 0.0)))
    agree(net)
    assert {claim.round for node in net.nodes.values() for claim in node.route if claim.task == "n"} == {7}


def test_robots_that_hear_only_their_neighbours_agree():
    net = network(line_mission(robots=7), links=lambda a, b: abs(int(a[2:]) - int(b[2:])) == 1, loss=0.2)
    net.start()
    agree(net, 60.0)
    assert {task: len(names) for task, names in owners(net).items()} == dict.fromkeys(ALL, 1)


class TestAtMostOnce:
    ONCE = ("0", "1")

    def test_it_is_begun_once_a_majority_knows(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        assert not net.nodes["r_0"].begin("0")  # the others do not know yet
        assert begin_once(net, "r_0", "0")

    def test_a_minority_neither_sells_nor_begins_it(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        cut_off(net, ["r_0"], ["r_1", "r_2"])
        assert not begin_once(net, "r_0", "0")
        assert owners(net)["2"] in (["r_0", "r_1"], ["r_0", "r_2"], ["r_1", "r_0"], ["r_2", "r_0"])

    def test_who_is_cut_off_after_it_began_keeps_it_whatever_others_do(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        assert begin_once(net, "r_0", "0")
        cut_off(net, ["r_0"], ["r_1", "r_2"])
        assert owners(net)["0"] == ["r_0"]
        assert owners(net)["1"][0] in ("r_0", "r_1", "r_2")
        assert not begin_once(net, "r_1", "0")

    def test_who_is_cut_off_before_it_began_gives_way_to_the_majority(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        cut_off(net, ["r_0"], ["r_1", "r_2"])
        assert not net.nodes["r_0"].begin("0")
        assert begin_once(net, "r_1", "0")
        net.heal()
        agree(net)
        assert owners(net)["0"] == ["r_1"]
        assert not begin_once(net, "r_0", "0")

    def test_a_restart_without_memory_does_not_make_the_others_forget(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        assert begin_once(net, "r_0", "0")
        net.crash("r_0")
        for name in ("r_1", "r_2"):  # both that know forget, one after the other
            net.run(net.now + 6.0)
            net.crash(name)
            net.start([name])
        net.run(net.now + 10.0)
        assert not any(node.knows for node in net.nodes.values())
        assert "0" not in owners(net)
        assert "2" in owners(net)

    def test_who_has_forgotten_counts_again_when_a_majority_has_told_it(self):
        net = settled_team(line_mission(robots=5, once=self.ONCE))
        assert begin_once(net, "r_0", "0")
        net.crash("r_4")
        net.start(["r_4"])
        assert not net.nodes["r_4"].knows
        agree(net)
        assert net.run(net.now + 2.0, lambda: net.nodes["r_4"].knows)
        assert net.nodes["r_4"].facts == net.nodes["r_0"].facts

    def test_what_was_given_back_in_a_life_that_is_forgotten_may_be_begun_in_the_next_and_is_not_sold_then(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        assert not net.nodes["r_0"].begin("0")
        net.run(net.now + 1.0)
        net.nodes["r_0"].release("0")
        agree(net)
        net.crash("r_0")
        net.start(["r_0"])
        agree(net)
        assert owners(net)["0"] == ["r_1"]
        net.nodes["r_1"].release("0")
        agree(net)
        assert begin_once(net, "r_0", "0")
        cut_off(net, ["r_0"], ["r_1", "r_2"])
        assert not begin_once(net, "r_2", "0")
        assert owners(net)["0"] == ["r_0"]

    def test_it_is_not_given_back_once_begun(self):
        net = settled_team(line_mission(robots=1, once=self.ONCE))
        assert begin_once(net, "r_0", "0")
        with pytest.raises(ParameterError, match="expected a task that may be begun again"):
            net.nodes["r_0"].release("0")

    def test_it_may_be_given_back_before(self):
        net = settled_team(line_mission(robots=3, once=self.ONCE))
        assert not net.nodes["r_0"].begin("0")
        net.nodes["r_0"].release("0")
        agree(net)
        (owner,) = owners(net)["0"]
        assert owner != "r_0"
        assert begin_once(net, owner, "0")
