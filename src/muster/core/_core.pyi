"""The hot loops of Muster."""

from collections.abc import Sequence
from typing import Annotated, overload

import numpy
from numpy.typing import NDArray


class AnnotatedRoadmap:
    """
    A roadmap that says for each edge which points a robot on it comes near to.
    """

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], first: Sequence[int], heads: Sequence[int], costs: Sequence[float], speeds: Sequence[float], near_first: Sequence[int], near_points: Sequence[int], near_metres: Sequence[float]) -> None:
        """
        `points` is (n, 2), `speeds` the greatest on each edge; edges and what is near them are in compressed rows. Raises ValueError where they do not fit.
        """

class Problem:
    """The compiled question: arrays that no algorithm changes."""

    def __init__(self, *, objective: str, usage_is_time: bool, capacity: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], speed: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], available_from: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], must_end: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)], fixed: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], actuation_cost: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], work_class: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], work_seconds: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], time_class: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], priority: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], kind: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], allowed: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)], prerequisites: Sequence[Sequence[int]], entry: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], exit: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], place_class: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], table: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], travel_class: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], seconds: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], openings: Sequence[Sequence[tuple[float, float]]], ends_by: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], due: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], over_by: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], lasts_most: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], spans: Sequence[Sequence[tuple[float, float]]], gap_least: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], gap_most: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], unit: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], parts: Sequence[Sequence[tuple[int, Sequence[bool]]]], abilities: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], needs: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], exclusive: Sequence[Sequence[int]], same_crew: Sequence[Sequence[int]], apart: Sequence[Sequence[int]], least_stops: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], acceleration: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], climb: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], turn: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], over_map: bool, makespan_includes_return: bool, meters: int, load: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], pending: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], pickup: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], most_aboard: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], aboard_at_start: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], pending_at_start: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], energy: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], energy_at_start: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], stations: Sequence[tuple[float, float, bool, bool, int]], calls: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)], over: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)], waiting: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], waits: Annotated[NDArray[numpy.bool_], dict(order='C', device='cpu', writable=False)]) -> None:
        """
        Robots (m), tasks (n) and travel: `fixed` is (m,), how many tasks at the beginning of a route stay; `actuation_cost` is (work classes, n) and `work_class` (m,); `work_seconds` is (time classes, n) and `time_class` (m,); `kind` is (m,) and `allowed` (kinds, n); `entry` and `exit` are (place classes, n + 2m, 3) metres in the map frame for tasks, starts and ends of robots, and `place_class` is (m,); `table`, where ways are not straight, is (classes, n + 2m, n + 2m) metres with each robot's `travel_class`; `seconds`, of its shape, how long ways take where metres do not tell. What is empty of the rest no task or robot has: by task `openings`, `ends_by`, `due`, `unit` (tasks of one begin together), `parts` of teams (count, allowed by kind), `exclusive`, `same_crew`, `apart`; by robot `over_by`, `lasts_most` (from its start to its end), `spans` in which it drives and works, `least_stops` (of a route that has any); `gap_least` and `gap_most` by prerequisite; `abilities` (m, a) and `needs` (n, a); by robot `acceleration`, `climb`, `turn` (seconds) of motion profiles, and `over_map` whether what is longer than the straight way has bends; `load` and `pending` (n, meters) what a task adds to the load, and how much of that another delivers, `pickup` (n,) the task that takes on what a task delivers, -1 for none, `most_aboard` and `aboard_at_start` (m, meters); `energy` and `energy_at_start` (m,) in the unit of usage, the reserve taken off, inf without a limit of energy; `stations` (refill by second, swap_s, unloads, partial, slots), whose places stand after the ends of robots; `over` (n,) marks tasks that stand for what was done, before which no station is called at; `waiting` (n + 2m, n + 2m) seconds for others between places, of the robots that `waits` (m,) marks. Raises ValueError if shapes do not fit.
        """

    @property
    def tasks(self) -> int: ...

    @property
    def robots(self) -> int: ...

    @property
    def is_symmetric(self) -> bool:
        """
        Whether the way from a task to another costs what the way back does, for every robot.
        """

    @property
    def is_timed(self) -> bool:
        """
        Whether anything binds tasks to times, teams, relations or whole routes.
        """

class Insertion:
    """
    Where a task would go in a robot's route, and the robot's usage then, in the unit of usage.
    """

    @property
    def at(self) -> int: ...

    @property
    def usage(self) -> float: ...

class Inspection:
    """
    Routes with their figures, and what putting one more task into them would take. One thread at a time may use one.
    """

    def __init__(self, problem: Problem, routes: Sequence[Sequence[int]]) -> None:
        """
        One list of task indices for each robot. Raises ValueError if a task stands twice or does not exist.
        """

    @property
    def admissible(self) -> bool:
        """
        Whether capacities hold, no prerequisite is left out and nothing deadlocks.
        """

    @property
    def objective(self) -> float | None:
        """Whatever the capacities; None if routes and prerequisites deadlock."""

    @property
    def usages(self) -> list[float]: ...

    @property
    def makespan(self) -> float | None:
        """Seconds; None if routes and prerequisites deadlock."""

    @property
    def stops(self) -> list[list[tuple[int, float, float, float]]] | None:
        """
        By robot: task, arrival, begin and end of each stop of the earliest schedule; None if there is none.
        """

    @property
    def all_stops(self) -> list[list[tuple[int, float, float, float, float]]] | None:
        """
        The same with those at stations: place, arrival, begin, end and what is refilled.
        """

    def cheapest_insertion(self, robot: int, task: int) -> Insertion | None:
        """
        The place in the robot's route where the task adds least usage and nothing deadlocks, whatever the capacity; usage inf if there is no way to it, None if it would deadlock everywhere.
        """

