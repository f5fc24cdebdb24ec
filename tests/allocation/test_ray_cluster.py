"""Parts of a team worked on by a Ray cluster of two nodes, both of them on this machine."""

import os
import signal
import socket
import sys
import threading
import time
from contextlib import contextmanager
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest

import muster
from muster.allocation.algorithms import greedy
from muster.allocation.search.partition import improve_in_parts
from muster.allocation.search.ray_cluster import joined
from muster.allocation.search.search import Parameters, anneal
from muster.allocation.search.workers import Job, Limits, Threads
from muster.allocation.stop import Stop
from muster.cli.main import run
from muster.generation.uniform import large_mission
from muster.mission.errors import MusterError, ParameterError
from muster.mission.reading.plan_reader import read_plan
from muster.mission.yaml_writer import yaml_text
from muster.model.problem import Problem

if find_spec("ray") is None:  # it is imported by the tests that need it, as that takes half a second
    pytest.skip("needs the extra ray", allow_module_level=True)

# One cluster for all, so one worker of xdist for all. What Ray leaves open in this process is Ray's affair.
pytestmark = [pytest.mark.xdist_group("ray"), pytest.mark.filterwarnings("ignore")]

MISSION = large_mission(600, 24)
STORE = {"object_store_memory": 80_000_000}
STARTED_S = 2.5
"""Of the processor, after which a worker has surely started."""


@pytest.fixture(scope="module")
def cluster():
    """A cluster of two nodes with one CPU each; nothing of it runs afterwards."""
    from ray.cluster_utils import Cluster

    head = {"num_cpus": 1, "include_dashboard": False, "ray_client_server_port": free_port(), **STORE}
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("GRPC_ENABLE_FORK_SUPPORT", "0")  # with it, who asks from outside is often not let in
        nodes = Cluster(initialize_head=True, head_node_args=head)
    nodes.add_node(num_cpus=1, **STORE)
    until_it_listens(nodes.head_node._ray_params.ray_client_server_port)
    yield nodes
    processes = [one.process for node in nodes.list_all_nodes() for of in node.all_processes.values() for one in of]
    nodes.shutdown()
    assert all(process.poll() is not None for process in processes)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until_it_listens(port):
    """The server for those outside of the cluster is started last, and not waited for by Ray."""
    until = time.monotonic() + 60
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port), 5).close()
        except OSError:
            assert time.monotonic() < until
            time.sleep(0.1)


@pytest.fixture(scope="module")
def address(cluster):
    return cluster.address


@pytest.fixture(scope="class")
def workers(address):
    """The cluster, joined once for all tests of a class, as its workers take seconds to start."""
    before = signal.getsignal(signal.SIGTERM)
    with joined(address) as workers:
        yield workers
    assert signal.getsignal(signal.SIGTERM) is before  # Ray's own does not stay


@pytest.mark.long
def test_the_plan_is_that_of_threads_and_from_outside_of_the_cluster_joining_is_tried_again(
    cluster, monkeypatch, capfd
):
    """Where the process that Ray starts for us is dead at once; but not for ever."""
    import ray

    init, failures = ray.init, [1]

    def fail_at_first(**options):
        if failures[0]:
            failures[0] -= 1
            raise ConnectionAbortedError("Starting Ray client server failed.")
        init(**options)

    monkeypatch.setattr(ray, "init", fail_at_first)
    outside = f"ray://127.0.0.1:{cluster.head_node._ray_params.ray_client_server_port}"
    by_threads, by_ray = (
        muster.solve(MISSION, "search", iterations=500, seed=4, parts=4, **where) for where in ({}, {"ray": outside})
    )
    assert by_ray.routes == by_threads.routes
    assert by_ray.complete
    assert muster.verify(MISSION, by_ray).violations == ()
    assert not ray.is_initialized()
    assert capfd.readouterr() == ("", "")
    failures[0] = 4
    with pytest.raises(ParameterError, match=r"no cluster \(Starting Ray client server failed"), joined(outside):
        pass
    assert failures == [1]


def processes(cluster):
    """Those that the nodes of the cluster have begun, its workers among them."""
    raylets = [one.process.pid for node in cluster.list_all_nodes() for one in node.all_processes["raylet"]]
    begun = [file.read_text() for pid in raylets for file in Path(f"/proc/{pid}/task").glob("*/children")]
    return [Path("/proc", pid) for pids in begun for pid in pids.split()]


