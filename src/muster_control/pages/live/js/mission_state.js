// The state of a mission under way, as far as pages show it: the fold of its events, as `muster.state` folds them in
// Python. A test applies the same events to both, and compares after each. Metres, seconds.

import { grownMap } from "muster-record/explored.js";

export class MissionState {
  constructor(mission) {
    this.mission = mission;
    this.robots = new Map(); // id -> the robot of the mission, and {home, out: kind of the event, route: tasks ahead}
    this.tasks = new Map(); // id -> Task
    this.units = new Map(); // task -> the tasks that begin together with it; empty until it is asked for
    this.closedDoors = new Set();
    this.failedStations = new Set();
    this.cutOffStations = new Set(); // to which a robot found no way
    this.leftOut = new Map(); // task -> why no robot is to do it, by the plan in force
    this.refusals = new Map(); // task -> {robot: why it cannot do it}
    this.missed = new Map(); // task -> {reason, next}: not begun in time; next: when it may begin all the same, or null
    this.delays = new Map(); // task -> seconds that its work takes longer
    this.lying = new Map(); // task -> {load, robot}: what it took on lies where its robot failed
    this.doneTwice = new Map(); // task -> the robots that could not hear each other
    this.forgotten = { done: 0, lost: 0, cancelled: 0 };
    this.explored = null; // the map of robots that had none, as `grownMap` gives it
    this.replanned = 0;
    this.ended = null;
    this.ignored = new Set(); // rules that do not hold
    for (const robot of mission.robots ?? []) this.join(robot);
    for (const task of mission.tasks ?? []) this.add(task);
    const [zones, lanes] = [mission.map?.zones ?? [], mission.lanes?.edges ?? []];
    for (const { id, open = false } of zones) if (id && !open) this.closedDoors.add(id);
    this.doors = [...zones, ...lanes].map(({ id }) => id).filter(Boolean);
  }

  // Why a station serves nobody, null: it serves.
  whyNoService(station) {
    if (this.failedStations.has(station)) return "failed, serves nobody";
    return this.cutOffStations.has(station) ? "cut off: a robot found no way to it" : null;
  }

  // Changes what is known as an event says; a kind that is not in `CHANGES` changes nothing that pages show.
  apply({ time_s: time, kind, data }) {
    CHANGES[kind]?.(this, data, time, kind);
  }

  join(robot) {
    const known = this.robots.get(robot.id) ?? { out: "", route: [] };
    this.robots.set(robot.id, Object.assign(known, robot, { home: three(robot.position ?? [0, 0]) }));
  }

  add(task) {
    const names = [task.starts_with ?? []].flat(); // a mission file has one name bare
    const known = this.tasks.get(task.id) ?? new Task();
    this.tasks.set(task.id, Object.assign(known, task, { place: three(task.position), starts_with: names }));
    this.units.clear();
    if (names.length) this.tieApart(known);
  }

  // One that comes too late to begin with another is tied to none: no other waits for it.
  tieApart(task) {
    const others = this.unit(task.id).filter((name) => name !== task.id);
    if (!others.some((name) => this.tasks.get(name)?.isBegunOrOver)) return;
    task.starts_with = task.starts_with.filter((name) => !others.includes(name));
    for (const other of others.map((name) => this.tasks.get(name))) {
      other.starts_with = other.starts_with.filter((name) => name !== task.id);
    }
    this.units.clear();
  }

  // A robot or task of an event: its data, or the id of one that is known or that the mission's own events bring.
  made(told, known, field) {
    if (typeof told !== "string") return told;
    return (this.mission.events ?? []).map((event) => event[field]).findLast((one) => one?.id === told) ?? known.get(told);
  }

  // The tasks that begin together with a task, itself included.
  unit(id) {
    if (this.ignored.has("relation")) return [id];
    if (!this.units.size) this.units = unitsOf(this.tasks);
    return this.units.get(id);
  }

  begin(id, robots) {
    const task = this.tasks.get(id);
    if (task && !task.isOver && !task.isAtWork) Object.assign(task, { begun: true, lost: false, robots });
  }

  breakOff(id) {
    if (!this.tasks.has(id)) return;
    for (const task of this.unit(id).map((name) => this.tasks.get(name))) if (task?.isAtWork) task.giveUp();
  }

  end(id, robots) {
    const task = this.tasks.get(id);
    if (!task || task.ended) return;
    this.finish(id, robots);
    for (const robot of robots.filter((name) => this.robots.has(name))) {
      const known = this.robots.get(robot);
      known.route = known.route.filter((name) => name !== id);
    }
  }