class Matching:
    """
    One robot, one task, and the cost c_ij (3.8) of going there and doing it.
    """

    @property
    def robot(self) -> int: ...

    @property
    def task(self) -> int: ...

    @property
    def cost(self) -> float: ...

class Greedy:
    """
    State and steps of greedy task allocation ([tcf-thesis], Algorithm 1). One thread at a time may use one.
    """

    def __init__(self, problem: Problem, balanced: bool) -> None:
        """`balanced`: choose by c_ij + u_i (3.17), else by c_ij alone (3.27)."""

    def select(self) -> Matching | None:
        """Steps 2 to 5: the locally optimal admissible matching, or None."""

    def assign(self, robot: int, task: int) -> None:
        """Steps 6 to 8: append the task to the robot's route and go there."""

    @property
    def routes(self) -> list[list[int]]: ...

class Population:
    """
    Task allocations that evolve ([tcf-thesis], Algorithm 3). One thread at a time may use one.
    """

    def __init__(self, problem: Problem, size: int, seed: int, bounds: str = 'receiver') -> None:
        """
        `size` empty allocations. `bounds`: where mutation looks for a task's prerequisites and dependants.
        """

    def __len__(self) -> int: ...

    def set_random(self, member: int) -> None:
        """A random admissible allocation."""

    def set(self, member: int, routes: Sequence[Sequence[int]]) -> None:
        """Raises ValueError if the routes are not admissible."""

    def set_mutant(self, member: int, of: int) -> None:
        """A mutant of another member."""

    def replace_worst(self, share: float) -> None:
        """
        Step 4: random admissible allocations for the worst share of the members.
        """

    def mutate(self, probability: float) -> None:
        """
        Step 5: task re-assignment (Algorithm 4); a mutant that is better stays.
        """

    def cross(self, probability: float) -> None:
        """
        Step 6: CM-PMX (Algorithm 5); the two best of parents and children stay.
        """

    def best(self) -> int:
        """Index of the best member."""

    def routes(self, member: int) -> list[list[int]]: ...

    def weight(self, member: int) -> float:
        """Weight of the tasks done."""

    def objective(self, member: int) -> float: ...

class Decoder:
    """
    Admissible plans from orders of tasks and the robots that tasks are meant for. One thread at a time may use one.
    """

    def __init__(self, problem: Problem) -> None: ...

    def in_order(self, tasks: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)], robots: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None))]:
        """
        Plans from `tasks`, (k, n) in the order in which they are put at the ends of routes, and `robots`, (k, n) by task. Returns (k, 4): weight, objective, total and greatest usage. Raises ValueError if an index is wrong.
        """

    def nearest_next(self, robots: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None))]:
        """The same where each robot goes on to the nearest of its tasks."""

    def routes(self, plan: int) -> list[list[int]]:
        """Of the last call."""

class Colony:
    """
    Ants that build plans by pheromone and distance. One thread at a time may use one.
    """

    def __init__(self, problem: Problem, beta: float, seed: int) -> None: ...

    def build(self, trail: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], plans: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None))]:
        """
        So many plans by (2.24); `trail` is tau^alpha, (n + m, n), from each task and each robot's start to each task. Returns (k, 4): weight, objective, total and greatest usage.
        """

    def routes(self, plan: int) -> list[list[int]]:
        """Of the last call."""

QUANTUM: float = 9.5367431640625e-07