def used_s(process):
    """Seconds of the processor, and whether it does a part at this moment; names are as Ray gives them."""
    try:
        works = process.joinpath("cmdline").read_bytes().startswith(b"ray::_done_by_worker")
        figures = process.joinpath("stat").read_text().rpartition(")")[2].split()
    except OSError:  # it has just ended
        return 0.0, False
    return sum(int(ticks) for ticks in figures[11:13]) / os.sysconf("SC_CLK_TCK"), works


@contextmanager
def once(both_work, act, monkeypatch):
    """Act while both nodes work on a part, or after two minutes; not if the block ends before. Workers may be slow."""
    monkeypatch.setattr("muster.allocation.search.ray_cluster._LONGEST_TO_RETURN_S", 60.0)
    over, until = threading.Event(), time.monotonic() + 120

    def wait():
        while not both_work() and time.monotonic() < until:
            if over.wait(0.1):
                return
        act()

    waits = threading.Thread(target=wait)
    waits.start()
    try:
        yield
    finally:
        over.set()
        waits.join()


def ctrl_c():
    os.kill(os.getpid(), signal.SIGINT)


def improvement(spoil):
    """A search that is spoilt at first; made here, as workers do not have this file."""

    def improve(part, until, seed, routes):
        spoil(seed)
        return anneal(part, until, seed, Parameters(), routes)

    return improve


def jobs(improve):
    """Four, of a robot and 20 tasks each."""
    problem = Problem.compile(MISSION)
    parts = [problem.part([k], range(20 * k, 20 * k + 20)) for k in range(4)]
    return [Job(part, k, [[]], Limits(None, 100), improve) for k, part in enumerate(parts)]


class TestOfOneWhoHasJoined:
    """First what leaves workers alive: a later test has them without a start."""

    @pytest.mark.long
    def test_jobs_end_when_it_is_time(self, workers, tmp_path, monkeypatch):
        """Those at work return the best they have; those that have not begun, nothing."""
        begin = improvement(lambda seed: tmp_path.joinpath(str(seed)).touch())
        endless = [replace(job, limits=Limits(None, 10**9)) for job in jobs(begin)]
        stop = Stop()
        with once(lambda: len(list(tmp_path.iterdir())) >= 2, stop.interrupt, monkeypatch):
            assert workers.count == 2
            offers = list(workers.map(endless, stop))
        held = [offer for offer in offers if offer is not None]
        assert len(held) >= 2  # a worker that has returned one may begin another before that is cancelled
        assert all(sorted(offer.routes[0]) == list(range(20)) for offer in held)

    @pytest.mark.long
    def test_where_the_head_is_lost_parts_keep_their_routes(self, address, workers, caplog):
        start = [[i] for i in range(24)]
        problem = Problem.compile(MISSION)
        headless = replace(workers, head=f"127.0.0.1:{free_port()}")
        offers = list(headless.map(jobs(improvement(lambda seed: None)), Stop()))
        better = improve_in_parts(problem, Stop(iterations=80), 0, 4, headless, start, improvement(lambda seed: None))
        assert offers == [None] * 4
        assert caplog.messages[0].startswith(f"ray: {address}: the head was lost ([Errno 111] Connection refused)")
        assert [route[0] for route in better] == list(range(24))
        assert sorted(j for route in better for j in route) == list(range(600))

    @pytest.mark.long
    def test_a_worker_that_cannot_do_the_work_is_named(self, address, workers):
        def lack(seed):
            raise ModuleNotFoundError("No module named 'muster'")

        with pytest.raises(MusterError) as failed:
            list(workers.map(jobs(improvement(lack)), Stop()))
        assert str(failed.value) == (
            f"ray: {address}: a worker fails (ModuleNotFoundError: No module named 'muster'); "
            "expected Muster of this version on every machine"
        )

    @pytest.mark.long
    def test_a_process_that_has_joined_one_stays_there(self, address, workers):
        import ray

        with joined("auto") as again:
            assert again.count == 2
        assert ray.is_initialized()
        with pytest.raises(ParameterError, match="in a process that has joined a cluster; expected auto"):
            muster.solve(MISSION, "search", parts=4, ray=address)

    @pytest.mark.long
    def test_the_command_works_on_it_and_ctrl_c_keeps_the_best_plan(
        self, cluster, workers, tmp_path, capsys, monkeypatch
    ):
        start, plan, mission = tmp_path / "start.json", tmp_path / "plan.json", tmp_path / "mission.yaml"
        mission.write_text(yaml_text(MISSION))
        muster.solve(MISSION, "greedy").save(start)
        words = f"solve {mission} --ray auto --set parts=2 --iterations 1000000000 --start {start} -o {plan}"
        before = {process: used_s(process)[0] for process in processes(cluster)}

        def both_work():
            """In time of the processor, which does not depend on what else this machine does."""
            now = {process: used_s(process) for process in processes(cluster)}
            return sum(works and used > before.get(of, STARTED_S) + 0.5 for of, (used, works) in now.items()) == 2

        with once(both_work, ctrl_c, monkeypatch):
            assert run(words.split()) == 130
        written = read_plan(plan)
        assert muster.verify(muster.load(mission), written).violations == ()
        assert written.complete
        assert written.objective_value < read_plan(start).objective_value
        assert capsys.readouterr().err == "interrupted: this is the best plan so far\n"

    @pytest.mark.long
    def test_within_a_time(self, workers):
        plan = muster.solve(MISSION, "search", time_limit=2.0, parts=4, ray="auto")
        assert plan.complete
        assert muster.verify(MISSION, plan).violations == ()
        values = [value for _, value in plan.history]
        assert values == sorted(values, reverse=True)

    @pytest.mark.long
    def test_a_worker_that_dies_is_replaced(self, workers, tmp_path):
        mark = tmp_path / "died"

        def die_once(seed):
            if seed == 2 and not mark.exists():
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)

        offers = list(workers.map(jobs(improvement(die_once)), Stop()))
        assert mark.exists()
        alone = Threads(1).map(jobs(improvement(lambda seed: None)), Stop())
        assert [offer.routes for offer in offers] == [offer.routes for offer in alone]

    @pytest.mark.long
    def test_a_part_whose_workers_die_keeps_its_routes(self, workers, caplog, monkeypatch):
        monkeypatch.setattr("muster.allocation.search.partition._DIVISIONS", 1)  # in which two workers die and start

        def die(seed):
            if seed == 2:
                os.kill(os.getpid(), signal.SIGKILL)

        problem = Problem.compile(MISSION)
        start = greedy.allocate(problem, Stop(), 0, greedy.Parameters(), None).routes
        better = improve_in_parts(problem, Stop(iterations=400), 0, 4, workers, start, improvement(die))
        assert caplog.messages == ["ray: a worker was lost (WorkerCrashedError); its part keeps the routes it had"]
        assert sorted(j for route in better for j in route) == list(range(600))
        assert problem.value(better)[1] < problem.value(start)[1]


