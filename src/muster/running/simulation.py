"""A plan carried out in a world: executor and world wired together, as neither knows the other."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Collection, Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.execution import Executor, Recorder, Status, broken_off, report_of, status_of, travel_of, way_of
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.mission.supported_features import require_supported
from muster.motion.paths.robot_paths import RobotPaths
from muster.running.begun import Begun
from muster.running.camera_search import CameraSearch, OnLook, camera_search_for, with_found
from muster.running.free_traffic import free_s
from muster.running.observed_run import ObservedRun
from muster.running.recorded_world import recorded_world, with_tracking
from muster.running.replanning import planning_of
from muster.running.robots_in_traffic import RobotsInTraffic
from muster.running.run_request import RunRequest
from muster.running.state_estimation import EstimatedWorld, RobotsInWorld, with_state_estimation
from muster.running.traffic_choice import manager_for
from muster.running.true_places import TruePlaces, with_truth
from muster.running.unknown_ground import unknown_ground_for
from muster.running.worlds import has_ability, world_named
from muster.simulation import NO_NOISE, SimulatedWorld
from muster.simulation.declaration import EXACT
from muster.state import MissionState, OtherEvent
from muster.state.ground_events import GroundUnknown
from muster.traffic.names import FREE
from muster.verification import verify
from muster.verification.required import require_geometry, require_open_ways

if TYPE_CHECKING:
    from muster.execution.reports.report import Report
    from muster.execution.standing import EventLog
    from muster.running.run_outputs import OnWorld
    from muster.state import ExecutionEvent

LOOK_S = 0.5
"""Seconds of mission time between two looks at the robots, where nothing happens before."""


class Simulation:
    """A plan that is being carried out in a world, with the mission's events, as far as time is let go on.

    Parameters
    ----------
    request
        the world, and how the plan is carried out; without it the fields of `RunRequest` are keyword arguments.
    recorder
        receives all events.
    on_look
        receives each look of a camera; cameras are used where the mission has tags.
    on_world
        receives the world when it is made, to read the states of bodies.
    begun
        where the run was interrupted, if it was; then robots go on from where they stood.

    Raises
    ------
    ParameterError
        if the plan names what the mission does not have, or a parameter is out of range.
    MissingExtraError
        if the extra `physics` is needed and not installed.
    """

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        request: RunRequest | None = None,
        *,
        recorder: Recorder | None = None,
        on_look: OnLook | None = None,
        on_world: OnWorld | None = None,
        begun: Begun | None = None,
        **how: Any,
    ) -> None:
        request = ObservedRun(**how) if request is None else request
        ground = self._ground = unknown_ground_for(mission, request.unknown, request.explore)
        there = mission if begun is None else begun.standing(mission)
        require_supported(mission)
        require_geometry(mission, "a simulated run")
        robot_paths: RobotPaths | None
        if ground is not None:
            mission, robot_paths = ground.mission, ground.paths
        else:
            robot_paths = RobotPaths.of(mission) if mission.has_paths else None
            if begun is None:  # later each robot stands anywhere, and a leg is checked when it is sent
                require_open_ways(mission, plan)
        travel, seed = travel_of(mission, robot_paths), request.seed
        manager = manager_for(
            request.traffic if ground is None else FREE,
            mission,
            seed=seed,
            avoidance=request.avoidance,
            law=request.law,
            exact=_is_exact(request),
            world=None if robot_paths is None else robot_paths.world,
            plan=plan,
            free_s=None if begun or request.duty else partial(free_s, Simulation, mission, request),
        )
        self._world = recorded_world(there, request, recorder, None if begun is None else begun.snapshot)
        if on_world is not None:
            on_world(self._world)
        robots = with_state_estimation(self._world, there, pose=request.pose, localise=request.localise, seed=seed)
        self._estimated = robots if isinstance(robots, EstimatedWorld) else None
        self._traffic = None if manager is None else RobotsInTraffic(robots, self._world, manager, there)
        self._robots: RobotsInWorld = robots if self._traffic is None else self._traffic
        replan, self._standing = planning_of(mission, request.duty, request.planning, travel, seed)
        self._executor = Executor(
            mission,
            _with_objective(mission, replace(plan, ignored=request.ignore)),
            self._robots.ports,
            way=way_of(mission, robot_paths),
            travel=travel,
            replan=replan,
            observer=recorder,
            now=self.time_s,
            state=None if begun is None else begun.state,
            used={} if begun is None else begun.bodies["used"],
            standing=self._standing,
            on_doors=self._close,
            leader=manager,
        )
        if manager is not None:
            manager.expect(self._executor.outlook)
        self._camera_search = camera_search_for(
            there, self._world, robots, noise=request.noise, seed=seed, on_look=on_look
        )
        self._true_places = TruePlaces(there, self._world, robots, self._tag_of)
        self._judged = self._executor.events.total
        self._recorder = recorder
        self._ahead = sorted(there.events, key=lambda event: event.at_s)
        if begun is not None and self._camera_search is not None:
            self._camera_search.resume(begun.bodies["found"])
        if begun is not None:
            self._true_places.resume(begun.bodies.get("done_at", ()))
        if ground is not None:
            self._executor.plan_again(GroundUnknown(cell_m=ground.cell_m))
            kept = None if begun is None else begun.bodies.get("map")
            ground.begin(self._world, self._robots.ports, self._executor, kept)
        self._take_due()
        self._tick()

    @property
    def world(self) -> SimulatedWorld:
        """To look at; who moves it otherwise than by `advance` breaks the mission's clock."""
        return self._world

    @property
    def state(self) -> MissionState:
        """What is known of the mission; to look at."""
        return self._executor.state

    @property
    def robots(self) -> RobotsInWorld:
        """The robots as execution hears them: by their estimates, where they have some."""
        return self._robots

    @property
    def time_s(self) -> float:
        """The mission's clock."""
        return round(self._world.time_s, 9)  # of many steps, each of which rounds

    @property
    def done(self) -> bool:
        """Whether the mission is over."""
        return self._executor.done

    @property
    def plan(self) -> Plan:
        """The plan of the whole mission as it is now, without figures: what each robot did, does and will do."""
        return self._executor.plan

    @property
    def events(self) -> EventLog:
        """All that has happened so far; of a standing fleet the last of it."""
        return self._executor.events

    @property
    def positions(self) -> dict[str, tuple[float, ...]]:
        """Positions by telemetry, metres, of the robots that sent any."""
        told = {name: port.telemetry() for name, port in self._robots.ports.items()}
        return {name: said.position for name, said in told.items() if said is not None}

    def advance(self, until_s: float) -> Sequence[ExecutionEvent]:
        """Go on until something happens, until the mission is over, or up to a time; returns what happened.

        It goes on by whole steps: what falls into a step, an event or `until_s`, comes at its end.
        """
        first = self._executor.events.total
        while not self.done and self.time_s < until_s - 1e-9 and self._executor.events.total == first:
            due_s = min(until_s, self.time_s + LOOK_S, self._executor.due_s, self._look_due_s)
            self._robots.advance(max(due_s, self.time_s + self._world.dt_s))
            self._take_due()
            self._look()
            self._tick()
        return self._executor.events.since(first)

    def report(self, event: Event, *, replan: bool = True) -> None:
        """Let something happen now that the mission file did not foresee; its `at_s` does not count.

        The rest of the mission is planned again at once. With `replan=False` it is planned again by `replan`, or when
        time goes on: once for all events that were reported until then.

        Raises
        ------
        ParameterError
            if the event names a robot or task that there is not, or one anew that there is.
        """
        if event.robot_joins is not None or event.robot_moved is not None:
            self._executor.require_room(event)
            if self._ground is not None and event.robot_joins is not None:
                self._ground.take_in(event.robot_joins)
            self._take_event(event)  # the executor asks for its port, and where it is
            self._executor.report(event)
        else:
            self._executor.report(event)
            self._take_event(event)
        if replan:
            self.replan()

    def note_lag(self, seconds: float) -> None:
        """Note, for the report, by how much the mission's clock is behind the wall clock that it goes by."""
        self._executor.clock_lag.add(seconds)

    def replan(self) -> None:
        """Plan the rest again at once if events that were reported ask for that, and send robots on."""
        self._tick()

    def snapshot(self) -> dict[str, Any] | None:
        """Return where bodies are and what cameras have found, as `Begun.bodies`; None if the world does not tell."""
        if not hasattr(self._world, "snapshot"):
            return None
        found = [] if self._camera_search is None else self._camera_search.snapshot()
        used = {name: state.used for name, state in self._executor.crew.items()}
        done_at = self._true_places.snapshot()
        ground = {} if self._ground is None else {"map": self._ground.snapshot()}
        return {**self._world.snapshot(), **ground, "found": found, "used": used, "done_at": done_at}

    def result(self) -> Report:
        """What it took, so far or in all."""
        world = self._world
        report = report_of(self._executor.account, contacts=len(world.contacts), min_distance_m=world.min_distance_m)
        if self._estimated is not None:
            report = replace(report, remarks=(*report.remarks, self._estimated.remark))
        report = with_truth(with_found(report, self._camera_search), self._executor.mission, self._true_places.done)
        report = with_tracking(report, world)
        return report if self._ground is None else self._ground.with_ground(report)

    @property
    def status(self) -> Status:
        """What each robot does now, and how far each task is."""
        return status_of(self._executor)

    def break_off(self, reason: str) -> Report:
        """End it now, before it is over; every task that is not done is lost. Nothing is to be asked of it then."""
        report = broken_off(self.result(), self._executor.account, reason)
        if self._recorder is not None:
            self._recorder.on_report(report.as_dict())
        return report

    @property
    def camera_search(self) -> CameraSearch | None:
        """What cameras see, where the mission has tags."""
        return self._camera_search

    def save_map(self, file: str | Path) -> None:
        """Write the map that robots without one have built; see `UnknownGround.save`.

        Raises
        ------
        ParameterError
            if the robots have the map.
        """
        if self._ground is None:
            raise ParameterError(f"save_map: {file}; expected robots without a map")
        self._ground.save(Path(file))

    def close(self) -> None:
        """Give back what pictures hold of the graphics library, and the thread that searches."""
        if self._standing is not None and self._standing.improver is not None:
            self._standing.improver.close()
        if self._camera_search is not None:
            self._camera_search.close()

    def _tick(self) -> None:
        self._executor.tick(self.time_s)
        self._judge()
        if self.done and self._recorder is not None:
            self._recorder.on_report(self.result().as_dict())

    def _judge(self) -> None:
        """Compare where work began, goes on and ended with where it was to be."""
        events, self._judged = self._executor.events.since(self._judged), self._executor.events.total
        for off in self._true_places.follow(events, self._executor.ledger.tasks):
            self._executor.emit(off)
        self._true_places.look()

    def _tag_of(self, task: str) -> int | None:
        return None if self._camera_search is None else self._camera_search.tasks.tag_of(task)

    @property
    def _look_due_s(self) -> float:
        lidars_s = math.inf if self._ground is None else self._ground.due_s
        return min(lidars_s, math.inf if self._camera_search is None else self._camera_search.due_s)

    def _look(self) -> None:
        """Let lidars and cameras look.

        What cameras find becomes tasks, and what lies elsewhere moves those not yet done.
        """
        if self._ground is not None:
            self._ground.look(self.time_s)
        if self._camera_search is None:
            return
        for found, event in self._camera_search.look(self.time_s):
            self._executor.set_clock(self.time_s)
            self._executor.emit(OtherEvent(kind="found", content=found))
            if event is None or not (event.new_task or self._is_open(event)):
                continue
            if not self._executor.report_if_it_fits(event) and event.new_task is not None:
                self._camera_search.refused(event.new_task.id)

    def _is_open(self, event: Event) -> bool:
        return event.move_task is not None and event.move_task.task in {task.id for task in self._executor.ledger.open}

    def _close(self, doors: Collection[str]) -> None:
        self._world.close(doors)
        if self._traffic is not None:
            self._traffic.close(doors)

    def _take_due(self) -> None:
        """Let bodies have what events of the mission file do to them that are due."""
        while self._ahead and self._ahead[0].at_s <= self.time_s + 1e-9:
            self._take_event(self._ahead.pop(0))

    def _take_event(self, event: Event) -> None:
        """What an event does to bodies; what it does to the plan is the executor's affair."""
        try:
            self._executor.require_room(event)
        except ParameterError:
            return  # the executor refuses it, too
        if event.robot_fails is not None:
            self._world.fail(event.robot_fails)
        elif event.robot_removed is not None:
            self._world.remove(event.robot_removed)
        elif event.robot_moved is not None:
            self._world.place(event.robot_moved.robot, event.robot_moved.position)
        elif event.robot_silent is not None:
            self._world.silence(event.robot_silent)
        elif event.robot_returns is not None:
            self._world.recover(event.robot_returns)
        elif event.robot_joins is not None:
            self._world.join(event.robot_joins)
            if self._traffic is not None:
                self._traffic.join(event.robot_joins)
            if self._camera_search is not None:
                self._camera_search.join(event.robot_joins)