class Bidders:
    """
    The team while tasks are auctioned: routes so far, and what each robot could do with each open task. One thread at a time may use one.
    """

    def __init__(self, problem: Problem, insert: bool, figure: str) -> None:
        """
        `insert`: a task goes where it lengthens the route least, else to its end. `figure`, what offers are: `growth` of the route's usage; `arrivals`, what is added to the sum of usages on arrival; `end`, when the robot would be done with all its tasks, in seconds.
        """

    def copy(self) -> Bidders:
        """The same team once more, in which awards can be tried."""

    def set_routes(self, routes: Sequence[Sequence[int]]) -> None:
        """
        Begin anew with these routes; nothing is announced. Raises ValueError if they are not admissible.
        """

    def announce(self, tasks: Sequence[int]) -> None:
        """Tasks are open as soon as their prerequisites are in routes."""

    @property
    def open(self) -> list[int]: ...

    def offers(self, robot: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        (n,) the figure of each task for the robot; inf where the task is not open, or the robot may not do it or has no capacity for it.
        """

    def offers_for(self, task: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(m,) the figure of the task for each robot."""

    def lowest(self) -> tuple[list[int], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        For each robot the task with its lowest figure, the first if several have it, and (m,) that figure; -1 and inf for a robot without offers.
        """

    def award(self, robot: int, task: int) -> None:
        """
        Put an open task into the robot's route. Raises ValueError if the robot has no offer for it.
        """

    def relinquish(self, task: int) -> list[int]:
        """
        Take a task out of its route, and all in routes that waits for it; returns them. None are taken if the routes would not be admissible without them.
        """

    @property
    def usages(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(m,) in the unit of usage."""

    @property
    def lengths(self) -> list[int]:
        """The number of tasks in each route."""

    @property
    def routes(self) -> list[list[int]]: ...

class Annealing:
    """
    Simulated annealing of the order of tasks in single routes ([market-paper], section 3.1). One thread at a time may use one.
    """

    def __init__(self, problem: Problem, routes: Sequence[Sequence[int]], seed: int) -> None:
        """Raises ValueError if the routes are not admissible."""

    def anneal(self, robot: int, steps: int) -> None:
        """
        So many steps on one robot's route. The best order found stays, unless the plan would be worse for it.
        """

    @property
    def routes(self) -> list[list[int]]: ...

def improved(problem: Problem, routes: Sequence[Sequence[int]]) -> list[list[int]]:
    """
    Routes after local search alone, with no less weight of tasks; those given where no move is for the problem's rules.
    """

class Search:
    """
    Ruin and recreate under simulated annealing (SISR). One thread at a time may use one.
    """

    def __init__(self, problem: Problem, start: Sequence[Sequence[int]], seed: int, *, removed: float, longest_string: int, blink: float, greatest_share: float, near: int, oversubscribed: bool = False) -> None:
        """Raises ValueError if the routes are not admissible."""

    def anneal(self, steps: int, hot: float, cold: float) -> None:
        """
        So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).
        """

    def go_on_from(self, routes: Sequence[Sequence[int]]) -> None:
        """Go on from these routes; the best stays."""

    @property
    def routes(self) -> list[list[int]]:
        """With which it goes on."""

    @property
    def best(self) -> list[list[int]]: ...

    @property
    def best_weight_left_out(self) -> float: ...

    @property
    def best_objective(self) -> float: ...

    @property
    def best_tie(self) -> float: ...

    @property
    def task_cost(self) -> float:
        """
        What a task costs at the start: the mean of usage, arrival or time, as the objective has it.
        """

    @property
    def mean_way(self) -> float:
        """The usual way from one task to the next, in the unit of usage."""

class UnitInsertion:
    """A unit of work with the robots that do it, and what it costs."""

    @property
    def unit(self) -> int: ...

    @property
    def score(self) -> float:
        """What the objective grows by, ties broken by the routes' growth."""

    @property
    def growth(self) -> float:
        """Of usage, all members together."""

    @property
    def members(self) -> list[tuple[int, int, int]]:
        """Task, robot and place in its route, of each."""

class Roster:
    """
    Routes while an algorithm changes them, where tasks are bound to times, teams and relations.
    """

    def __init__(self, problem: Problem) -> None: ...

    def begin(self, routes: Sequence[Sequence[int]]) -> bool:
        """Take over routes; False if there is no schedule for them."""

    def present(self, unit: int) -> bool:
        """Whether a unit is in routes."""

    def ready(self, unit: int) -> bool:
        """Whether all that a unit waits for is in routes."""

    def fixed(self, unit: int) -> bool:
        """Whether a unit stays where it is."""

    @property
    def absent(self) -> list[int]:
        """The units in no route."""

    @property
    def absent_weight(self) -> float: ...

    def usage(self, robot: int) -> float: ...

    def best_insertion(self, unit: int, *, append_only: bool = False, quantised: bool = False, robots: Sequence[int] | None = None) -> UnitInsertion | None:
        """
        The team and the places at which a unit costs least, or None. All that it waits for must be in routes; `append_only` looks at the ends of routes alone, `robots` at these alone. `quantised` compares costs in quanta, as bids.
        """

    def insert(self, insertion: UnitInsertion) -> bool:
        """False: no schedule exists; then only `rollback` helps."""

    def remove(self, unit: int) -> bool:
        """False: no schedule exists; then only `rollback` helps."""

    def finish(self) -> bool:
        """
        Take out what a plan cannot hold when nothing more comes to it. False: no schedule exists for the rest.
        """

    def admissible(self) -> bool:
        """
        Whether the routes changed since the last `commit` are within the robots' capacities.
        """

    def commit(self) -> None: ...

    def rollback(self) -> None:
        """Undo everything since the last `commit`."""

    @property
    def objective(self) -> float: ...

    @property
    def routes(self) -> list[list[int]]: ...

    @property
    def stops(self) -> list[list[tuple[int, float, float, float]]]:
        """By robot: task, arrival, begin and end of each stop."""

class UnitGreedy:
    """
    Greedy allocation of units of work, each to the ends of the routes where its debit is least.
    """

    def __init__(self, roster: Roster, robots: Sequence[int], thorough: bool) -> None:
        """
        `thorough`: choose as if every unit were evaluated at each step; else mainly those near what was placed.
        """

    def append_one(self) -> bool:
        """Put the unit of the least debit into routes; False: none fits."""

class ScheduleSearch:
    """
    Ruin and recreate under simulated annealing (SISR), where tasks are bound to times, teams and relations. One thread at a time may use one.
    """

    def __init__(self, problem: Problem, start: Sequence[Sequence[int]], seed: int, *, removed: float, longest_string: int, blink: float, greatest_share: float, near: int) -> None:
        """
        Begins with the routes and what they leave room for. Raises ValueError if there is no schedule for them.
        """

    def anneal(self, steps: int, hot: float, cold: float) -> None:
        """
        So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).
        """

    def go_on_from(self, routes: Sequence[Sequence[int]]) -> None:
        """Go on from these routes; the best stays."""

    @property
    def routes(self) -> list[list[int]]:
        """With which it goes on."""

    @property
    def best(self) -> list[list[int]]: ...

    @property
    def best_weight_left_out(self) -> float: ...

    @property
    def best_objective(self) -> float: ...

    @property
    def best_tie(self) -> float: ...

    @property
    def mean_way(self) -> float:
        """The usual way from one task to the next, in the unit of the objective."""

class Team:
    """
    Routes while a search changes them, with undo. One thread at a time may use one.
    """

    def __init__(self, problem: Problem, routes: Sequence[Sequence[int]]) -> None: ...

    def insert(self, task: int, robot: int, at: int) -> None: ...

    def remove(self, task: int) -> None: ...

    def growth(self, robot: int, task: int, at: int) -> float:
        """Of the route's usage by a task."""

    def later_arrivals(self, robot: int, task: int, at: int) -> float:
        """What a task adds to the sum of usages on arrival."""

    def longer(self, robot: int, task: int, at: int) -> float:
        """Seconds by which the route's last task ends later if nothing waits."""

    def reverse(self, first: int, last: int) -> None:
        """
        Turn the part of a route from one task to another round; ways must be as long back as forth.
        """

    def move(self, first: int, last: int, robot: int, at: int) -> None:
        """
        Put the part of a route from one task to another at a place of the robot's route as it is now.
        """

    def bounds(self, task: int) -> list[tuple[int, int]]:
        """
        For each robot the first and last place where the task deadlocks nothing, all its prerequisites present.
        """

    def commit(self) -> None:
        """Keep all changes."""

    def rollback(self) -> None:
        """Undo all changes since the last commit."""

    def makespan(self) -> float:
        """Seconds after which the last task ends if nothing waits."""

    @property
    def usages(self) -> list[float]: ...

    @property
    def arrivals(self) -> list[float]:
        """Of each route the sum of usages on arrival."""

    @property
    def absent(self) -> list[int]: ...

    @property
    def routes(self) -> list[list[int]]: ...

def squared_distances(blocked: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order='C', device='cpu', writable=False)], trim: float, squared: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Write for each cell (rows, columns) the squared distance, in cells, to the nearest blocked cell: between centres with trim 0, from centre to square with 1/2, between squares with 1; inf where no cell is blocked.
    """

class GridMap:
    """
    Cells that are free or blocked; points are (column, row), cell (0, 0) from 0 to 1.
    """

    def __init__(self, blocked: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> None:
        """
        `blocked` is (rows, columns). Raises ValueError if a side has more than 16384 cells.
        """

    def free(self, point: tuple[float, float]) -> bool: ...

    def sees(self, a: tuple[float, float], b: tuple[float, float]) -> bool:
        """Whether the straight piece between two points is free, exactly."""

    def cells_at(self, point: tuple[float, float]) -> list[int]:
        """
        The free cells that have a point inside or on their border, as row * columns + column.
        """

    def search(self, start: tuple[float, float], goal: tuple[float, float], *, heuristic: bool, any_angle: bool) -> list[int]:
        """
        The cells of the shortest way between cell centres, as row * columns + column; empty if there is none.
        """

class Ways:
    """Shortest ways in a plane with obstacles: taut pieces between corners."""

    @staticmethod
    def on_grid(map: GridMap) -> Ways:
        """In the unit of cells."""

    @staticmethod
    def on_region(rings: Sequence[Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]]) -> Ways:
        """
        Rings (k, 2) with the inside on their left. Raises ValueError if the region is empty.
        """

    def build(self, most: int, threads: int) -> None:
        """
        Find what the next `most` corners see. Until all are `built` there are no `lengths`, and each `way` looks for itself, where it comes by.
        """

    @property
    def graph_pays(self) -> bool:
        """
        Whether ways have looked around as many corners as there are, so that to build pays.
        """

    @property
    def built(self) -> bool: ...

    @property
    def looks(self) -> int: ...

    @property
    def corners(self) -> int: ...

    @property
    def pieces(self) -> int:
        """Straight pieces between corners, each counted from both ends."""

    def free(self, point: tuple[float, float]) -> bool: ...

    def sees(self, a: tuple[float, float], b: tuple[float, float]) -> bool: ...

    def way(self, start: tuple[float, float], goal: tuple[float, float]) -> NDArray[numpy.float64]:
        """The shortest way with its ends, (k, 2); empty if there is none."""

    def lengths_alone(self, exits: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], entries: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], *, mutual: bool) -> NDArray[numpy.float64] | None:
        """
        All `lengths`, way by way without the graph; None if it comes to pay before the end.
        """

    def lengths(self, exits: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], entries: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], *, mutual: bool, first: int, last: int, threads: int) -> NDArray[numpy.float64]:
        """
        Rows `first` to before `last` of the lengths from exits to entries; inf where there is no way. If `mutual`, the entries are the exits, and row i holds what comes after column i alone, and 0 there.
        """

class LaneWays:
    """
    The quickest ways along directed lanes for a robot that slows down for bends.
    """

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(order='C', device='cpu', writable=False)], seconds: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], *, turn: float, stop: float) -> None:
        """
        Points (n, 2) and straight arcs (m, 2) between them, by number, with the seconds (m,) that each takes. `turn` and `stop` are the seconds that a bend by a right angle takes for turning, and for stopping. Raises ValueError where these do not fit.
        """

    def lengths(self, starts: Sequence[int], goals: Sequence[int], threads: int) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        Of the quickest ways from each start to each goal, by number, the metres and the seconds, bends included: two arrays (starts, goals). They are inf where there is no way, and where a number is below 0.
        """

    def way(self, start: int, goal: int) -> list[int]:
        """The points of the quickest way, by number; none where there is no way."""

class AirWays:
    """Short ways through the air over and around upright prisms, in metres."""

    def __init__(self, region: Sequence[Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]], prisms: Sequence[tuple[Sequence[Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)]], float, float]], *, lowest: float, top: float, rise: float, run: float) -> None:
        """
        `region` is rings (k, 2) with the inside on their left, a prism (rings, floor, ceiling). Upright edges are sampled every `rise` metres up to `top`, level ones every `run`.
        """

    def build(self, threads: int) -> None:
        """
        Find which samples see each other: lengths need it, and ways are faster then.
        """

    @property
    def built(self) -> bool: ...

    @property
    def graph_pays(self) -> bool:
        """
        Whether ways have looked around as many samples as there are, so that to build pays.
        """

    @property
    def samples(self) -> int: ...

    def free(self, point: Sequence[float]) -> bool: ...

    def sees(self, a: Sequence[float], b: Sequence[float]) -> bool: ...

    def way(self, start: Sequence[float], goal: Sequence[float]) -> NDArray[numpy.float64]:
        """A way with its ends, (k, 3); empty if there is none."""

    def lengths(self, places: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], *, first: int, last: int, threads: int) -> NDArray[numpy.float64]:
        """
        Rows `first` to before `last` of the lengths between places: what comes after column i, and 0 there; inf where there is no way.
        """

