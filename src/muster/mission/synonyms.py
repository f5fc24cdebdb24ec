"""Words of the field for what is called otherwise here: near matches that no spelling tells."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

_CALLED: Mapping[str, str] = {
    # keys of missions
    "tasks": "jobs, job, visits, orders, customers, goals, goal, waypoints, targets, activities, services, shipments",
    "robots": "agents, agent, vehicles, vehicle, drones, uavs, uav, fleet, machines, workers, salesmen, team_members",
    "stations": "depots, depot, chargers, charging_stations, docks, bases",
    "zones": "obstacles, no_fly_zones, nofly, no_go, keep_out, geofences, restricted_areas, forbidden",
    "boundary": "fence, geofence, perimeter, arena, bounds, operation_area",
    "map": "environment, world, grid, floorplan",
    "rules": "options, settings, config, parameters, constraints",
    "suitability": "fitness, affinity, compatibility",
    "position": "location, coordinates, coords, xy, pos, place, start, point, pose",
    "id": "name, identifier, key, uid",
    "speed_mps": "speed, velocity, max_speed, v_max, cruise_speed",
    "radius_m": "radius, footprint, size",
    "heading_deg": "heading, yaw, orientation, theta",
    "duration_s": "duration, service_time, service_duration, processing_time, dwell",
    "window_s": "time_window, time_windows, window_start, ready_time, availability",
    "deadline_s": "latest, due_by, latest_end, end_by",
    "due_s": "due_date, due_time, target_time",
    "prerequisites": "depends_on, predecessors, precedence, after, requires_tasks, dependencies",
    "requires": "required_skills, needed_skills, capabilities_needed, required_capabilities",
    "skills": "capabilities, capability, features, equipment, tools",
    "load": "demand, quantity, pickup_amount, cargo",
    "load_capacity": "payload, payload_capacity, cargo_capacity",
    "work_capacity": "capacity, budget, max_distance, range_limit",
    "priority": "weight, importance, value, reward, profit",
    "robots_needed": "team_size, number_of_robots, coalition_size",
    "return_to_start": "return_home, rtl, return_to_depot, closed_route",
    "available_until_s": "shift_end, end_time",
    "available_from_s": "shift_start, start_time, release_time",
    # allocators
    "consensus-bundle": "cbba, cbaa, consensus-based-bundle, consensus-based-bundle-algorithm",
    "auction": "ssi, ssia, sequential-single-item, sequential-auction",
    "contract-net": "cnp, contract-net-protocol, contractnet",
    "combinatorial-auction": "combinatorial, bundle-auction",
    "bertsekas-auction": "hungarian, assignment, linear-assignment, auction-algorithm",
    "genetic": "ga, evolutionary, memetic",
    "particle-swarm": "pso, swarm",
    "ant-colony": "aco, ants",
    "search": "alns, lns, sisr, ruin-and-recreate, local-search, simulated-annealing, annealing, sa, metaheuristic",
    "greedy": "nearest, nearest-neighbour, nearest-neighbor, insertion, cheapest-insertion, heuristic, grdta",
    # objectives, travel, verbs
    "total": "sum, minsum, mini-sum, distance, total-cost",
    "max": "minmax, mini-max, bottleneck, max-usage",
    "average": "mean, miniave, mini-ave, latency",
    "makespan": "completion-time, finish-time, mission-time",
    "lateness": "tardiness, delay",
    "euclidean": "straight, straight-line, air, crow",
    "matrix": "table, tables, distance-matrix",
    "solve": "plan, optimize, optimise, allocate, assign, schedule",
    "check": "validate, lint, diagnose",
    "verify": "judge, evaluate, prove",
    "simulate": "run, execute, sim, play",
    "serve": "server, ui, gui, web",
    "explain": "why, reasons",
}

MEANT: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        word: tuple(name for name, others in _CALLED.items() if word in others.split(", "))
        for word in {word for others in _CALLED.values() for word in others.split(", ")}
    }
)
"""By a word of the field, in lower case, the words here that it may mean; of these the known one is named."""