  finish(id, robots) {
    this.lying.delete(id);
    Object.assign(this.tasks.get(id) ?? {}, { begun: true, ended: true, cancelled: false, lost: false, robots });
  }

  breakOffWork(robot) {
    for (const task of this.tasks.values()) if (task.isAtWork && task.robots.includes(robot)) this.breakOff(task.id);
  }

  takeOut(robot, kind) {
    this.breakOffWork(robot);
    if (this.robots.has(robot)) Object.assign(this.robots.get(robot), { out: kind, route: [] });
  }

  refuse(task, robot, reason) {
    this.refusals.set(task, { ...this.refusals.get(task), [robot]: reason });
  }

  // What stood in the way may do so no more.
  openWays() {
    this.cutOffStations.clear();
    for (const [task, reasons] of this.refusals) {
      const left = Object.entries(reasons).filter(([, reason]) => !/^(unreachable|jam)/.test(reason));
      if (left.length) this.refusals.set(task, Object.fromEntries(left));
      else this.refusals.delete(task);
    }
  }

  // A whole plan, as the first of a log and all of format 1 are.
  adopt({ routes = [], unassigned = [], ignored = [] }) {
    this.ignored = new Set(ignored);
    const isOpen = (id) => this.tasks.has(id) && !this.tasks.get(id).isOver;
    const ahead = new Map(routes.map(({ robot, tasks }) => [robot, tasks.filter(isOpen)]));
    for (const [id, robot] of this.robots) if (!robot.out) robot.route = ahead.get(id) ?? [];
    const told = unassigned.filter(({ task, reasons = [] }) => isOpen(task) && reasons.length);
    this.leftOut = new Map(told.map(({ task, reasons }) => [task, inOneLine(reasons)]));
  }

  // What a plan changes of the one before.
  follow({ routes = {}, left_out: leftOut = {} }) {
    for (const [robot, route] of Object.entries(routes)) if (this.robots.has(robot)) this.robots.get(robot).route = route;
    for (const [task, why] of Object.entries(leftOut)) {
      if (why === null) this.leftOut.delete(task);
      else this.leftOut.set(task, why);
    }
  }

  forget(id) {
    const task = this.tasks.get(id);
    if (!task) return;
    this.forgotten[task.ended ? "done" : task.cancelled ? "cancelled" : "lost"] += 1;
    for (const known of [this.tasks, this.refusals, this.missed, this.delays]) known.delete(id);
    this.units.clear();
  }
}

class Task {
  begun = false;
  ended = false;
  cancelled = false;
  lost = false;
  robots = []; // that do it, or did it

  get state() {
    if (this.ended) return "done";
    if (this.cancelled) return "cancelled";
    if (this.lost) return "lost";
    return this.begun ? "under way" : "open";
  }

  get isOver() { return this.ended || this.cancelled; }

  get isBegunOrOver() { return this.isOver || this.begun; }

  get isAtWork() { return this.begun && !this.ended; }

  giveUp() {
    if (!this.ended) Object.assign(this, { begun: false, robots: [] });
  }
}

const missed = (state, { task, reason, next_s: next = null }) => {
  if (state.tasks.has(task)) state.missed.set(task, { reason, next });
};
const teamOf = ({ team = [], robot }) => (team.length ? team : [robot]);