class Tree:
    """
    RRT*: a tree of random points that keeps shortening itself; start and goal are free.
    """

    @overload
    def __init__(self, where: Ways, *, low: Sequence[float], high: Sequence[float], start: Sequence[float], goal: Sequence[float], seed: int, step: float, goal_share: float, reach: float) -> None: ...

    @overload
    def __init__(self, where: AirWays, *, low: Sequence[float], high: Sequence[float], start: Sequence[float], goal: Sequence[float], seed: int, step: float, goal_share: float, reach: float) -> None: ...

    def grow(self, samples: int) -> None: ...

    def way(self) -> NDArray[numpy.float64]:
        """
        The shortest way found so far with its ends, (k, 3); empty if there is none.
        """

class VoxelWays:
    """Short ways through free voxels; coordinates x, y, z count in voxels."""

    def __init__(self, blocked: Annotated[NDArray[numpy.bool_], dict(shape=(None, None, None), order='C', device='cpu', writable=False)]) -> None:
        """`blocked` is (layers, rows, columns)."""

    def free(self, point: Sequence[float]) -> bool: ...

    def sees(self, a: Sequence[float], b: Sequence[float]) -> bool:
        """Whether all voxels between two points are free."""

    def part(self, point: Sequence[float]) -> int:
        """
        The number of the connected part that a point is in; 0 if it is not free.
        """

    def way(self, start: Sequence[float], goal: Sequence[float]) -> NDArray[numpy.float64]:
        """A way with its ends, (k, 3); empty if there is none."""