def _with_objective(mission: Mission, plan: Plan) -> Plan:
    """A plan from elsewhere may not tell its objective: then as the judge has it."""
    if plan.objective_value is not None:
        return plan
    verdict = verify(mission, plan, plan.ignored, plan.objective)
    return replace(plan, objective=verdict.objective_name, objective_value=verdict.value())


def _is_exact(request: RunRequest) -> bool:
    """Whether robots drive exactly as told, and know where they are."""
    estimated = request.pose is not None or request.localise is not None
    return has_ability(world_named(request.world), EXACT) and request.noise == NO_NOISE and not estimated


def carry_out(
    mission: Mission,
    plan: Plan,
    request: ObservedRun | None = None,
    *,
    recorder: Recorder | None = None,
    **how: Any,
) -> Report:
    """Carry a plan out to its end, or until `halt` of the request is set; see `Simulation`."""
    request = ObservedRun(**how) if request is None else request
    halt, speed = request.halt or threading.Event(), request.speed
    hooks: dict[str, Any] = {"recorder": recorder, "on_look": request.on_look, "on_world": request.on_world}
    with closing(Simulation(mission, plan, request, **hooks)) as simulation:
        begin, told = time.monotonic(), 0
        while not simulation.done and not halt.is_set():
            simulation.advance(simulation.time_s + LOOK_S)
            if speed is not None:
                ahead_s = begin + simulation.time_s / speed - time.monotonic()
                simulation.note_lag(max(0.0, -ahead_s))
                halt.wait(max(0.0, ahead_s))
            if request.on_event is not None:
                for event in simulation.events.since(told):
                    request.on_event(event)
                told = simulation.events.total
        if request.save_map is not None:
            simulation.save_map(request.save_map)
        return simulation.result()
