"""`muster auction --simulate-network SEED`: the whole team in a network in memory, on a virtual clock."""

from __future__ import annotations

from random import Random
from typing import Any

import click

from muster.mission.errors import MusterError, ParameterError
from muster.model.problem import Problem
from muster_team.cli.auction_result import Agreement
from muster_team.negotiators.methods import Method
from muster_team.negotiators.robot_view import view_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork


def agree_in_memory(
    problem: Problem, terms: Any, method: Method, options: dict[str, Any], *, quiet: bool, verbose: bool
) -> Agreement:
    """Run the auction in virtual time; the same seed and options give the same run.

    Raises
    ------
    ParameterError
        if more robots are to crash than may.
    MusterError
        if the robots that have not crashed do not agree within the time limit, in virtual seconds.
    """
    names = [robot.id for robot in problem.robots]
    conditions = LinkConditions(
        loss=options["loss"] or 0.0,
        duplication=options["duplication"] or 0.0,
        delay_s=0.001 if options["delay"] is None else options["delay"],
        jitter_s=options["jitter"] or 0.0,
    )

    def make(robot: str, incarnation: int) -> Any:
        return method.negotiator(problem, terms, robot, incarnation=incarnation)

    network = MemoryNetwork(make, names, options["network_seed"], conditions)
    account = _Account(network, rounds=verbose, quiet=quiet)
    _plan_faults(network, account, names, options["crashes"] or 0, options["cut"] or 0.0, len(problem.tasks))
    network.start()

    def agreed() -> bool:
        account.look()
        nodes = network.nodes.values()
        return account.faults_left == 0 and all(
            node.settled and set(node.epoch.own.members) == network.nodes.keys() for node in nodes
        )

    limit_s = options["time_limit"]
    if not network.run(limit_s, agreed):
        unsettled = ", ".join(robot for robot, node in network.nodes.items() if not node.settled)
        raise MusterError(f"no agreement within {limit_s:g} virtual s: {unsettled or 'robots know different members'}")
    account.end()
    return Agreement({robot: view_of(node) for robot, node in network.nodes.items()}, network.now)


class _Account:
    """Prints the events of the auction as they happen."""

    def __init__(self, network: MemoryNetwork, *, rounds: bool, quiet: bool) -> None:
        self._network, self._rounds, self._quiet = network, rounds, quiet
        self._epoch: dict[str, tuple[int, bool]] = {}
        self._seen: set[tuple[bytes, int]] = set()
        self.faults_left = 0

    def tell(self, what: str) -> None:
        if not self._quiet:
            click.echo(f"{self._network.now:9.3f} s  {what}", err=True)

    def look(self) -> None:
        """Print new epochs and rounds."""
        for robot, node in self._network.nodes.items():
            stage = node.stage
            where = stage.epoch, stage.base != b""
            if self._epoch.get(robot) != where:
                self._epoch[robot] = where
                with_whom = f"with {', '.join(node.epoch.own.members)}"
                self.tell(f"{robot}: epoch {stage.epoch} {'begins' if stage.base else 'is declared'} {with_whom}")
            for number in range(stage.round) if self._rounds else ():
                if (stage.base, number) not in self._seen:
                    self._seen.add((stage.base, number))
                    sold = node.epoch.sales[number]
                    self.tell(
                        f"epoch {stage.epoch}, round {number + 1}: {sold.winner} wins {sold.what} for {sold.price:.2f}"
                    )

    def end(self) -> None:
        counts = self._network.counts
        nodes = self._network.nodes.values()
        kinds = ", ".join(
            f"{sum(getattr(node.counts, k) for node in nodes)} {k}" for k in ("news", "repairs", "heartbeats")
        )
        self.tell(
            f"all {len(self._network.nodes)} agree; {counts['sent']} messages ({kinds}), {counts['copies']} copies, "
            f"{counts['lost']} lost"
        )


def _plan_faults(
    network: MemoryNetwork, account: _Account, names: list[str], crashes: int, cut_s: float, tasks: int
) -> None:
    """Crashes and a cut at random moments of about the time that the auction takes."""
    if crashes >= len(names):
        raise ParameterError(f"--crashes: {crashes}; expected less than the {len(names)} robots")
    random = Random(network.seed)
    conditions = network.conditions
    whole_s = (tasks + 2) * (conditions.delay_s + conditions.jitter_s) / (1 - conditions.loss)

    def fault(when_s: float, what: str, happen: Any) -> None:
        def strike() -> None:
            account.faults_left -= 1
            account.tell(what)
            happen()

        account.faults_left += 1
        network.at(when_s, strike)

    for robot in random.sample(names, crashes):
        fault(random.uniform(0, whole_s), f"{robot} crashes", lambda robot=robot: network.crash(robot))
    if cut_s:
        shuffled = random.sample(names, len(names))
        half = random.randint(1, len(names) - 1) if len(names) > 1 else 1
        sides = shuffled[:half], shuffled[half:]
        when_s = random.uniform(0, whole_s / 2)
        text = " | ".join(", ".join(sorted(side)) for side in sides)
        fault(when_s, f"the network is cut: {text}", lambda: network.cut(*sides))
        fault(when_s + cut_s, "the network is whole again", network.heal)