@pytest.mark.parametrize(
    ("address", "why"),
    [
        ("nonsense", ""),
        ("", ""),
        ("http://127.0.0.1:1", ""),
        ("127.0.0.1:0", ""),
        ("127.0.0.1:{closed}", ": no cluster (Connection refused)"),
        ("ray://127.0.0.1:{closed}", ": no cluster (Connection refused)"),
    ],
)
def test_addresses_where_no_cluster_is(address, why):
    address = address.format(closed=free_port())
    expected = "local, auto, HOST:PORT of the head from a machine of the cluster, or ray://HOST:PORT from any other"
    with pytest.raises(ParameterError) as refused:
        muster.solve(MISSION, "search", parts=4, ray=address)
    assert str(refused.value) == f"ray: {address}{why}; expected {expected}"


def test_something_else_answers(monkeypatch):
    monkeypatch.setattr("muster.allocation.search.ray_cluster._LONGEST_TO_ANSWER_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(ParameterError, match="what is there is not the head of a Ray cluster"):
            muster.solve(MISSION, "search", parts=4, ray=address)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--ray", "local"],
            "ray: local, for a team of 31 tasks, which is searched as a whole; "
            "expected a larger one, or parts (2 or more)",
        ),
        (
            ["--ray", "local", "--set", "parts=2", "--threads", "2"],
            "threads: 2, with a Ray cluster; expected one of the two",
        ),
        (["--ray", "local", "-a", "greedy"], "--ray: greedy takes none; expected --allocator search"),
        (["--set", "ray=4"], "ray: 4; expected the address of a Ray cluster, or none"),
    ],
)
def test_where_a_cluster_is_of_no_use(words, message, capsys):
    assert run(["solve", "31T-6R", *words]) == 2
    assert capsys.readouterr().err == f"{message}\n"


def test_without_the_extra(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "ray", None)
    assert run(["solve", "31T-6R", "--ray", "local", "--set", "parts=2"]) == 2
    assert capsys.readouterr().err == (
        "working on a Ray cluster needs an optional part: pip install 'muster-robotics[ray]'\n"
    )