def voxels_passed(shape: Sequence[int], eye: Sequence[float], heading: float, reached: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> NDArray[numpy.int64]:
    """
    The voxels, as indices of the flat array, whose centres are nearer than the four beams around them reached, by a voxel at least. `reached` is (rings, columns), in voxels: rings from straight down to straight up, columns anticlockwise from `heading`.
    """

def lower_clearances(clearances: Annotated[NDArray[numpy.float32], dict(shape=(None, None, None), order='C', device='cpu')], points: Annotated[NDArray[numpy.float64], dict(order='C', device='cpu', writable=False)], reach: float) -> None:
    """
    Lower the distances from the centres of voxels to the nearest of points (n, 3), where that is within `reach`.
    """

def spanning_tree(legs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], root: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], p: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], joined: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], parent: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """
    Write for each of n tasks what the edge to its parent costs in the least spanning tree of a root and all tasks, and the parent, -1: the root. Edges cost legs (n, n), symmetric, and p (n,) of both ends; those of the root cost root (n,).
    """

class PlaneAgents:
    """Robots that share the plane."""

    def __init__(self, positions: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], velocities: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], preferred: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], radii: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], max_speeds: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], priorities: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """Raises ValueError if the arrays are of different lengths."""

    def near(self, most: int, distance: float) -> list[list[int]]:
        """For each agent the nearest others, as indices, the nearest first."""

    def orca(self, walls: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 2), order='C', device='cpu', writable=False)], dt: float, *, horizon: float, wall_horizon: float, most: int, distance: float, apart: bool, threads: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C')]:
        """
        New velocities by optimal reciprocal collision avoidance. Walls: ends of segments, or corners of boxes.
        """

class SpaceAgents:
    """Robots that share the space."""

    def __init__(self, positions: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], velocities: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], preferred: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], radii: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], max_speeds: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], priorities: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """Raises ValueError if the arrays are of different lengths."""

    def near(self, most: int, distance: float) -> list[list[int]]:
        """For each agent the nearest others, as indices, the nearest first."""

    def orca(self, walls: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 3), order='C', device='cpu', writable=False)], dt: float, *, horizon: float, wall_horizon: float, most: int, distance: float, apart: bool, threads: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """
        New velocities by optimal reciprocal collision avoidance. Walls: ends of segments, or corners of boxes.
        """

def rvo(agents: PlaneAgents, walls: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 2), order='C', device='cpu', writable=False)], dt: float, *, v_min: float, magnitudes: int, n: float, w: float, ideal: bool, wall_horizon: float, most: int, distance: float, threads: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C')]:
    """
    New velocities by reciprocal velocity obstacles ([tcf-thesis], appendix A3.2).
    """

def hrvo(agents: PlaneAgents, walls: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 2), order='C', device='cpu', writable=False)], dt: float, *, wall_horizon: float, most: int, distance: float, threads: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C')]:
    """New velocities by hybrid reciprocal velocity obstacles ([snape2011])."""

def avo(agents: PlaneAgents, accelerations: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], walls: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 2), order='C', device='cpu', writable=False)], dt: float, *, horizon: float, response: float, wall_horizon: float, most: int, distance: float, threads: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C')]:
    """New velocities by acceleration-velocity obstacles ([berg-snape2011])."""

def avo_disc(apart: Sequence[float], v: Sequence[float], radius: float, response: float, time: float) -> tuple[float, float, float]:
    """
    The disc of relative velocities that lead into contact at a time: its centre and radius.
    """