// By kind of event what it changes.
const CHANGES = {
  starts: (state, data) => state.begin(data.task, teamOf(data)),
  ends: (state, data) => state.end(data.task, teamOf(data)),
  done_elsewhere: (state, { task, robots }) => state.finish(task, robots),
  work_broken_off: (state, { task }) => state.breakOff(task),
  task_refused(state, { task, robot, reason, others = {}, for_now: forNow = false }) {
    if (forNow) return;
    const known = state.tasks.get(task);
    if (known?.isAtWork && known.robots.includes(robot)) state.breakOff(task);
    for (const [name, robots] of Object.entries(others)) for (const one of robots) state.refuse(name, one, reason);
    state.refuse(task, robot, reason);
  },
  new_task(state, { task }) { state.add(state.made(task, state.tasks, "new_task")); },
  cancel_task(state, { task }) {
    if (!state.tasks.has(task)) return;
    state.breakOff(task);
    state.tasks.get(task).cancelled = true;
    state.tasks.get(task).giveUp();
  },
  move_task(state, { task, position, under_way: underWay = false }) {
    if (!state.tasks.has(task)) return;
    state.tasks.get(task).place = three(position);
    if (!underWay) state.tasks.get(task).giveUp();
    state.refusals.delete(task);
  },
  delay_task: (state, { task, by_s: by }) => state.delays.set(task, (state.delays.get(task) ?? 0) + by),
  load_lies(state, { task, robot, position, load }) {
    if (!state.tasks.has(task)) return;
    state.lying.set(task, { load, robot });
    Object.assign(state.tasks.get(task), { ended: false, begun: false, robots: [], place: three(position), starts_with: [] });
    for (const known of [state.refusals, state.delays]) known.delete(task);
    state.units.clear();
  },
  window_missed: missed,
  deadline_missed: missed,
  within_missed: missed,
  lost(state, { task }) { if (state.tasks.has(task)) state.tasks.get(task).lost = true; },
  forgets(state, { tasks }) { for (const task of tasks) state.forget(task); },
  twice(state, { task, robots }) {
    state.doneTwice.set(task, [...new Set([...(state.doneTwice.get(task) ?? []), ...robots])]);
  },
  robot_fails: (state, { robot }, _, kind) => state.takeOut(robot, kind),
  robot_suspended: (state, { robot }, _, kind) => state.takeOut(robot, kind),
  robot_stuck: (state, { robot }, _, kind) => state.takeOut(robot, kind),
  robot_removed(state, { robot }, _, kind) {
    state.takeOut(robot, kind);
    state.openWays();
  },
  robot_moved(state, { robot }) {
    state.breakOffWork(robot);
    state.openWays();
  },
  robot_silent: (state, { robot, goes_on: goesOn = false }, _, kind) => { if (!goesOn) state.takeOut(robot, kind); },
  robot_returns(state, { robot }) {
    if (state.robots.has(robot)) state.robots.get(robot).out = "";
    state.openWays();
  },
  robot_joins(state, { robot }) { state.join(state.made(robot, state.robots, "robot_joins")); },
  station_fails: (state, { station }) => state.failedStations.add(station),
  station_returns: (state, { station }) => state.failedStations.delete(station),
  station_unreachable: (state, { station }) => state.cutOffStations.add(station),
  door_closes: (state, { door }) => state.closedDoors.add(door),
  door_opens(state, { door }) {
    state.closedDoors.delete(door);
    state.openWays();
  },
  ground_unknown(state) { state.explored = null; },
  map_grows(state, data) { state.explored = grownMap(state.explored, data); },
  mission_begins(state, { places = {} }) {
    for (const [robot, place] of Object.entries(places)) state.robots.get(robot).home = three(place.slice(0, -1));
  },
  mission_ended(state, { ended_s: ended = null }, time) { state.ended = ended ?? time; },
  plan(state, data) {
    if (data.plan) state.adopt(data.plan);
    state.follow(data);
  },
  replanned(state) {
    state.replanned += 1;
    if (state.ended !== null) for (const task of state.tasks.values()) task.lost = false;
    state.ended = null;
  },
  resumed(state) {
    for (const task of state.tasks.values()) if (task.isAtWork) state.breakOff(task.id);
  },
};
export const KINDS = Object.keys(CHANGES);

// Tasks that are tied by `starts_with`, directly or by others between them.
function unitsOf(tasks) {
  const units = new Map([...tasks.keys()].map((id) => [id, [id]]));
  for (const { id, starts_with: names } of tasks.values()) {
    for (const name of names) {
      const [one, other] = [units.get(id), units.get(name)];
      if (!other || one === other) continue;
      one.push(...other);
      for (const member of other) units.set(member, one);
    }
  }
  return units;
}

const MOST_NAMED = 3;

// Robots with the same reason together, as `muster.state.reasons` has it.
function inOneLine(reasons) {
  if (reasons.length === 1 && !reasons[0].robot) return reasons[0].detail;
  const robots = new Map();
  for (const { robot, reason, detail } of reasons) {
    const why = `${reason}: ${detail}`;
    robots.set(why, [...(robots.get(why) ?? []), robot]);
  }
  const some = (names) => (names.length <= MOST_NAMED + 1 ? names.join(", ")
    : `${names.slice(0, MOST_NAMED).join(", ")} and ${names.length - MOST_NAMED} more`);
  return [...robots].map(([why, names]) => `${why} (${some(names)})`).join("; ");
}

export function three([x, y, z = 0]) {
  return [x, y, z];
}