class VelocityObstacle:
    """VO_{i,k} of [tcf-thesis] (A.5)."""

    def __init__(self, x_i: Sequence[float], x_k: Sequence[float], v_i: Sequence[float], v_k: Sequence[float], radius: float, yields: float = 0.5) -> None:
        """`radius` is R_i + R_k, which is 2 R_i."""

    @property
    def boundaries(self) -> list[float]:
        """VO^1 to VO^8."""

    @property
    def theta_ik(self) -> float:
        """(A.6)"""

    @property
    def theta_R(self) -> float:
        """(A.7)"""

    def phi_delta(self, v: Sequence[float]) -> float:
        """(A.12)"""

    def phi_1(self, v: Sequence[float]) -> float:
        """(A.19)"""

    def suitable(self, v: Sequence[float]) -> bool:
        """(A.13)"""

    def time_to_collision(self, v: Sequence[float]) -> float:
        """t_c (A.18), seconds; of a velocity that is not suitable."""

def hybrid_obstacle(apart: Sequence[float], v_a: Sequence[float], v_b: Sequence[float], radius: float, dt: float, yields: float = 0.5) -> tuple[list[float], list[float], list[float]]:
    """
    Apex, left and right side of an HRVO, as seen by a robot from which the other is `apart`.
    """

def nearest_in_plane(normals: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], radius: float, wanted: Sequence[float], hard: int = 0) -> tuple[list[float], bool]:
    """
    The point nearest to the wanted one with normal . x >= offset for all and |x| <= radius, and True; or where there is none, the point least deep outside all but the first `hard`, and False.
    """

def nearest_in_space(normals: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], radius: float, wanted: Sequence[float], hard: int = 0) -> tuple[list[float], bool]:
    """
    The point nearest to the wanted one with normal . x >= offset for all and |x| <= radius, and True; or where there is none, the point least deep outside all but the first `hard`, and False.
    """

def closest_approach_in_plane(positions: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 2), order='C', device='cpu', writable=False)], radii: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], tolerance: float) -> tuple[list[float], list[float], list[tuple[int, int]]]:
    """
    Of robots that move straight between points of time: for each step the least distance of two centres, and the least distance less the radii; and the pairs that ever overlap by more than the tolerance.
    """

def closest_approach_in_space(positions: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], radii: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], tolerance: float) -> tuple[list[float], list[float], list[tuple[int, int]]]:
    """
    Of robots that move straight between points of time: for each step the least distance of two centres, and the least distance less the radii; and the pairs that ever overlap by more than the tolerance.
    """

class CrowdWorld:
    """A world of moving robots in fixed steps of virtual time."""

    def __init__(self, *, dt: float, avoidance: str, space: bool, horizon: float, wall_horizon: float, neighbours: int, clearance: float, margin: float, arrival: float, corner: float, heading: float, velocity_noise: float, slip: float, odometry_noise: float, seed: int) -> None: ...

    def add_walls(self, faces: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)], slabs: Sequence[tuple[Sequence[Sequence[float]], float, float]], ground: float) -> int:
        """
        Upright faces (k, 6): x, y and x, y of the ends, lowest and highest z; and the flat ends of zones: corners, floor, ceiling; and the least height of a centre, or -inf. Returns the number of this set.
        """

    def add(self, position: Sequence[float], heading: float, *, radius: float, speed: float, yaw_rate: float, acceleration: float, priority: float, faces_its_way: bool, flies: bool, walls: int, law: str = 'profile', climb: float = 0.0, climb_rate: float = float('inf')) -> int:
        """
        Returns the number of the robot, from 0. `law`: profile, thesis or trajectory; `climb`: above 0 of one that climbs by (4.12); `climb_rate`: up and down of one that keeps to straight ways.
        """

    def set_walls(self, robot: int, walls: int) -> None:
        """From now on another set of walls stops a robot."""

    def send(self, robot: int, stops: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)], labelled: Sequence[bool], order: int) -> None:
        """
        Way points (k, 6): x, y, z, heading or NaN, hold, greatest speed on the way there; none to stop. One out of order does not take them.
        """

    def follow(self, robot: int, poses: Annotated[NDArray[numpy.float64], dict(shape=(None, 4), order='C', device='cpu', writable=False)], step: float, times: Sequence[float]) -> None:
        """
        The trajectory of the order sent last: (k, 4) of x, y, z, heading each `step` seconds, and when it passes each way point.
        """

    def resume(self, steps: int, motions: Sequence[Sequence[float]]) -> None:
        """
        Continue another world from a step, with a row of `motions` for each robot.
        """

    def fail(self, robot: int) -> None: ...

    def recover(self, robot: int) -> None: ...

    def place(self, robot: int, position: Sequence[float]) -> None:
        """Puts a robot elsewhere: it stands there, without an order."""

    def slow(self, robot: int, factor: float) -> None: ...

    def leave_to_traffic(self, robot: int) -> None: ...

    def believe(self, robot: int, place: Sequence[float], heading: float, spread: float) -> None:
        """
        Where a robot takes itself to be now, within a standard deviation in metres: it goes by that.
        """

    def advance(self, until: float) -> list[tuple[float, int, int, int, bool]]:
        """
        Steps until a time, or until something happened: time, robot, order, way points passed, whether all.
        """

    def command(self) -> list[list[float]]:
        """
        What robots that something else moves are to do in the next step: for each its velocity x, y, z, speed ahead of one that faces its way, yaw rate.
        """

    def carried_out(self, poses: Annotated[NDArray[numpy.float64], dict(shape=(None, 4), order='C', device='cpu', writable=False)], short_of: Annotated[NDArray[numpy.float64], dict(shape=(None, 4), order='C', device='cpu', writable=False)], counted: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], still: float) -> list[tuple[float, int, int, int, bool]]:
        """
        Where it brought them, (n, 4) of x, y, z, heading; by how much they would still go and turn on, were they told to stand; (n, 2) metres and radians that their wheels counted, NaN without wheels; slower than `still` is standing. Returns events as `advance`.
        """

    @property
    def time(self) -> float: ...

    @property
    def dt(self) -> float: ...

    @property
    def steps(self) -> int: ...

    @property
    def least_distance(self) -> float: ...

    def contacts(self) -> list[tuple[int, int, float, float]]:
        """
        Two robots, when they first touched, and the least distance of their centres.
        """

    def report(self, robot: int) -> tuple[float, tuple[float, float, float], float, tuple[float, float, float], float, int, int]:
        """
        Time, position, heading, velocity as odometry has it, odometry, order, way points passed.
        """

    def felt(self, robot: int) -> tuple[tuple[float, float, float], float]:
        """
        Acceleration ahead, to the left and up, between the middles of the last two steps; yaw rate of the last.
        """

    def counted(self, robot: int) -> tuple[float, float, float, float]:
        """
        Metres ahead, to the left and up, and radians, that odometry counted in the last step.
        """

    def told_pose(self, robot: int) -> tuple[float, float, float, float]:
        """Where orders take a robot to be: x, y, z, heading."""

    def tracking_errors(self, robot: int) -> tuple[float, float, int]:
        """
        Metres off its trajectory: the sum over steps in which it followed it, the most, the steps.
        """

    def held_up_by(self, robot: int) -> int:
        """
        The robot that holds one up on the way of its order; -1 where none does.
        """

    def busy(self, robot: int) -> bool: ...

    def positions(self) -> NDArray[numpy.float64]: ...

    def velocities(self) -> NDArray[numpy.float64]: ...

    def headings(self) -> NDArray[numpy.float64]: ...

    def motions(self) -> NDArray[numpy.float64]:
        """Of each robot its velocity, its speed ahead and its yaw rate."""

    def travelled(self) -> NDArray[numpy.float64]: ...

class Grant:
    """How far a robot may go along its moves."""

    @property
    def points(self) -> list[tuple[float, float]]:
        """Ends of moves, in metres; the last may lie within a move."""

    @property
    def speeds(self) -> list[float]:
        """The greatest on the way to each of these, in m/s; inf: any."""

    @property
    def ended(self) -> int:
        """How many of these are ends of moves."""

    @property
    def metres(self) -> float:
        """From where the robot is."""

    @property
    def waits_for(self) -> int:
        """The robot that passes first; -1: none."""

    @property
    def last(self) -> bool:
        """Whether all its moves to its stop are granted."""

class LimitedLane:
    """A lane on which only so many robots may be at once; metres."""

    def __init__(self, start: tuple[float, float], end: tuple[float, float], *, most: int, both_ways: bool = False) -> None:
        """`most`: how many, between its ends."""

class PassingOrder:
    """
    The order in which robots pass: one sequence of straight moves, by order and not by clock [hoenig2019]. Places are in metres.
    """

    def __init__(self, *, margin: float, ahead: float, lanes: Sequence[LimitedLane] = []) -> None:
        """
        Metres that are left between robots, and for which a robot may have begun moves; the lanes on which only so many may be.
        """

    def __copy__(self) -> PassingOrder: ...

    def add(self, place: tuple[float, float], radius: float) -> int:
        """A robot that stands; returns its number."""

    def stands(self, robot: int, place: tuple[float, float]) -> None:
        """
        A robot stands elsewhere than was thought; nothing changes where it has moves.
        """

    def append(self, robot: int, to: tuple[float, float], stop: int = 0, speed: float = float('inf')) -> bool:
        """
        A move from where the robot's moves end; False where another would stand in the way, or too many on a lane. `stop`: the number of the stop to which it leads; `speed`: the greatest on it.
        """

    def lead(self, robot: int, stop: int) -> None:
        """
        Let a robot go as far as this stop of its moves, 0 at first; others are planned after the rest, too.
        """

    def extend(self, moves: Sequence[tuple[int, tuple[float, float], int, float]]) -> None:
        """
        Append moves (robot, to, stop, speed); those of a robot after one that is not appended are left out.
        """

    def hold(self, metres: Sequence[float]) -> PassingOrder:
        """
        While a plan is made, let only those moves begin that each robot begins within so many metres, up to its stop, and that depend on no other. Returns the order of these: a plan appends its moves to it.
        """

    def release(self) -> None:
        """No plan comes: all moves may begin again."""

    def adopt(self, planned: PassingOrder) -> None:
        """
        Replace the moves that were not to begin by those of a plan, appended to what `hold` returned, which is used up.
        """

    def cut(self) -> None:
        """Let all moves end where robots have been let go to."""

    def stop(self, robot: int, place: tuple[float, float]) -> None:
        """
        A robot that has been let go further stands here, for all that is known: its moves are dropped.
        """

    def progress(self, robot: int, passed: int, near: tuple[float, float]) -> None:
        """
        A robot has passed the ends of so many of its moves in all, and is near a place.
        """

    def grant(self, robot: int) -> Grant:
        """How far a robot may go now; what it is told it keeps."""

    def end(self, robot: int) -> tuple[float, float]:
        """Where a robot is after all its moves."""

    def stand(self, robot: int) -> tuple[float, float]:
        """Where its stop is."""

    def passed(self, robot: int) -> int:
        """Moves that a robot has finished since it was added."""

    def metres_left(self, robot: int) -> float:
        """Metres that a robot has still to go to its stop."""

class Traveller:
    """A robot for which a path over a roadmap is sought."""

    def __init__(self, *, start: int, stops: Sequence[tuple[int, float]], radius: float, speed: float, heading: float, yaw_rate: float, acceleration: float, ready: float, fixed: bool, stays: bool) -> None: ...

class SafeIntervals:
    """
    Paths in continuous time on a roadmap, one robot after the other [phillips2011].
    """

    def __init__(self, roadmap: AnnotatedRoadmap, rests: Sequence[bool], margin: float) -> None:
        """
        `rests`: whether a robot may rest at a point without standing in the way of others.
        """

    def metres_to(self, goal: int) -> list[float]:
        """What it costs to come to a point from each; inf where there is no way."""

class SharedWays:
    """
    Ways of all who share a roadmap: one after the other, then few at a time anew [li2021].
    """

    def __init__(self, paths: SafeIntervals, travellers: Sequence[Traveller], *, order: Sequence[int], ways: int, expansions: int = 300, seed: int, at_once: bool = False, most_expansions: int = 9223372036854775807, most_seconds: float = float('inf')) -> None:
        """
        The first ways are sought in the order given; where some find none, or with `at_once`, all make way for each other, until so many expansions bring them no nearer to their stops. `ways` more are sought to improve them, as long as neither the expansions nor the seconds of all searches are spent.
        """

    def change(self, changes: Sequence[tuple[int, Traveller]], *, ways: int) -> None:
        """
        Travellers, by number, do something else: theirs are sought anew, and `ways` more.
        """

    def undo(self) -> None:
        """Take the last change back."""

    @property
    def expansions(self) -> int:
        """
        Of all searches so far: labels of ways, and configurations times robots.
        """

    @property
    def order(self) -> list[int]:
        """Of the travellers, in which these ways were found."""

    def paths(self) -> tuple[list[tuple[float, int, int, int]], list[float]]:
        """
        Moves (seconds, traveller, edge, the number of the stop to which it leads) in order; and when each has held at its last stop, inf where it finds no path, NaN where those that are fixed cut it off.
        """

    def paths_alone(self) -> tuple[list[tuple[float, int, int, int]], list[float]]:
        """The same of each, were it alone with those that are fixed."""

class DirectedGraph:
    """A directed graph in compressed rows."""

    def __init__(self, first: Sequence[int], heads: Sequence[int], costs: Sequence[float]) -> None:
        """
        The edges of vertex u are those from first[u] to first[u + 1]. Raises ValueError if they are not, or if a cost is not above 0.
        """

    @property
    def size(self) -> int: ...

    @property
    def edges(self) -> int: ...

    def costs_to(self, goal: int) -> list[float]:
        """
        What it costs to come to a vertex from each; infinite where there is no way.
        """

class TrafficGuidance:
    """Ways of robots to their goals that avoid those who come the other way."""

    def __init__(self, graph: DirectedGraph, starts: Sequence[int], goals: Sequence[int], seed: int) -> None:
        """
        Raises ValueError where starts or goals are no vertices, or not of the same number.
        """

    def advance(self, steps: int) -> None:
        """Two steps a robot."""

    @property
    def finished(self) -> bool: ...

    @property
    def connected(self) -> bool:
        """Whether each robot alone comes to its goal, so far."""

    @property
    def least_sum(self) -> int:
        """
        The sum of the numbers of steps on the shortest ways of the robots; once finished.
        """

class Lacam:
    """
    Search over configurations of robots that take a step on a graph at once.
    """

    def __init__(self, guidance: TrafficGuidance, *, samples: int = 1, seed: int = 0, anytime: bool = False) -> None:
        """
        Raises ValueError where the guidance is not finished, or a robot alone has no way.
        """

    def advance(self, expansions: int) -> None: ...

    @property
    def state(self) -> str:
        """
        searching, solved, optimal (solved, and nothing is better), or unsolvable: the space is exhausted.
        """

    @property
    def nodes(self) -> int:
        """The number of configurations that it knows."""

    @property
    def cost(self) -> float:
        """
        Steps in which robots do not rest at their goals, of the best solution.
        """

    def solution(self) -> NDArray[numpy.int64]:
        """
        The vertex of each robot, (steps + 1, robots). Raises ValueError before it is solved.
        """

class JointRefinement:
    """Large neighbourhood search over the paths of robots."""

    def __init__(self, guidance: TrafficGuidance, steps: Annotated[NDArray[numpy.int64], dict(shape=(None, None), order='C', writable=False)], seed: int) -> None:
        """Raises ValueError where `steps` are no paths to the goals."""

    def advance(self, neighbourhoods: int) -> None: ...

    @property
    def cost(self) -> int:
        """Steps until each robot rests at its goal for good, summed up."""

    def solution(self) -> NDArray[numpy.int64]:
        """The vertex of each robot, (steps + 1, robots)."""

class LifelongErrands:
    """
    Robots with headings on a grid that carry out tasks without end, step by step.
    """

    def __init__(self, blocked: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order='C', device='cpu', writable=False)], starts: Sequence[int], tasks: Sequence[Sequence[int]], *, revealed: int, checks: int = 1000000, seed: int = 0) -> None:
        """
        `blocked` is (rows, columns); a cell is row * columns + column. Robots head east at first. Raises ValueError where a cell is not free, a task has no cell, or two robots start in one cell.
        """

    def advance(self) -> None:
        """Assigns tasks, decides moves, and takes one step."""

    @property
    def step(self) -> int: ...

    @property
    def finished(self) -> int:
        """The number of tasks that are finished."""

    @property
    def impossible(self) -> int:
        """
        The number of revealed tasks that no robot can finish: no way leads to all their cells.
        """

    @property
    def actions(self) -> list[str]:
        """
        Of each robot: a letter for each step; F forward, R clockwise, C counter-clockwise, W wait.
        """

    @property
    def busy_steps(self) -> list[int]:
        """Of each robot: the number of steps in which it had a task."""

    @property
    def events(self) -> list[tuple[int, int, int, int]]:
        """
        (step, robot, task, number of its cells visited), whenever a robot visits a cell of its task.
        """

    @property
    def assignments(self) -> list[tuple[int, int, int]]:
        """(step, robot, task), whenever a robot gets another task; -1 for none."""

    @property
    def revealed(self) -> list[int]:
        """Of each task that was revealed: the step."""
